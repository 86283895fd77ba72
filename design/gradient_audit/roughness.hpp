// SPDX-License-Identifier: MIT
/// How rough a design's quantities are, and how far their gradients hold: looked at along one line in the parameters, with few simulations.
/// A gradient is exact where it is taken; where parts rattle in their play it may hold for microns only, and then neither an optimiser's
/// step nor a difference is what it predicts.
///
/// Along p(t) = p + t * direction * ranges (gradient_audit/design_line.hpp) every quantity q has
/// - its noise at moves of `spacing` (optimisers/noise.hpp): the scatter that moves of that size see, whatever makes it;
/// - its rounding, the same at `fine_spacing`: what remains when the design hardly moves (differences take their steps from it). It is
/// looked
///   for on one side of p alone: a kink at p, where the best designs often lie, is no rounding;
/// - the length over which its gradient holds: |q(t) - q(0) - t q'(0)| <= max(share |t q'(0)|, tolerance, 4 rounding), q' by the adjoint.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "design/optimisers/noise.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::gradient_audit {

struct RoughnessOptions {
    VectorX direction = {};                                    ///< in shares of the parameters' ranges; empty: downhill_direction
    double spacing = 1e-3;                                     ///< of the points between which noise is looked for, in shares of the ranges
    double fine_spacing = 0;                                   ///< of those for rounding, all on one side; 0: not measured
    int intervals = 6;                                         ///< simulations for each of the two. Contract: >= 4
    int distances = 4;                                         ///< further simulations, for the lengths; even
    double share = 0.1;                                        ///< by which a prediction may be off
    VectorX tolerances = {};                                   ///< per quantity, SI; empty: quantity_tolerances
    std::function<void(int done, int of)> on_simulation = {};  ///< optional
    std::function<bool()> should_stop = {};                    ///< optional
};

struct QuantityRoughness {
    std::string name;              ///< "objective" or a constraint's
    double size = 0;               ///< largest value met
    double slope = 0;              ///< q'(0), per unit of t, by the adjoint
    optimisers::NoiseLevel noise;  ///< SI
    optimisers::NoiseLevel fine;   ///< at fine_spacing, if it was measured
    double rounding = 0;           ///< fine.noise, and no less than the rounding of `size`
    double holds = 0;              ///< largest |t| simulated up to which all agree with the gradient; 0: none does
    double breaks = 0;             ///< the next one, which does not; infinity: none was met
    double tolerance = 0;          ///< SI
    bool rough = false;            ///< noise was detected, and exceeds the tolerance
};

struct RoughnessReport {
    bool measured = false;    ///< else `quantities` is empty
    VectorX direction = {};   ///< largest component 1 or -1
    double spacing = 0;       ///< used: less than asked for where the bounds leave no room, or trials fail
    double fine_spacing = 0;  ///< 0: not measured
    std::vector<QuantityRoughness> quantities;
    int simulations = 0;
    std::vector<std::string> failures;  ///< points that could not be simulated, with the reason
    bool interrupted = false;
};

/// @param at  Evaluated at p with gradients.
/// Takes intervals (twice with fine_spacing) + distances simulations, 10 unless told otherwise; more, by `intervals`, for each time that
/// trials fail. The same bits for any number of threads.
RoughnessReport measure_roughness(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                                  const RoughnessOptions& options = {});

/// Against the objective's gradient, in shares of the ranges, without components that a bound stops; where nothing remains, away from the
/// nearer bounds. Largest component 1 or -1; zero only if no parameter has room.
VectorX downhill_direction(const description::Design& design, const VectorX& p, const VectorX& gradient);

/// What an optimiser of this design can resolve: the objective to settings.tolerance of its size (of 1 if that is less), a constraint to
/// its margin, and no finer than settings.tolerance in the unit that its violation is counted in. SI.
VectorX quantity_tolerances(const description::Design& design, const problem::DesignEvaluation& at);

/// Remedies that make a motion smoother, and with it what is measured of it, a sentence each.
std::vector<std::string> motion_remedies(const core::scene::Scene& scene);

/// What would make the rough quantities of the report smoother, a sentence each; empty if none is rough.
std::vector<std::string> roughness_remedies(const description::Design& design, const RoughnessReport& report);

}  // namespace fettle::design::gradient_audit
