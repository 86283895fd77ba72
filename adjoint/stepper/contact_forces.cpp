// SPDX-License-Identifier: MIT
#include "adjoint/stepper/contact_forces.hpp"

#include <utility>

#include "adjoint/contact/contact_damping_adjoint.hpp"
#include "adjoint/energy/contact_terms_adjoint.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "adjoint/stepper/velocities.hpp"
#include "core/base/contract.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::contact::BodyPairContacts;
using core::contact::HessianKind;
using core::model::Model;
using core::stepper::Trajectory;

bool is_of(const BodyPairContacts& list, const ContactForceOf& of) {
    if (list.first != of.body && list.second != of.body) return false;
    return !of.other || list.first == *of.other || list.second == *of.other;
}

// What of these contacts the force is of.
contact::LaggedContacts those_of(const contact::LaggedContacts& all, const ContactForceOf& of) {
    contact::LaggedContacts out{all.poses, {}, {}};
    std::size_t place = 0;
    for (const BodyPairContacts& list : all.contacts.pairs) {
        const std::size_t begin = place;
        place += list.contacts.size();
        if (!is_of(list, of)) continue;
        out.contacts.pairs.push_back(list);
        out.contacts.count += count_of(list.contacts);
        for (std::size_t k = begin; !all.areas.shares.empty() && k < place; ++k) out.areas.shares.push_back(all.areas.shares[k]);
    }
    return out;
}

// The contacts of one step's end that the force is of, and those that friction of its last round was taken from.
struct ContactsOf {
    core::energy::StepProblem problem;
    contact::LaggedContacts end;
    std::optional<contact::LaggedContacts> lag;  ///< none without friction

    ContactsOf(const Model& model, const StepRounds& rounds, const ContactForceOf& of)
        : problem(rounds.problem()), end(those_of(*rounds.at_end(), of)) {
        if (!rounds.last_lag()) return;
        lag = those_of(*rounds.last_lag(), of);
        problem.friction =
            core::contact::lag_friction(model, lag->contacts, lag->poses, problem.barrier, problem.slip_reference, problem.slip_time);
    }

    bool is_damped() const { return problem.contact_damping.factor > 0; }
    const core::contact::ContactAreas* areas_or_none() const { return problem.model->area_weighted ? &end.areas : nullptr; }
    contact::ContactsAtPose barrier() const { return {*problem.model, end.contacts, end.poses, problem.barrier, areas_or_none()}; }
    contact::DampedContacts damping() const { return {*problem.model, end.contacts, end.poses, problem.contact_damping, areas_or_none()}; }
    contact::FrictionAtPose friction() const {
        return {*problem.model, *lag, end.poses, problem.slip_reference, problem.barrier, problem.friction.slip_bound};
    }

    // The derivatives of barrier, damping and friction together.
    struct Derivatives {
        std::vector<core::kinematics::PoseGradient> gradient;
        core::kinematics::BlockHessian hessian;
    };
    Derivatives derivatives(HessianKind kind) const {
        Derivatives out;
        out.gradient.resize(end.poses.size());
        out.hessian.diagonal.assign(end.poses.size(), Matrix6::Zero());
        core::contact::add_barrier_derivatives(end.contacts, end.poses, problem.barrier, kind, out.gradient, out.hessian);
        if (is_damped())
            core::contact::add_contact_damping_derivatives({*problem.model, end.contacts, problem.contact_damping}, end.poses, kind,
                                                           out.gradient, out.hessian);
        core::contact::add_friction_derivatives(problem.friction, end.poses, kind, out.gradient, out.hessian);
        return out;
    }
};

// Calls visit(t, contacts) for each step, or each that is wanted.
template <class Wanted, class Visit>
void for_each_step(const Model& model, const Trajectory& trajectory, const ContactForceOf& of, const Wanted& wanted, const Visit& visit) {
    const SweepHistory history = sweep_history(model, trajectory);
    const bool has_rounds = energy::has_friction(model);
    std::shared_ptr<const contact::LaggedContacts> known;  // at the step's start
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        if (!wanted(t)) continue;
        FETTLE_ASSERT(!has_rounds || !trajectory.steps[t].friction_rounds.empty(),
                      "the trajectory holds where its rounds of friction ended");
        const StepRounds rounds(model, trajectory, static_cast<int>(t), history, known);
        known = rounds.at_end();
        visit(t, ContactsOf(model, rounds, of));
    }
}

constexpr auto all_steps = [](std::size_t) { return true; };

std::vector<Matrix34> matrices_of(const std::vector<Vector6>& tangents, const std::vector<core::kinematics::Pose>& poses) {
    std::vector<Matrix34> out(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) out[i] << cross_matrix(tangents[i].tail<3>()) * poses[i].rotation, tangents[i].head<3>();
    return out;
}

Matrix34 pose_entries_of(const Vector6& gradient, const Matrix3& rotation) {
    Matrix34 out;
    out << 0.5 * cross_matrix(gradient.tail<3>()) * rotation, gradient.head<3>();
    return out;
}

}  // namespace

namespace {

// The load by the contacts' energy: its gradient along translations, or along turns about the point.
Vector3 load_of(const core::kinematics::PoseGradient& g, const ContactForceOf& of, const Matrix3& rotation) {
    if (!of.about) return g.force;
    return tangent_gradient(g).tail<3>() - (rotation * *of.about).cross(g.force);
}

}  // namespace

std::vector<Vector3> contact_forces(const Model& model, const Trajectory& trajectory, const ContactForceOf& of) {
    std::vector<Vector3> out;
    for_each_step(model, trajectory, of, all_steps, [&](std::size_t, const ContactsOf& at) {
        const auto body = static_cast<std::size_t>(of.body);
        out.push_back(-load_of(at.derivatives(HessianKind::none).gradient[body], of, at.end.poses[body].rotation) / at.problem.weight);
    });
    return out;
}

namespace {

// The seeds of all steps for one seed: what is linear in the forces' weights.
class ForceSeeds {
public:
    ForceSeeds(const Model& model, const ContactForceOf& of, Seeds& seeds)
        : model_(model), body_(static_cast<std::size_t>(of.body)), about_(of.about), seeds_(seeds), model_bar_{std::move(seeds.model_bar)} {
        areas_bar_.resize(1);
        for (std::size_t i = 0; model.area_weighted && i < model.bodies.size(); ++i)
            areas_bar_[0].push_back(contact::zero_areas(model.bodies[i]));
    }

    void add(std::size_t t, const ContactsOf& at, const Vector3& weight) {
        const std::size_t n = model_.bodies.size();
        std::vector<std::vector<Vector6>> motion(1, std::vector<Vector6>(n, Vector6::Zero()));
        motion[0][body_] = motion_of(at, weight / at.problem.weight);
        std::vector<std::vector<Matrix34>> start_bar(1, std::vector<Matrix34>(n, Matrix34::Zero()));
        contact::subtract_contact_vertices_adjoint(at.barrier(), motion, model_bar_, areas_bar_);
        if (at.is_damped()) contact::subtract_contact_damping_adjoint(at.damping(), motion, {start_bar, areas_bar_, model_bar_});
        if (at.lag) add_friction(t, at, motion);
        const ContactsOf::Derivatives d = at.derivatives(HessianKind::exact);
        const std::vector<Vector6> end_bar = core::linear::multiply(d.hessian, motion[0]);
        for (std::size_t i = 0; i < n; ++i) {
            seeds_.trajectory_bar.pose_bar[t + 1][i] -= pose_entries_of(end_bar[i], at.end.poses[i].rotation);
            seeds_.trajectory_bar.pose_bar[t][i] += start_bar[0][i];
        }
        if (about_) subtract_change_of_turn(d.gradient[body_], at.end.poses[body_].rotation, motion[0][body_].tail<3>(), t);
    }

    void finish() {
        for (std::size_t i = 0; model_.area_weighted && i < model_.bodies.size(); ++i)
            contact::areas_adjoint(model_.bodies[i].mesh, areas_bar_[0][i], model_bar_[0].bodies[i].vertices_bar);
        seeds_.model_bar = std::move(model_bar_[0]);
        for (const auto& [t, bars] : slip_bars_)
            for (std::size_t i = 0; i < bars.size(); ++i)
                if (!bars[i].isZero(0)) add_slip_seed(model_, t, static_cast<int>(i), bars[i], seeds_);
    }

private:
    // The translation, or the turn about the point.
    Vector6 motion_of(const ContactsOf& at, const Vector3& along) const {
        Vector6 motion = Vector6::Zero();
        if (about_)
            motion << (at.end.poses[body_].rotation * *about_).cross(along), along;
        else
            motion.head<3>() = along;
        return motion;
    }

    void subtract_change_of_turn(const core::kinematics::PoseGradient& g, const Matrix3& rotation, const Vector3& turn, std::size_t t) {
        seeds_.trajectory_bar.pose_bar[t + 1][body_].leftCols<3>() -=
            cross_matrix(turn).transpose() * g.arm * rotation + turn.cross(g.force) * about_->transpose();
    }

    void add_friction(std::size_t t, const ContactsOf& at, const std::vector<std::vector<Vector6>>& motion) {
        const std::vector<std::vector<Matrix34>> zero(1, std::vector<Matrix34>(model_.bodies.size(), Matrix34::Zero()));
        std::vector<std::vector<Matrix34>> slip_bar = zero, lag_bar = zero;
        contact::subtract_friction_adjoint(at.friction(), motion, {slip_bar, lag_bar, areas_bar_, model_bar_});
        slip_bars_.emplace_back(static_cast<int>(t), std::move(slip_bar[0]));
        TrajectoryGradient& to = seeds_.trajectory_bar;
        to.lag_bar.resize(to.pose_bar.size() - 1);
        if (to.lag_bar[t].empty()) to.lag_bar[t] = zero[0];
        for (std::size_t i = 0; i < lag_bar[0].size(); ++i) to.lag_bar[t][i] += lag_bar[0][i];
    }

    const Model& model_;
    std::size_t body_;
    std::optional<Vector3> about_;
    Seeds& seeds_;
    std::vector<ModelGradient> model_bar_;
    std::vector<std::vector<contact::AreaChange>> areas_bar_;
    std::vector<std::pair<int, std::vector<Matrix34>>> slip_bars_;  // of steps
};

}  // namespace

void add_contact_force_seeds(const Model& model, const Trajectory& trajectory, const ContactForceOf& of,
                             const std::vector<Vector3>& weights, Seeds& seeds) {
    ForceSeeds sum(model, of, seeds);
    for_each_step(
        model, trajectory, of, [&](std::size_t t) { return !weights[t].isZero(0); },
        [&](std::size_t t, const ContactsOf& at) { sum.add(t, at, weights[t]); });
    sum.finish();
}

namespace {

// The tangent of load_of, from dE/dP and its change.
Vector3 load_tangent(const Matrix34& value, const Matrix34& dot, const ContactForceOf& of, const Matrix3& rotation,
                     const Matrix34& pose_dot) {
    if (!of.about) return dot.col(3);
    const Matrix3 turned = dot.leftCols<3>() * rotation.transpose() + value.leftCols<3>() * pose_dot.leftCols<3>().transpose();
    const Vector3 torque(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
    return torque - (pose_dot.leftCols<3>() * *of.about).cross(value.col(3)) - (rotation * *of.about).cross(dot.col(3));
}

}  // namespace

std::vector<Vector3> contact_force_tangents(const Model& model, const Trajectory& trajectory, const ContactForceOf& of,
                                            const TangentMotion& motion) {
    std::vector<contact::AreaChange> areas_dot;
    for (std::size_t i = 0; model.area_weighted && i < model.bodies.size(); ++i)
        areas_dot.push_back(contact::areas_tangent(model.bodies[i].mesh, motion.direction.bodies[i].vertices_dot));
    std::vector<Vector3> out;
    for_each_step(model, trajectory, of, all_steps, [&](std::size_t t, const ContactsOf& at) {
        FETTLE_ASSERT(at.problem.friction.pairs.empty(), "no friction between the bodies");
        const std::vector<Matrix34> end_dot = matrices_of(motion.poses_dot[t + 1], at.end.poses),
                                    start_dot = matrices_of(motion.poses_dot[t], trajectory.poses[t]);
        const std::vector<Matrix34> zero(at.end.poses.size(), Matrix34::Zero());
        contact::PoseGradientTangent energy{zero, zero};
        contact::add_contact_gradient_tangent(at.barrier(), end_dot, motion.direction, areas_dot, energy);
        if (at.is_damped()) contact::add_contact_damping_tangent(at.damping(), {end_dot, start_dot, areas_dot}, motion.direction, energy);
        const auto body = static_cast<std::size_t>(of.body);
        out.push_back(-load_tangent(energy.value[body], energy.dot[body], of, at.end.poses[body].rotation, end_dot[body]) /
                      at.problem.weight);
    });
    return out;
}

}  // namespace fettle::adjoint::stepper
