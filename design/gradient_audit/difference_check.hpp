// SPDX-License-Identifier: MIT
/// Audit of a design's gradients: central differences of whole simulations. How the differences are weighed goes by themselves and by the
/// noise of the quantities, never by comparing them with the adjoint. The same simulations show which contacts are about to change.
///
///     const VectorX p = design::description::values_of(problem.design().parameters);
///     const auto check = design::gradient_audit::check_gradients(problem, p, problem.evaluate(p));
///     for (const auto& row : check.rows)
///         std::printf("d %s / d %s = %g, by differences %g\n", row.quantity.c_str(), row.parameter.c_str(), row.adjoint, row.difference);
///     for (const auto& parameter : check.failures) std::printf("%s is not checked\n", parameter.c_str());
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "design/gradient_audit/contact_changes.hpp"
#include "design/gradient_audit/roughness.hpp"
#include "design/gradient_audit/sweep_agreement.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::gradient_audit {

/// The best derivative estimate from central differences D(s) of shrinking step size, by Richardson extrapolation
///   T(i, 0) = D(s_i),  T(i, j) = T(i, j-1) + (T(i, j-1) - T(i-1, j-1)) / (r^(2j) - 1)    with r = s_i-1 / s_i
/// Among all T(i, j) the one with the smallest estimated error is taken: max(|T(i, j) - T(i, j-1)|, |T(i, j) - T(i-1, j-1)|), and no less
/// than what noise makes of D(s_i).
/// Source: Ridders 1982, Advances in Engineering Software 4(2).
struct DifferenceEstimate {
    double value = 0;
    double error = 0;        ///< estimated; infinity for a single difference
    double noise_error = 0;  ///< of which noise makes up this
};
/// @param noise_error  Error that noise gives the first difference; it grows with r, as steps shrink.
DifferenceEstimate ridders_estimate(const std::vector<double>& differences, double ratio, double noise_error = 0);

/// The differences of a quantity to either side of a point, by steps that shrink.
struct SideSlopes {
    std::vector<double> steps, below, above;  ///< of one size
};
/// The slopes of both sides where they stay apart however small the step.
struct Kink {
    double below = 0, above = 0;
    double error = 0;  ///< of either, estimated: the change by the last step, plus noise
    double jump() const { return above - below; }
    /// Contract: jump() != 0.
    bool lies_between(double slope, double accuracy) const;
};
/// Finds a kink by the jump above - below, at the least step where the jump stands clear of noise. Where a quantity is smooth, the jump
/// falls in proportion to the step. It is a kink if more than 0.6 of the jump at the step before remains, if it exceeds `least`, and if the
/// slopes are known to less than it.
/// @param noise  The standard deviation of the quantity's noise. @return a jump of 0: none
Kink kink_of(const SideSlopes& slopes, double noise, double least);

struct CheckOptions {
    /// Steps of a central difference, in shares of the parameter's range: the first where gradients hold farther, and the largest, where
    /// noise asks for more.
    double usual_step = 1e-3, largest_step = 1e-2;
    double ratio = 4;     ///< of successive step sizes
    int sizes = 5;        ///< largest number of step sizes; fewer where noise, or the accuracy that `limit` needs, is reached before
    double limit = 1e-5;  ///< relative error that is asked for
    /// relative error = |a - d| / max(|a|, |d|, scale_fraction |gradient of the quantity|, size_fraction |quantity|, its tolerance, e /
    /// limit) per unit of the parameter's range, e the error that noise makes in d: a component that is nothing beside the others, or
    /// changes nothing that counts over the whole range of its parameter, is compared at their scale.
    double scale_fraction = 1e-3, size_fraction = 1e-4;
    int line_sizes = 8;       ///< step sizes along the gradient, each 1/sqrt(10) of the one before; 0: none
    int most_parameters = 0;  ///< look at those alone that the objective's gradient, in shares of their ranges, is largest in; 0: at all
    double contact_reach = 1e-2;  ///< how far contacts that change are looked for, in shares of the ranges; 0: as far as differences go
    /// Spacing of noise and rounding, distances; its callbacks are not used.
    RoughnessOptions roughness = {.fine_spacing = 1e-6, .distances = 6};
    std::function<void(int done, int of)> on_simulation;  ///< optional; `of` is the most that it can take
    std::function<bool()> should_stop;                    ///< optional
};

struct CheckRow {
    std::string quantity, parameter;     ///< "objective" or a constraint's name
    double adjoint = 0, difference = 0;  ///< SI
    double difference_error = 0;         ///< that the difference estimates of itself, relative like relative_error
    double relative_error = 0;
    /// Slope above minus slope below [SI], where they differ however small the step: there is no derivative, and a right adjoint is that of
    /// one side, or lies between the two (witnesses of a clearance that tie, closest features that change ...). 0: none was met.
    double kink = 0;
    bool lies_between = false;  ///< at a kink, the adjoint, as well as the slopes of both sides are known
    bool resolved = true;       ///< false: noise leaves more open than `limit`: an error up to difference_error may be the difference's own
};

/// The same along the direction of the roughness (the objective's gradient, within the bounds): per unit of t, in shares of the ranges.
struct LineRow {
    std::string quantity;
    double adjoint = 0, difference = 0, difference_error = 0, relative_error = 0;  ///< as CheckRow's
    bool resolved = true;
    double kink = 0;            ///< these two as CheckRow's, per unit of t
    bool lies_between = false;  ///< of the slopes of both sides
    /// Slope of ln |q(t) - q(0) - t q'(0)| over ln t, on the side where it is farther from 2, over the least steps (four or five) at which
    /// that stands clear of noise: 2 where q is smooth, 1 of a wrong gradient. NaN: noise hides it, the gradient predicts to that.
    double slope = 0;
};

struct CheckReport {
    std::vector<CheckRow> rows;         ///< per quantity and parameter
    std::vector<LineRow> along;         ///< per quantity; empty where the line could not be simulated
    SweepAgreement sweeps;              ///< of the design's own simulation
    std::vector<std::string> left_out;  ///< parameters, where not all are looked at
    double largest_relative_error = 0;
    RoughnessReport roughness;                   ///< along downhill_direction, unless told otherwise
    double first_step = 0;                       ///< step, in shares of the parameters' ranges, that differences begin with
    std::vector<ContactChange> contact_changes;  ///< nearest first, by their share of the parameters' ranges
    MatrixX contacts_reach;  ///< parameter x (below, above): to what share of its range they were looked for; 0: not at all
    int simulations = 0;
    std::vector<std::string> failures;  ///< parameters whose neighbours could not be simulated: not checked
    bool interrupted = false;
};

/// The most simulations that the check of a design of `parameters` parameters takes, unless trials fail.
int check_cost(int parameters, const CheckOptions& options = {});

/// First the roughness. Differences begin at the length over which the gradients of all quantities hold, and end where noise outweighs what
/// a smaller step gains.
/// @param at  Evaluated at p with gradients.
CheckReport check_gradients(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                            const CheckOptions& options = {});

}  // namespace fettle::design::gradient_audit
