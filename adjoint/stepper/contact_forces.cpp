// SPDX-License-Identifier: MIT
#include "fettle/adjoint/stepper/contact_forces.hpp"

#include "fettle/adjoint/contact/contact_damping_adjoint.hpp"
#include "fettle/adjoint/stepper/step_linearisation.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::contact::BodyPairContacts;
using core::contact::HessianKind;
using core::model::Model;
using core::stepper::Trajectory;

// The contacts of one step's end that the force is of.
struct ContactsOf {
    core::energy::StepProblem problem;
    std::vector<core::kinematics::Pose> poses;
    core::contact::ContactSet contacts;
    core::contact::ContactAreas areas;

    ContactsOf(const Model& model, const Trajectory& trajectory, int t, const SweepHistory& history, const ContactForceOf& of)
        : problem(problem_at(model, trajectory, t, history)), poses(trajectory.poses[static_cast<std::size_t>(t) + 1]) {
        const core::contact::Candidates candidates = core::contact::find_candidates(model, poses, 0);
        const core::contact::ContactSet all = core::contact::find_contacts(model, candidates, poses);
        core::contact::ContactAreas all_areas;
        if (model.area_weighted) all_areas = contact_areas(model, candidates, poses);
        std::size_t place = 0;
        for (const BodyPairContacts& list : all.pairs) {
            const std::size_t begin = place;
            place += list.contacts.size();
            if (!is_of(list, of)) continue;
            contacts.pairs.push_back(list);
            contacts.count += static_cast<int>(list.contacts.size());
            for (std::size_t k = begin; model.area_weighted && k < place; ++k) areas.shares.push_back(all_areas.shares[k]);
        }
    }

    bool is_damped() const { return problem.contact_damping.factor > 0; }
    const core::contact::ContactAreas* areas_or_none() const { return problem.model->area_weighted ? &areas : nullptr; }
    contact::ContactsAtPose barrier() const { return {*problem.model, contacts, poses, problem.barrier, areas_or_none()}; }
    contact::DampedContacts damping() const { return {*problem.model, contacts, poses, problem.contact_damping, areas_or_none()}; }

    // Of barrier and damping.
    struct Derivatives {
        std::vector<core::kinematics::PoseGradient> gradient;
        core::kinematics::BlockHessian hessian;
    };
    Derivatives derivatives(HessianKind kind) const {
        Derivatives out;
        out.gradient.resize(poses.size());
        out.hessian.diagonal.assign(poses.size(), Matrix6::Zero());
        core::contact::add_barrier_derivatives(contacts, poses, problem.barrier, kind, out.gradient, out.hessian);
        if (is_damped())
            core::contact::add_contact_damping_derivatives({*problem.model, contacts, problem.contact_damping}, poses, kind, out.gradient,
                                                           out.hessian);
        return out;
    }

private:
    static bool is_of(const BodyPairContacts& list, const ContactForceOf& of) {
        if (list.first != of.body && list.second != of.body) return false;
        return !of.other || list.first == *of.other || list.second == *of.other;
    }
};

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

std::vector<Vector3> contact_forces(const Model& model, const Trajectory& trajectory, const ContactForceOf& of) {
    const SweepHistory history = sweep_history(model, trajectory);
    std::vector<Vector3> out;
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const ContactsOf at(model, trajectory, static_cast<int>(t), history, of);
        out.push_back(-at.derivatives(HessianKind::none).gradient[static_cast<std::size_t>(of.body)].force / at.problem.weight);
    }
    return out;
}

void add_contact_force_seeds(const Model& model, const Trajectory& trajectory, const ContactForceOf& of,
                             const std::vector<Vector3>& weights, Seeds& seeds) {
    const SweepHistory history = sweep_history(model, trajectory);
    const std::size_t n = model.bodies.size();
    std::vector<contact::AreaChange> no_areas;
    for (std::size_t i = 0; model.area_weighted && i < n; ++i) no_areas.push_back(contact::zero_areas(model.bodies[i]));
    std::vector<std::vector<contact::AreaChange>> areas_bar{no_areas};
    std::vector<ModelGradient> model_bar{std::move(seeds.model_bar)};
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        if (weights[t].isZero(0)) continue;
        const ContactsOf at(model, trajectory, static_cast<int>(t), history, of);
        std::vector<std::vector<Vector6>> motion(1, std::vector<Vector6>(n, Vector6::Zero()));
        motion[0][static_cast<std::size_t>(of.body)].head<3>() = weights[t] / at.problem.weight;
        std::vector<std::vector<Matrix34>> start_bar(1, std::vector<Matrix34>(n, Matrix34::Zero()));
        contact::subtract_contact_vertices_adjoint(at.barrier(), motion, model_bar, areas_bar);
        if (at.is_damped()) contact::subtract_contact_damping_adjoint(at.damping(), motion, {start_bar, areas_bar, model_bar});
        const std::vector<Vector6> end_bar = core::solver::multiply(at.derivatives(HessianKind::exact).hessian, motion[0]);
        for (std::size_t i = 0; i < n; ++i) {
            seeds.trajectory_bar.pose_bar[t + 1][i] -= pose_entries_of(end_bar[i], at.poses[i].rotation);
            seeds.trajectory_bar.pose_bar[t][i] += start_bar[0][i];
        }
    }
    for (std::size_t i = 0; model.area_weighted && i < n; ++i)
        contact::areas_adjoint(model.bodies[i].mesh, areas_bar[0][i], model_bar[0].bodies[i].vertices_bar);
    seeds.model_bar = std::move(model_bar[0]);
}

std::vector<Vector3> contact_force_tangents(const Model& model, const Trajectory& trajectory, const ContactForceOf& of,
                                            const TangentMotion& motion) {
    const SweepHistory history = sweep_history(model, trajectory);
    std::vector<contact::AreaChange> areas_dot;
    for (std::size_t i = 0; model.area_weighted && i < model.bodies.size(); ++i)
        areas_dot.push_back(contact::areas_tangent(model.bodies[i].mesh, motion.direction.bodies[i].vertices_dot));
    std::vector<Vector3> out;
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const ContactsOf at(model, trajectory, static_cast<int>(t), history, of);
        const std::vector<Matrix34> end_dot = matrices_of(motion.poses_dot[t + 1], at.poses),
                                    start_dot = matrices_of(motion.poses_dot[t], trajectory.poses[t]);
        const std::vector<Matrix34> zero(at.poses.size(), Matrix34::Zero());
        contact::PoseGradientTangent energy{zero, zero};
        contact::add_contact_gradient_tangent(at.barrier(), end_dot, motion.direction, areas_dot, energy);
        if (at.is_damped()) contact::add_contact_damping_tangent(at.damping(), {end_dot, start_dot, areas_dot}, motion.direction, energy);
        out.push_back(-energy.dot[static_cast<std::size_t>(of.body)].col(3) / at.problem.weight);
    }
    return out;
}

}  // namespace fettle::adjoint::stepper
