// SPDX-License-Identifier: MIT
#include "fettle/adjoint/contact/contact_pair_adjoint.hpp"

#include <Eigen/Geometry>

#include "fettle/core/base/contract.hpp"

namespace fettle::adjoint::contact {

using core::contact::BarrierParameters;
using core::contact::ContactPair;

std::array<Vector3, 4> pair_forces_eps_derivative(const ContactPair& pair, const BarrierParameters& p) {
    FETTLE_ASSERT(is_mollified(pair), "the forces of this pair do not depend on eps");
    const Vector3 e1 = pair.x[1] - pair.x[0], e2 = pair.x[3] - pair.x[2];
    const Vector3 n = e1.cross(e2);
    const Vector3 c1 = 2 * e2.cross(n), c2 = 2 * n.cross(e1);
    const double eps = pair.mollifier_eps, x = n.squaredNorm() / eps;
    const auto b = core::contact::barrier(pair.closest.distance_squared - p.dmin * p.dmin, p.gap_hat);
    const double factor = p.factor * pair.weight;
    const double distance = 2 * factor * b.first * (-2 * x * (1 - x) / eps);
    const double cross = factor * b.value * (4 * x - 2) / (eps * eps);
    std::array<Vector3, 4> out;
    for (int i = 0; i < 4; ++i) out[i] = distance * pair.closest.weight[i] * pair.closest.difference;
    out[0] -= cross * c1;
    out[1] += cross * c1;
    out[2] -= cross * c2;
    out[3] += cross * c2;
    return out;
}

double pair_potential_eps_derivative(const ContactPair& pair, const BarrierParameters& p) {
    FETTLE_ASSERT(is_mollified(pair), "the potential of this pair does not depend on eps");
    const double x = core::contact::edge_cross_squared(pair.x) / pair.mollifier_eps;
    const double b = core::contact::barrier(pair.closest.distance_squared - p.dmin * p.dmin, p.gap_hat).value;
    return p.factor * pair.weight * b * (-2 * x * (1 - x) / pair.mollifier_eps);
}

std::array<Vector3, 4> mollifier_eps_gradient(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    const Vector3 e1 = ea1 - ea0, e2 = eb1 - eb0;
    const Vector3 d1 = 2 * core::contact::mollifier_scale * e2.squaredNorm() * e1;
    const Vector3 d2 = 2 * core::contact::mollifier_scale * e1.squaredNorm() * e2;
    return {-d1, d1, -d2, d2};
}

}  // namespace fettle::adjoint::contact
