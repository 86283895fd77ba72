// SPDX-License-Identifier: MIT
/// Dependence of one pair's forces (core/contact/contact_pair.hpp) on the mollifier's eps and on the minimum separation dmin, and of eps on
/// the undeformed edges:
///   eps = mollifier_scale |E1|^2 |E2|^2,   E1 = X1 - X0 in the first body's frame, E2 = X3 - X2 in the second's.
/// With x = c/eps, m = x (2 - x), m' = dm/dc = 2 (1 - x)/eps:
///   dm/deps = -2 x (1 - x)/eps,   dm'/deps = (4 x - 2)/eps^2,
/// and the forces f_i = factor weight (m b' 2 w_i r + b m' dc/dx_i) follow by the product rule. All is zero where m = 1.
/// With g = d^2 - dmin^2, g_hat = (dmin + dhat)^2 - dmin^2 and a factor that depends on dmin too,
///   d(factor b)/ddmin = factor' b + factor (-2 dmin b' + 2 dhat db/dg_hat),   db/dg_hat = (g_hat - g)^2/g_hat - 2 (g_hat - g) ln(g/g_hat),
/// and likewise with b' and db'/dg_hat = 2 ln(g/g_hat) - g_hat/g + 1 - (g_hat - g)(2/g_hat + 1/g).
#pragma once

#include <array>

#include "core/contact/contact_pair.hpp"

namespace fettle::adjoint::contact {

using core::contact::is_mollified;

/// df_i/deps (world) [N s^2/m^4 with the weight h^2]. Contract: is_mollified(pair).
std::array<Vector3, 4> pair_forces_eps_derivative(const core::contact::ContactPair& pair,
                                                  const core::contact::BarrierParameters& parameters);

/// d(potential)/deps = factor b dm/deps. Contract: is_mollified(pair).
double pair_potential_eps_derivative(const core::contact::ContactPair& pair, const core::contact::BarrierParameters& parameters);

/// df_i/dR of round surfaces (world) [N s^2/m with the weight h^2].
std::array<Vector3, 4> pair_forces_radius_derivative(const core::contact::ContactPair& pair,
                                                     const core::contact::BarrierParameters& parameters);

/// factor b and factor b' changing with dmin, at a distance held. @param slope  dfactor/ddmin over the factor [1/m]
struct BarrierByDmin {
    double value = 0, first = 0;
};
BarrierByDmin barrier_by_dmin(double distance_squared, const core::contact::BarrierParameters& parameters, double slope);

/// The same of a pair's b and db/dD, D = |r|^2; weight and mollifier are left out.
BarrierByDmin pair_barrier_by_dmin(const core::contact::ContactPair& pair, const core::contact::BarrierParameters& parameters,
                                   double slope);

/// The slope of a factor in proportion to 1/(dmin + dhat)^2: the barrier's.
inline double barrier_factor_slope(const core::contact::BarrierParameters& parameters) { return -2 / parameters.activation; }

/// df_i/ddmin (world).
std::array<Vector3, 4> pair_forces_dmin_derivative(const core::contact::ContactPair& pair,
                                                   const core::contact::BarrierParameters& parameters, double slope);

/// d(potential)/ddmin.
double pair_potential_dmin_derivative(const core::contact::ContactPair& pair, const core::contact::BarrierParameters& parameters,
                                      double slope);

/// deps/dX_i of the four undeformed vertices, each in its own body's frame [m^3].
std::array<Vector3, 4> mollifier_eps_gradient(const Vector3& ea0, const Vector3& ea1, const Vector3& eb0, const Vector3& eb1);

}  // namespace fettle::adjoint::contact
