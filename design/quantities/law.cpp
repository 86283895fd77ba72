// SPDX-License-Identifier: MIT
#include "design/quantities/law.hpp"

#include <algorithm>

#include "design/quantities/curve_slope.hpp"
#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using core::scene::Curve;
using core::scene::CurveKind;
using description::Seeds;
using description::Simulated;

Curve Law::curve_of(const Simulated& simulated) const {
    Curve curve = of_.curve;
    for (const MovedValue& each : of_.moved) curve.values[each.index] = value_at(each.formula, simulated);
    return curve;
}

// What the table is over at each instant.
std::vector<double> Law::places(const Simulated& simulated) const {
    if (of_.along) return of_.along->numbers(simulated);
    std::vector<double> times;
    for (int t = 0; t <= count_of(simulated.trajectory.steps); ++t) times.push_back(time_at(simulated.trajectory, t));
    return times;
}

std::vector<double> Law::series(const Simulated& simulated) const {
    const Curve curve = curve_of(simulated);
    std::vector<double> out;
    for (const double place : places(simulated)) out.push_back(curve_value(curve, place));
    return out;
}

void Law::add_series_seeds(const Simulated& simulated, const std::vector<double>& weights, Seeds& seeds) const {
    if (of_.moved.empty() && !of_.along) return;
    const std::vector<double> at = places(simulated);
    if (!of_.moved.empty()) {
        std::vector<double> bar(of_.curve.values.size(), 0.0);
        for (std::size_t t = 0; t < weights.size(); ++t) {
            if (weights[t] == 0) continue;
            const std::vector<double> of_values = curve_weights(of_.curve, at[t]);
            for (std::size_t k = 0; k < bar.size(); ++k) bar[k] += weights[t] * of_values[k];
        }
        for (const MovedValue& each : of_.moved) add_formula_seed(each.formula, simulated, bar[each.index], seeds);
    }
    if (!of_.along) return;
    const Curve curve = curve_of(simulated);
    std::vector<double> along(weights.size(), 0.0);
    for (std::size_t t = 0; t < weights.size(); ++t)
        if (weights[t] != 0) along[t] = weights[t] * curve_slope(curve, at[t]);
    of_.along->add_number_seeds(simulated, along, seeds);
}

std::vector<std::string> Law::parameters() const {
    std::vector<std::string> names;
    for (const MovedValue& each : of_.moved) names.insert(names.end(), each.formula.inputs.begin(), each.formula.inputs.end());
    if (!of_.along) return names;
    for (std::string& name : of_.along->parameters()) names.push_back(std::move(name));
    return names;
}

Errors Law::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    const auto add = [&](ErrorCode code, const char* message) { errors.push_back({code, "", message}); };
    if (of_.along) {
        for (const Error& error : of_.along->check(model, steps)) errors.push_back(error);
        if (!of_.along->reduction().is_plain())
            add(ErrorCode::unsupported, "what a law is along has a number at each instant; leave out what is taken over them");
        if (of_.curve.rate != 0 || of_.curve.stop_time) add(ErrorCode::unsupported, "a law along a quantity has a table alone");
    }
    const std::vector<double>&times = of_.curve.times, &values = of_.curve.values;
    const bool spline = of_.curve.kind == CurveKind::control_points;
    if (spline && (times.size() != 2 || values.size() < 4))
        add(ErrorCode::inconsistent, "a law of control points has two times, the first and the last, and at least 4 values");
    if (!spline && (times.empty() || times.size() != values.size()))
        add(ErrorCode::inconsistent, "a law has a value for each time, and at least one");
    if (std::adjacent_find(times.begin(), times.end(), [](double a, double b) { return !(a < b); }) != times.end())
        add(ErrorCode::out_of_range, "the times of a law increase");
    for (const MovedValue& each : of_.moved) {
        if (each.index < 0 || each.index >= count_of(values))
            add(ErrorCode::out_of_range, "a value that follows from parameters is one of the law's");
        if (!same(each.formula.dimension, core::expression::powers_of(of_.dimension)))
            add(ErrorCode::wrong_type, "the values of a law have its dimension");
    }
    return errors;
}

}  // namespace fettle::design::quantities
