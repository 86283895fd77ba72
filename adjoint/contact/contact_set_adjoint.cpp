// SPDX-License-Identifier: MIT
#include "adjoint/contact/contact_set_adjoint.hpp"

#include <Eigen/Geometry>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "adjoint/contact/pair_bodies.hpp"
#include "core/base/contract.hpp"

namespace fettle::adjoint::contact {
namespace {

using core::contact::AreaShare;
using core::contact::ContactPair;

// The shares of one contact after the other; null where nothing is area-weighted.
class SharesInOrder {
public:
    explicit SharesInOrder(const ContactsAtPose& at) : areas_(at.areas) {
        FETTLE_ASSERT(areas_ == nullptr || count_of(areas_->shares) == at.contacts.count, "each contact has its shares");
    }
    const std::vector<AreaShare>* next() { return areas_ == nullptr ? nullptr : &areas_->shares[next_++]; }

private:
    const core::contact::ContactAreas* areas_;
    std::size_t next_ = 0;
};

}  // namespace

void subtract_contact_vertices_adjoint(const ContactsAtPose& at, const std::vector<std::vector<Vector6>>& lambda,
                                       std::vector<ModelGradient>& model_bar, std::vector<std::vector<AreaChange>>& areas_bar) {
    SharesInOrder shares(at);
    for (const core::contact::BodyPairContacts& list : at.contacts.pairs)
        for (const ContactPair& pair : list.contacts) {
            const std::vector<AreaShare>* of_weight = shares.next();
            const std::array<int, 4> body = bodies_of(list, pair);
            const Four force = pair_forces(pair, at.parameters),
                       force_dmin = pair_forces_dmin_derivative(pair, at.parameters, barrier_factor_slope(at.parameters));
            const bool mollified = is_mollified(pair), is_round = pair.round.side != 0;
            const Four force_radius = is_round ? pair_forces_radius_derivative(pair, at.parameters) : Four{};
            Four force_eps, eps_gradient;
            if (mollified) {
                const Four X = undeformed(at.model, body, pair);
                force_eps = pair_forces_eps_derivative(pair, at.parameters);
                eps_gradient = mollifier_eps_gradient(X[0], X[1], X[2], X[3]);
            }
            for (std::size_t s = 0; s < lambda.size(); ++s) {
                Four v;
                for (int i = 0; i < 4; ++i) {
                    const Vector6& motion = lambda[s][body[i]];
                    v[i] = motion.head<3>() + motion.tail<3>().cross(pair.x[i] - at.poses[body[i]].position);
                }
                if (of_weight != nullptr) add_weight_gradient(*of_weight, -dot(force, v) / pair.weight, areas_bar[s]);
                model_bar[s].dmin_bar -= dot(force_dmin, v);
                const Four change = pair_hessian_product(pair, at.parameters, v);
                const double eps_bar = mollified ? dot(force_eps, v) : 0.0;
                for (int i = 0; i < 4; ++i) {
                    Vector3 vertex_bar =
                        at.poses[body[i]].rotation.transpose() * (change[i] - lambda[s][body[i]].tail<3>().cross(force[i]));
                    if (mollified) vertex_bar += eps_bar * eps_gradient[i];
                    add_vertex_gradient(at.model.bodies[body[i]], pair.vertex[i], -vertex_bar, model_bar[s].bodies[body[i]].vertices_bar);
                }
                if (!is_round) continue;
                const double radius_bar = -dot(force_radius, v);
                add_reach_gradient(at.model.bodies[list.first], pair.round, 0, radius_bar, model_bar[s].bodies[list.first].vertices_bar);
                add_reach_gradient(at.model.bodies[list.second], pair.round, 1, radius_bar, model_bar[s].bodies[list.second].vertices_bar);
            }
        }
}

void add_contact_gradient_tangent(const ContactsAtPose& at, const std::vector<Matrix34>& poses_dot, const ModelTangent& direction,
                                  const std::vector<AreaChange>& areas_dot, PoseGradientTangent& out) {
    SharesInOrder shares(at);
    for (const core::contact::BodyPairContacts& list : at.contacts.pairs)
        for (const ContactPair& pair : list.contacts) {
            const std::vector<AreaShare>* of_weight = shares.next();
            const std::array<int, 4> body = bodies_of(list, pair);
            const Four X = undeformed(at.model, body, pair);
            Four X_dot, v;
            for (int i = 0; i < 4; ++i) {
                X_dot[i] = vertex_tangent(at.model.bodies[body[i]], pair.vertex[i], direction.bodies[body[i]].vertices_dot);
                v[i] = poses_dot[body[i]] * X[i].homogeneous() + at.poses[body[i]].rotation * X_dot[i];
            }
            const Four force = pair_forces(pair, at.parameters);
            Four force_dot = pair_hessian_product(pair, at.parameters, v);
            if (is_mollified(pair)) {
                const double eps_dot = dot(mollifier_eps_gradient(X[0], X[1], X[2], X[3]), X_dot);
                const Four force_eps = pair_forces_eps_derivative(pair, at.parameters);
                for (int i = 0; i < 4; ++i) force_dot[i] += eps_dot * force_eps[i];
            }
            if (pair.round.side != 0) {
                const double radius_dot =
                    reach_tangent(at.model.bodies[list.first], pair.round, 0, direction.bodies[list.first].vertices_dot) +
                    reach_tangent(at.model.bodies[list.second], pair.round, 1, direction.bodies[list.second].vertices_dot);
                const Four force_radius = pair_forces_radius_derivative(pair, at.parameters);
                for (int i = 0; i < 4; ++i) force_dot[i] += radius_dot * force_radius[i];
            }
            if (direction.dmin_dot != 0) {
                const Four force_dmin = pair_forces_dmin_derivative(pair, at.parameters, barrier_factor_slope(at.parameters));
                for (int i = 0; i < 4; ++i) force_dot[i] += direction.dmin_dot * force_dmin[i];
            }
            const double weight_dot = of_weight == nullptr ? 0 : weight_tangent(*of_weight, areas_dot) / pair.weight;
            for (int i = 0; i < 4; ++i) {
                if (weight_dot != 0) force_dot[i] += weight_dot * force[i];
                out.value[body[i]] += force[i] * X[i].homogeneous().transpose();
                out.dot[body[i]] += force_dot[i] * X[i].homogeneous().transpose();
                out.dot[body[i]].leftCols<3>() += force[i] * X_dot[i].transpose();
            }
        }
}

}  // namespace fettle::adjoint::contact
