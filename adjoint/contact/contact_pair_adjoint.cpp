// SPDX-License-Identifier: MIT
#include "adjoint/contact/contact_pair_adjoint.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/contract.hpp"

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

BarrierByDmin barrier_by_dmin(double distance_squared, const BarrierParameters& p, double slope) {
    const double g = distance_squared - p.dmin * p.dmin, below = p.gap_hat - g;
    if (!(below > 0)) return {};
    const core::contact::ScalarDerivatives b = core::contact::barrier(g, p.gap_hat);
    const double log_ratio = std::log(g / p.gap_hat), gap_dot = -2 * p.dmin, hat_dot = 2 * (p.activation - p.dmin);
    const double value_hat = below * below / p.gap_hat - 2 * below * log_ratio;
    const double first_hat = 2 * log_ratio - p.gap_hat / g + 1 - below * (2 / p.gap_hat + 1 / g);
    return {p.factor * (slope * b.value + gap_dot * b.first + hat_dot * value_hat),
            p.factor * (slope * b.first + gap_dot * b.second + hat_dot * first_hat)};
}

BarrierByDmin pair_barrier_by_dmin(const ContactPair& pair, const BarrierParameters& p, double slope) {
    const core::contact::RoundGap& round = pair.round;
    if (round.side == 0) return barrier_by_dmin(pair.closest.distance_squared, p, slope);
    const double d = std::sqrt(pair.closest.distance_squared), radius = round.radius();
    const double s = round.side * (d - radius), inverse = d > 0 ? 1 / d : 0;  // where centre lines are one it is times r = 0
    BarrierByDmin b = barrier_by_dmin(s * s, p, slope);
    b.first *= round.side * s * inverse;
    if (!round.has_far) return b;
    const BarrierByDmin far = barrier_by_dmin((radius + d) * (radius + d), p, slope);
    return {b.value + far.value, b.first + far.first * (radius + d) * inverse};
}

std::array<Vector3, 4> pair_forces_radius_derivative(const ContactPair& pair, const BarrierParameters& p) {
    const double slope = p.factor * pair.weight * core::contact::round_barrier(pair, p).slope_by_radius;
    const Vector3 n = core::contact::contact_normal(pair);
    std::array<Vector3, 4> out;
    for (int i = 0; i < 4; ++i) out[i] = slope * pair.closest.weight[i] * n;
    return out;
}

std::array<Vector3, 4> pair_forces_dmin_derivative(const ContactPair& pair, const BarrierParameters& p, double slope) {
    const BarrierByDmin b = pair_barrier_by_dmin(pair, p, slope);
    const bool mollified = is_mollified(pair);
    const Vector3 e1 = pair.x[1] - pair.x[0], e2 = pair.x[3] - pair.x[2], n = e1.cross(e2);
    const core::contact::ScalarDerivatives m =
        mollified ? core::contact::edge_mollifier(n.squaredNorm(), pair.mollifier_eps) : core::contact::ScalarDerivatives{1, 0, 0};
    std::array<Vector3, 4> out;
    for (int i = 0; i < 4; ++i) out[i] = 2 * pair.weight * m.value * b.first * pair.closest.weight[i] * pair.closest.difference;
    if (!mollified) return out;
    const Vector3 c1 = 2 * e2.cross(n), c2 = 2 * n.cross(e1);
    const double cross = pair.weight * b.value * m.first;
    out[0] -= cross * c1;
    out[1] += cross * c1;
    out[2] -= cross * c2;
    out[3] += cross * c2;
    return out;
}

double pair_potential_dmin_derivative(const ContactPair& pair, const BarrierParameters& p, double slope) {
    const double m =
        is_mollified(pair) ? core::contact::edge_mollifier(core::contact::edge_cross_squared(pair.x), pair.mollifier_eps).value : 1;
    return pair.weight * m * pair_barrier_by_dmin(pair, p, slope).value;
}

std::array<Vector3, 4> mollifier_eps_gradient(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1) {
    const Vector3 e1 = ea1 - ea0, e2 = eb1 - eb0;
    const Vector3 d1 = 2 * core::contact::mollifier_scale * e2.squaredNorm() * e1;
    const Vector3 d2 = 2 * core::contact::mollifier_scale * e1.squaredNorm() * e2;
    return {-d1, d1, -d2, d2};
}

}  // namespace fettle::adjoint::contact
