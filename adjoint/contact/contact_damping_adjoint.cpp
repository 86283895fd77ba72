// SPDX-License-Identifier: MIT
#include "adjoint/contact/contact_damping_adjoint.hpp"

#include <Eigen/Geometry>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "adjoint/contact/pair_bodies.hpp"

namespace fettle::adjoint::contact {
namespace {

using core::contact::BarrierParameters;
using core::contact::ContactPair;
using core::contact::DampedPair;

// What of a contact does not depend on the seed or the direction.
struct DampedPairSlopes {
    DampedPair pair;
    std::array<int, 4> body;
    Four X, end, start;       // undeformed vertices; dphi/dx at the end and at P0
    Four eps;                 // deps/dX: 0 where phi depends on eps neither at the end nor at P0
    Four end_eps;             // d(dphi/dx)/deps at the end
    double closeness_by_eps;  // d(phi - phi_t0)/deps
    double weight;            // of the contact: in the stiffness
    Four end_dmin;            // d(dphi/dx)/ddmin at the end
    double slope_by_dmin;     // da/ddmin
};

double closeness_by_eps(const ContactPair& pair, const BarrierParameters& closeness) {
    return is_mollified(pair) ? pair_potential_eps_derivative(pair, closeness) : 0;
}

DampedPairSlopes slopes_of(const DampedContacts& at, const core::contact::BodyPairContacts& list, const ContactPair& contact) {
    const BarrierParameters& closeness = at.damping.closeness;
    DampedPairSlopes s;
    s.pair = damped_pair(at.model, at.damping, list, contact);
    s.body = bodies_of(list, contact);
    s.weight = contact.weight;
    s.X = undeformed(at.model, s.body, contact);
    s.end = pair_forces(s.pair.end, closeness);
    s.start = pair_forces(s.pair.start, closeness);
    s.eps = s.end_eps = {Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    if (is_mollified(s.pair.end) || is_mollified(s.pair.start)) s.eps = mollifier_eps_gradient(s.X[0], s.X[1], s.X[2], s.X[3]);
    if (is_mollified(s.pair.end)) s.end_eps = pair_forces_eps_derivative(s.pair.end, closeness);
    s.closeness_by_eps = closeness_by_eps(s.pair.end, closeness) - closeness_by_eps(s.pair.start, closeness);
    const double hat_slope = 2 * (closeness.activation - closeness.dmin) / closeness.gap_hat, slope = -2 * hat_slope;
    s.end_dmin = pair_forces_dmin_derivative(s.pair.end, closeness, slope);
    s.slope_by_dmin = (barrier_factor_slope(closeness) - slope) * s.pair.slope() +
                      s.pair.stiffness * (pair_potential_dmin_derivative(s.pair.end, closeness, slope) -
                                          pair_potential_dmin_derivative(s.pair.start, closeness, slope));
    return s;
}

template <class Visit>
void for_each_damped(const DampedContacts& at, const Visit& visit) {
    std::size_t place = 0;
    for (const core::contact::BodyPairContacts& list : at.contacts.pairs)
        for (const ContactPair& contact : list.contacts) {
            visit(slopes_of(at, list, contact), at.areas == nullptr ? nullptr : &at.areas->shares[place]);
            ++place;
        }
}

}  // namespace

void subtract_contact_damping_adjoint(const DampedContacts& at, const std::vector<std::vector<Vector6>>& lambda,
                                      const DampingGradients& to) {
    for_each_damped(at, [&](const DampedPairSlopes& p, const std::vector<core::contact::AreaShare>* of_weight) {
        const double a = p.pair.slope();
        for (std::size_t s = 0; s < lambda.size(); ++s) {
            Four v;
            for (int i = 0; i < 4; ++i) {
                const Vector6& motion = lambda[s][p.body[i]];
                v[i] = motion.head<3>() + motion.tail<3>().cross(p.pair.end.x[i] - at.poses[p.body[i]].position);
            }
            const Four change = pair_hessian_product(p.pair.end, at.damping.closeness, v);
            const double along = p.pair.stiffness * dot(p.end, v);
            if (of_weight != nullptr) add_weight_gradient(*of_weight, -a * dot(p.end, v) / p.weight, to.areas_bar[s]);
            const double eps_bar = a * dot(p.end_eps, v) + along * p.closeness_by_eps;
            to.model_bar[s].dmin_bar -= a * dot(p.end_dmin, v) + p.slope_by_dmin * dot(p.end, v);
            for (int i = 0; i < 4; ++i) {
                const int body = p.body[i];
                const Matrix3 &R = at.poses[body].rotation, R0 = at.damping.start[body].leftCols<3>();
                const Vector3 turned = change[i] - lambda[s][body].tail<3>().cross(p.end[i]);
                to.model_bar[s].bodies[body].vertices_bar.col(p.pair.end.vertex[i]) -=
                    R.transpose() * (a * turned + along * p.end[i]) - along * R0.transpose() * p.start[i] + eps_bar * p.eps[i];
                to.start_bar[s][body] += along * p.start[i] * p.X[i].homogeneous().transpose();
            }
        }
    });
}

void add_contact_damping_tangent(const DampedContacts& at, const DampingChanges& dot_of, const ModelTangent& direction,
                                 PoseGradientTangent& out) {
    for_each_damped(at, [&](const DampedPairSlopes& p, const std::vector<core::contact::AreaShare>* of_weight) {
        Four X_dot, v, v_start;
        for (int i = 0; i < 4; ++i) {
            const int body = p.body[i];
            X_dot[i] = direction.bodies[body].vertices_dot.col(p.pair.end.vertex[i]);
            v[i] = dot_of.poses_dot[body] * p.X[i].homogeneous() + at.poses[body].rotation * X_dot[i];
            v_start[i] = dot_of.start_dot[body] * p.X[i].homogeneous() + at.damping.start[body].leftCols<3>() * X_dot[i];
        }
        const double eps_dot = dot(p.eps, X_dot), a = p.pair.slope();
        double a_dot = p.pair.stiffness * (dot(p.end, v) - dot(p.start, v_start) + p.closeness_by_eps * eps_dot);
        a_dot += p.slope_by_dmin * direction.dmin_dot;
        if (of_weight != nullptr) a_dot += a * weight_tangent(*of_weight, dot_of.areas_dot) / p.weight;
        const Four change = pair_hessian_product(p.pair.end, at.damping.closeness, v);
        for (int i = 0; i < 4; ++i) {
            const int body = p.body[i];
            const Vector3 force_dot = a_dot * p.end[i] + a * (change[i] + eps_dot * p.end_eps[i] + direction.dmin_dot * p.end_dmin[i]);
            out.value[body] += a * p.end[i] * p.X[i].homogeneous().transpose();
            out.dot[body] += force_dot * p.X[i].homogeneous().transpose();
            out.dot[body].leftCols<3>() += a * p.end[i] * X_dot[i].transpose();
        }
    });
}

}  // namespace fettle::adjoint::contact
