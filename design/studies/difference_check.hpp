// SPDX-License-Identifier: MIT
/// Audit of a design's gradients: central differences of whole simulations. The step size is chosen from the differences alone, never by
/// comparing them with the adjoint.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/design/problem/design_problem.hpp"

namespace fettle::design::studies {

/// The best derivative estimate from central differences D(s) of shrinking step size, by Richardson extrapolation
///   T(i, 0) = D(s_i),  T(i, j) = T(i, j-1) + (T(i, j-1) - T(i-1, j-1)) / (r^(2j) - 1)    with r = s_i-1 / s_i
/// Of all T(i, j) the one with the smallest estimated error, max(|T(i, j) - T(i, j-1)|, |T(i, j) - T(i-1, j-1)|), is taken.
/// Source: Ridders 1982, Advances in Engineering Software 4(2).
struct DifferenceEstimate {
    double value = 0;
    double error = 0;  ///< estimated; infinity for a single difference
};
DifferenceEstimate ridders_estimate(const std::vector<double>& differences, double ratio);

struct CheckOptions {
    double first_step = 1e-3;  ///< of the parameter's range upper - lower
    double ratio = 4;          ///< of successive step sizes
    int sizes = 5;             ///< largest number of step sizes; fewer when estimates get worse
    /// Components below this fraction of the norm of their quantity's gradient, in parameters scaled by their ranges, are compared at that
    /// scale: relative error = |a - d| / max(|a|, |d|, fraction * norm).
    double scale_fraction = 1e-3;
    std::function<void(int done, int of)> on_parameter;  ///< optional
    std::function<bool()> should_stop;                   ///< optional
};

struct CheckRow {
    std::string quantity, parameter;     ///< "objective" or a constraint's name
    double adjoint = 0, difference = 0;  ///< SI
    double difference_error = 0;         ///< that the difference estimates of itself, relative like relative_error
    double relative_error = 0;
};

struct CheckReport {
    std::vector<CheckRow> rows;  ///< per quantity and parameter
    double largest_relative_error = 0;
    int simulations = 0;
    std::vector<std::string> failures;  ///< parameters whose neighbours could not be simulated: not checked
    bool interrupted = false;
};

/// @param at  Evaluated at p with gradients.
CheckReport check_gradients(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                            const CheckOptions& options = {});

}  // namespace fettle::design::studies
