// SPDX-License-Identifier: MIT
/// The barrier in squared distances, and the mollifier of nearly parallel edges. docs/method/contact.md#barrier.
/// Potential of one pair:  kappa / (4 (dmin + dhat)^2) * m * b(d^2 - dmin^2, 2 dmin dhat + dhat^2)  [J], so that kappa is in N/m:
/// near d = dmin + dhat it behaves as kappa times the barrier of plain distances.
#pragma once

#include <cmath>

namespace fettle::core::contact {

struct ScalarDerivatives {
    double value = 0, first = 0, second = 0;
};

/// b(g) = -(g - g_hat)^2 ln(g / g_hat) for 0 < g < g_hat, else 0; C2 at g_hat, unbounded as g -> 0+.
/// @param gap      g = d^2 - dmin^2 [m^2]. Contract: g > 0.
/// @param gap_hat  g_hat = 2 dmin dhat + dhat^2 [m^2].
/// @return         b [m^4], db/dg [m^2], d2b/dg2 [1]. Source: Li et al. 2020, Eq. 6, with squared distances for distances.
inline ScalarDerivatives barrier(double gap, double gap_hat) {
    if (gap >= gap_hat) return {};
    const double below = gap_hat - gap;
    const double log_ratio = std::log(gap / gap_hat);
    const double slope = 2 * log_ratio - gap_hat / gap + 1;
    return {-below * below * log_ratio, below * slope, -slope + below * (2 + gap_hat / gap) / gap};
}

/// m(c) = 2 c/eps - (c/eps)^2 for c < eps, else 1; C1 at eps. c = |e1 x e2|^2. Source: Li et al. 2020, Eq. 24.
inline ScalarDerivatives edge_mollifier(double cross_squared, double eps) {
    if (cross_squared >= eps) return {1, 0, 0};
    const double x = cross_squared / eps;
    return {x * (2 - x), 2 * (1 - x) / eps, -2 / (eps * eps)};
}

/// eps = mollifier_scale |E1|^2 |E2|^2 of the undeformed lengths.
inline constexpr double mollifier_scale = 1e-3;

struct BarrierParameters {
    double dmin = 0;        ///< [m]
    double activation = 0;  ///< dmin + dhat [m]
    double gap_hat = 0;     ///< 2 dmin dhat + dhat^2 [m^2]
    double factor = 0;      ///< multiplies m b: weight * kappa / (4 activation^2)
};

/// @param weight  factor on the potential energy (h^2 for implicit Euler).
inline BarrierParameters barrier_parameters(double dhat, double dmin, double kappa, double weight) {
    const double activation = dmin + dhat;
    return {dmin, activation, 2 * dmin * dhat + dhat * dhat, weight * kappa / (4 * activation * activation)};
}

}  // namespace fettle::core::contact
