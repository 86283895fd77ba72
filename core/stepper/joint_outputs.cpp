// SPDX-License-Identifier: MIT
#include "core/stepper/joint_outputs.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/limits.hpp"

namespace fettle::core::stepper {
namespace {

using model::Joint;
using model::Mechanism;

// B1 of docs/method/collision.md, of a point fixed in the body.
double deviation(const kinematics::Pose& base, const kinematics::ChartPoint& from, const kinematics::ChartPoint& to, const Vector3& X) {
    const Vector3 w = to.rotation_vector - from.rotation_vector, Y = base.rotation * X;
    const double bound = w.cross(Y).norm() + from.rotation_vector.cross(w).norm() * Y.norm() / 3;
    return w.norm() * std::min(bound, w.norm() * Y.norm()) / 8;
}

// What its spring, damper, friction and stops push a joint's coordinate with.
void add_own_forces(const Mechanism& mechanism, const std::vector<double>& measure_forces, std::vector<JointForce>& out) {
    for (std::size_t k = 0; k < measure_forces.size(); ++k) {
        const model::MeasureTerm& term = mechanism.terms[k];
        if (term.origin.list != model::Origin::List::joint) continue;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const Joint& joint = mechanism.joints[i];
            if (joint.is_motor || joint.origin.index != term.origin.index) continue;
            switch (term.kind) {
                case model::LawKind::spring:
                    out[i].spring += measure_forces[k];
                    break;
                case model::LawKind::damper:
                    out[i].damping += measure_forces[k];
                    break;
                case model::LawKind::friction:
                    out[i].friction += measure_forces[k];
                    break;
                case model::LawKind::stop:
                    // A swing is measured by a cosine: this is the torque.
                    out[i].stop +=
                        is_swing(mechanism, term) ? -measure_forces[k] * std::sqrt(1 - term.reference * term.reference) : measure_forces[k];
                    break;
                case model::LawKind::force:  // a motor's
                    break;
            }
        }
    }
}

}  // namespace

std::vector<JointForce> joint_forces(const energy::StepProblem& problem, const std::vector<kinematics::Pose>& poses,
                                     const VectorX& multipliers, const std::vector<double>& measure_forces) {
    const Mechanism& mechanism = problem.model->mechanism;
    std::vector<JointForce> out(mechanism.joints.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i].joint = static_cast<int>(i);
    add_own_forces(mechanism, measure_forces, out);
    if (multipliers.size() != static_cast<Eigen::Index>(mechanism.rows.size())) return out;
    const std::vector<measure::PlacedFrame> frames = placed(mechanism.set.frames, poses);
    const constraint::RowJacobian rows = row_jacobian(mechanism.set, mechanism.rows, frames);
    for (int i = 0; i < rows.count(); ++i) {
        const int owner = mechanism.rows[i].owner;
        const Joint& joint = mechanism.joints[owner];
        JointForce& acting = out[owner];
        const double force = -multipliers[i] / problem.weight;
        if (joint.is_motor) acting.effort += force;
        if (scene::couples_joints(joint.kind)) acting.effort += force * mechanism.rows[i].parts[1].factor;
        const int body = joint.b != measure::world ? joint.b : joint.a;
        for (int k = rows.first[i]; k < rows.first[i + 1]; ++k) {
            const constraint::RowGradient& e = rows.entries[k];
            if (e.body != body || joint.frame_b < 0) continue;
            const Vector3 f = force * e.gradient.head<3>();
            acting.force += f;
            const measure::PlacedFrame& at = frames[joint.b != measure::world ? joint.frame_b : joint.frame_a];
            acting.torque += force * e.gradient.tail<3>() - at.arm.cross(f);
        }
    }
    return out;
}

double path_gap_bound(const model::Model& model, const std::vector<kinematics::Pose>& poses_t0, const TrajectoryStep& path) {
    double most = 0;
    for (const Joint& joint : model.mechanism.joints) {
        if (joint.frame_a < 0 || joint.is_motor) continue;
        for (std::size_t k = 0; k + 1 < path.nodes.size(); ++k) {
            double gap = 0;
            for (const int f : {joint.frame_a, joint.frame_b}) {
                const measure::Frame& frame = model.mechanism.set.frames[f];
                if (frame.body == measure::world) continue;
                const auto body = static_cast<std::size_t>(frame.body);
                gap += deviation(poses_t0[body], path.nodes[k][body], path.nodes[k + 1][body], frame.point);
            }
            most = std::max(most, gap);
        }
    }
    return most;
}

}  // namespace fettle::core::stepper
