// SPDX-License-Identifier: MIT
#include "adjoint/clearance/contact_gap_adjoint.hpp"

#include <Eigen/Geometry>

#include "adjoint/contact/pair_bodies.hpp"

namespace fettle::adjoint::clearance {

void contact_gap_adjoint(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses,
                         const core::clearance::ContactGap& gap, double scale, std::vector<Matrix34>& pose_bar, ModelGradient& model_bar) {
    const core::contact::ContactPair& pair = gap.contact;
    const double sided = (pair.round.side == 0 ? 1 : pair.round.side) * scale;
    const Vector3 n = core::contact::contact_normal(pair);
    for (int i = 0; i < 4; ++i) {
        const int body = i < first_count(pair.type) ? gap.first : gap.second;
        const core::kinematics::Pose& pose = poses[body];
        const Vector3 force = sided * pair.closest.weight[i] * n, torque = (pair.x[i] - pose.position).cross(force);
        pose_bar[body].leftCols<3>() += 0.5 * cross_matrix(torque) * pose.rotation;
        pose_bar[body].col(3) += force;
        contact::add_vertex_gradient(model.bodies[body], pair.vertex[i], pose.rotation.transpose() * force,
                                     model_bar.bodies[body].vertices_bar);
    }
    if (pair.round.side == 0) return;
    contact::add_reach_gradient(model.bodies[gap.first], pair.round, 0, -sided, model_bar.bodies[gap.first].vertices_bar);
    contact::add_reach_gradient(model.bodies[gap.second], pair.round, 1, -sided, model_bar.bodies[gap.second].vertices_bar);
}

}  // namespace fettle::adjoint::clearance
