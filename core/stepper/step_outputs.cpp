// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fettle/core/energy/inertia.hpp"
#include "fettle/core/solver/newton.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::Pose;

// Momenta: with M = integral rho [X;1][X;1]^T, integral rho x v^T = P M V^T.
void add_body(const model::Model& model, const model::Body& body, const Pose& pose, const Matrix34& velocity, StepOutputs& out) {
    const Matrix34 p = pose_matrix(pose);
    const Matrix34 momentum = velocity * body.moments;
    out.kinetic_energy += 0.5 * momentum.cwiseProduct(velocity).sum();
    out.linear_momentum += momentum.col(3);
    const Matrix3 l = p * momentum.transpose();  // integral rho x v^T
    out.angular_momentum += Vector3(l(1, 2) - l(2, 1), l(2, 0) - l(0, 2), l(0, 1) - l(1, 0));
    out.potential_energy -= model.gravity.dot(p * body.moments.col(3)) + body.force.dot(pose.position);
}

class Forces {
public:
    Forces(const std::vector<Pose>& poses, double weight) : poses_(poses), weight_(weight) {}

    void add_contacts(const contact::ContactSet& set, const contact::BarrierParameters& parameters) {
        for (const contact::BodyPairContacts& list : set.pairs) {
            ContactForce& f = between(list.first, list.second);
            for (const contact::ContactPair& pair : list.contacts) {
                const auto gradient = pair_forces(pair, parameters);
                const int n = first_count(pair.type);
                Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
                // On body a: the vertices of the first primitive, or those of the second if the pair is listed the other way round.
                for (int i = list.first == f.a ? 0 : n; i < (list.first == f.a ? n : 4); ++i) {
                    force -= gradient[i] / weight_;
                    torque -= pair.x[i].cross(gradient[i]) / weight_;
                }
                f.force += force;
                f.torque += torque;
                f.normal += normal_force(pair, parameters) / weight_;
                const double distance = std::sqrt(pair.closest.distance_squared);
                f.distance = f.contacts == 0 ? distance : std::min(f.distance, distance);
                ++f.contacts;
            }
        }
    }

    void add_friction(const contact::FrictionSet& set) {
        for (const contact::BodyPairFriction& pair : set.pairs)
            for (const contact::FrictionContact& c : pair.contacts) {
                ContactForce& f = between(pair.first, pair.second);
                const bool first = pair.first == f.a;
                const Vector3 force = (first ? 1.0 : -1.0) / weight_ * friction_force(set, pair, c, poses_);
                const Vector3 at = world_position(poses_[f.a], first ? c.point_first : c.point_second);
                f.force += force;
                f.friction += force;
                f.torque += at.cross(force);
            }
    }

    std::vector<ContactForce> take() {
        std::vector<ContactForce> out;
        for (auto& [key, force] : forces_) out.push_back(std::move(force));
        return out;
    }

private:
    ContactForce& between(int first, int second) {
        const auto key = std::minmax(first, second);
        ContactForce& f = forces_[key];
        f.a = key.first;
        f.b = key.second;
        return f;
    }

    const std::vector<Pose>& poses_;
    double weight_;
    std::map<std::pair<int, int>, ContactForce> forces_;
};

// The solver leaves out the inertia and loads of bodies that it does not solve for.
Vector6 inertia_if_held(const energy::StepProblem& problem, std::size_t i, const kinematics::ChartPoint& point, const Pose& pose) {
    const model::Body& body = problem.model->bodies[i];
    bool held = body.moments(3, 3) > 0;
    for (int k = 0; k < 6; ++k) held = held && !is_free(body, k);
    if (!held) return Vector6::Zero();
    kinematics::PoseGradient gradient;
    energy::add_inertia_gradient(pose, problem.pose_hat[i], body.moments, gradient);
    Vector6 out = tangent_gradient(gradient);
    out.head<3>() -= problem.weight * body.force;
    out.tail<3>() = kinematics::left_jacobian(point.rotation_vector).transpose() * out.tail<3>();
    return out;
}

// The residual of the prescribed coordinates is what the drive supplies; in world axes, out of the chart's.
std::vector<DriveForce> drive_forces(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved) {
    const auto& points = solved.path.back();
    const energy::ChartDerivatives d =
        energy::chart_derivatives(problem, points, solved.poses, solved.contacts, contact::HessianKind::projected);
    std::vector<DriveForce> out;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const model::Body& body = model.bodies[i];
        Vector6 residual = (d.gradient[i] + inertia_if_held(problem, i, points[i], solved.poses[i])) / problem.weight;
        for (int k = 0; k < 6; ++k)
            if (is_free(body, k)) residual[k] = 0;
        if (residual.isZero(0)) continue;
        const Vector3& theta = points[i].rotation_vector;
        out.push_back(
            {static_cast<int>(i), residual.head<3>(), kinematics::left_jacobian(theta).transpose().inverse() * residual.tail<3>()});
    }
    return out;
}

}  // namespace

StepOutputs step_outputs(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved,
                         const StepState& end) {
    StepOutputs out;
    out.time = end.time;
    out.kappa = problem.kappa;
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
        if (model.bodies[i].moments(3, 3) > 0) add_body(model, model.bodies[i], end.history.poses[i], end.history.velocities[i], out);
    energy::StepProblem last = problem;
    last.friction = solved.friction;
    for (const contact::BodyPairContacts& list : solved.contacts.pairs)
        for (const contact::ContactPair& pair : list.contacts) out.contact_energy += pair_potential(pair, last.barrier) / last.weight;
    Forces forces(solved.poses, last.weight);
    forces.add_contacts(solved.contacts, last.barrier);
    forces.add_friction(last.friction);
    out.contacts = forces.take();
    out.drives = drive_forces(model, last, solved);
    return out;
}

}  // namespace fettle::core::stepper
