// SPDX-License-Identifier: MIT
/// How rough a computed function is, estimated from a few of its values at equal spacing along a line, and the difference steps that
/// follow. Pure numerics: what the values are of, and along which line, is the caller's (gradient_audit/roughness.hpp).
///
/// A function of a simulation is f(t) = smooth(t) + noise(t): rounding, solver tolerances, contacts that come and go. Differences of order
/// k make smooth values smaller, by spacing^k, and noise of standard deviation eps larger, by sqrt((2k)!) / k!:
///   level_k = sqrt(gamma_k * mean over i of (Delta^k f(t_i))^2),   gamma_k = (k!)^2 / (2k)!
/// tends to eps as soon as the smooth part has dropped out.
/// Source: More and Wild 2011, Estimating computational noise, SIAM J. Sci. Comput. 33(3) (ECnoise). Two differences: values whose range is
/// large beside their size are judged like all others, so that adding a constant to f changes no answer (up to rounding), and where no
/// noise shows there is a bound on it.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::optimisers {

enum class NoiseStatus {
    detected,           ///< some k has differences of both signs, and levels k, k + 1, k + 2 are within a factor of 4 of each other
    spacing_too_small,  ///< at least half of neighbouring values are the same: the function does not resolve it; try 100 spacing
    spacing_too_large   ///< the levels go on falling: the smooth part hides the noise; try spacing / 100
};

struct NoiseLevel {
    /// Standard deviation, in the unit of the values. detected: level_k of the least such k. spacing_too_large: the least level of at least
    /// three differences, which noise does not exceed by much. spacing_too_small: level_1, of the jumps that were met; 0 if all are equal.
    double noise = 0;
    /// Derivatives of the parabola and the cubic nearest to the values (least squares), per unit of the line's parameter.
    double second_derivative = 0, third_derivative = 0;
    /// Standard deviation that the noise gives them: one that does not exceed its own says nothing.
    double second_derivative_error = 0, third_derivative_error = 0;
    NoiseStatus status = NoiseStatus::spacing_too_large;
};

/// @param values   f at m + 1 points t_0 + i spacing. Contract: m >= 4 (6 or more is better), all finite.
/// @param spacing  Contract: > 0.
NoiseLevel estimate_noise(const VectorX& values, double spacing);

/// Several quantities at once. @param values  (m + 1) x quantities, a row per point. @return  per quantity.
std::vector<NoiseLevel> estimate_noise_by_column(const MatrixX& values, double spacing);

/// Step of the forward difference (f(t + h) - f(t)) / h with the least expected error, 8^(1/4) sqrt(noise / |f''|); infinity for f'' = 0.
/// Source: More and Wild 2012, Estimating derivatives of noisy simulations, ACM Trans. Math. Softw. 38(3).
double best_forward_step(double noise, double second_derivative);

/// Step of the central difference (f(t + h) - f(t - h)) / (2 h) with the least error, (3 noise / |f'''|)^(1/3), the minimum of
/// noise / h + h^2 |f'''| / 6; infinity for f''' = 0.
double best_central_step(double noise, double third_derivative);

const char* to_string(NoiseStatus status);

}  // namespace fettle::design::optimisers
