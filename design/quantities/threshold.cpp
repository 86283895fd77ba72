// SPDX-License-Identifier: MIT
#include "design/quantities/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.hpp"
#include "design/description/requirement_text.hpp"
#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<double> less_threshold(std::vector<double> y, const core::expression::Formula& threshold, const Simulated& simulated) {
    const double c = value_at(threshold, simulated);
    for (double& number : y) number -= c;
    return y;
}

bool add_place_weights(const std::vector<double>& g, double place, double scale, std::vector<double>& weights) {
    const Interpolated here = interpolated(g, place);
    const auto [least, largest] = std::minmax_element(g.begin(), g.end());
    if (!(std::abs(here.slope) > 1e-12 * (*largest - *least))) return false;
    for (int k = 0; k < 4; ++k)
        if (here.weights[k] != 0) weights[here.first + k] -= scale * here.weights[k] / here.slope;
    return true;
}

void add_beyond_seeds(const StepSeries& series, const core::expression::Formula& threshold, const Simulated& simulated,
                      const std::vector<double>& weights, Seeds& seeds) {
    series.add_number_seeds(simulated, weights, seeds);
    double sum = 0;
    for (const double weight : weights) sum += weight;
    if (!threshold.is_constant()) add_formula_seed(threshold, simulated, -sum, seeds);
}

std::string fault_of_numbers(const std::vector<double>& g, const std::string& name, int first_instant) {
    const auto odd = std::find_if(g.begin(), g.end(), [](double number) { return !std::isfinite(number); });
    if (odd == g.end()) return {};
    return name + " is not a finite number at " + instant_words(static_cast<int>(odd - g.begin()) + first_instant);
}

std::optional<SlightTurn> slightest_turn(const std::vector<double>& g, int first, int last) {
    constexpr double slight = 0.01;
    const auto [least, largest] = std::minmax_element(g.begin(), g.end());
    const double allowed = slight * (*largest - *least);
    std::optional<SlightTurn> out;
    for (int k = std::max(first, 1); k <= std::min(last, count_of(g) - 2); ++k) {
        const bool turns = (g[k] > g[k - 1]) != (g[k + 1] > g[k]) && g[k] != g[k - 1];
        if (turns && std::abs(g[k]) < allowed && (!out || std::abs(g[k]) < std::abs(g[out->index]))) out = SlightTurn{k};
    }
    return out;
}

std::optional<int> rest_on_zero(const std::vector<double>& g, double begin, double end) {
    const double on_zero = room_on_zero(g);
    for (int k = static_cast<int>(std::ceil(begin)); k + 1 <= static_cast<int>(end); ++k)
        if (std::abs(g[k]) <= on_zero && std::abs(g[k + 1]) <= on_zero) return k;
    return std::nullopt;
}

std::string threshold_text(double si, Dimension dimension, int digits) {
    double unit = 1;
    if (dimension == Dimension::length || dimension == Dimension::speed) unit = 1e-3;
    if (dimension == Dimension::angle || dimension == Dimension::angular_speed) unit = std::numbers::pi / 180;
    return description::amount_text(si, unit, core::base::unit_name(dimension, unit), digits);
}

Errors check_threshold(const StepSeries& series, const core::expression::Formula& threshold, const TimesAsked& times,
                       const core::model::Model& model, int steps) {
    Errors errors = series.check(model, steps);
    const auto add = [&](ErrorCode code, const std::string& message) { errors.push_back({code, "", message}); };
    if (!series.reduction().is_plain())
        add(ErrorCode::unsupported, "an event is of numbers over the steps; leave out what is taken over them");
    if (!same(threshold.dimension, core::expression::powers_of(series.numbers_dimension())))
        add(ErrorCode::wrong_type, "a threshold has the dimension of what crosses it");
    if (threshold.is_constant() && !std::isfinite(core::expression::value_of<double>(threshold, {})))
        add(ErrorCode::not_finite, "a threshold is a finite number");
    const double end = steps * model.timestep, room = 1e-6 * model.timestep;
    for (const std::optional<double>& time : {times.from, times.to})
        if (time && !(*time >= 0 && *time <= end + room))
            add(ErrorCode::out_of_range, core::base::formatted("%.9g s is not within the motion, which ends at %.9g s", *time, end));
    if (times.from && times.to && !(*times.from < *times.to)) add(ErrorCode::inconsistent, "a window begins before it ends");
    return errors;
}

}  // namespace fettle::design::quantities
