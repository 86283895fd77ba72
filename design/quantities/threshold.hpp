// SPDX-License-Identifier: MIT
/// A quantity's numbers beside a threshold, what events (event_time.hpp) and shares of time (time_share.hpp) have in common. The threshold
/// c may follow from the design's parameters; g_k = y_k - c.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/quantities/interpolant.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

/// g_k.
std::vector<double> less_threshold(std::vector<double> y, const core::expression::Formula& threshold,
                                   const description::Simulated& simulated);

/// Adds scale * d(place of the crossing), from g(place) = 0, to the weights of the g_k. False: g has no rate there.
bool add_place_weights(const std::vector<double>& g, double place, double scale, std::vector<double>& weights);

/// Adds the seeds of sum_k weights[k] g_k: by the series, and by the threshold.
void add_beyond_seeds(const StepSeries& series, const core::expression::Formula& threshold, const description::Simulated& simulated,
                      const std::vector<double>& weights, description::Seeds& seeds);

/// What keeps the numbers from having an event: one that is not finite. Empty: nothing.
std::string fault_of_numbers(const std::vector<double>& g, const std::string& name, int first_instant);

/// Where numbers turn round so near to the threshold that a small change makes a crossing there, or takes two away: of the places inside
/// [first, last] where they turn, the one with the least |g|, if that is below a hundredth of the numbers' range.
struct SlightTurn {
    int index = 0;
};
std::optional<SlightTurn> slightest_turn(const std::vector<double>& g, int first, int last);

/// The first of two neighbouring numbers, within these places, that both lie on 0 (as crossings_of_zero has it).
std::optional<int> rest_on_zero(const std::vector<double>& g, double begin, double end);

/// "3 mm", "12 deg", "0.4 N".
std::string threshold_text(double si, Dimension dimension, int digits);

/// A series that is not plain, a threshold of another dimension, times outside of the motion.
struct TimesAsked {
    std::optional<double> from, to;
};
Errors check_threshold(const StepSeries& series, const core::expression::Formula& threshold, const TimesAsked& times,
                       const core::model::Model& model, int steps);

}  // namespace fettle::design::quantities
