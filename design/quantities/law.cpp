// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/law.hpp"

#include <algorithm>

#include "fettle/design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using core::scene::Curve;
using core::scene::CurveKind;
using description::Seeds;
using description::Simulated;

std::vector<double> Law::series(const Simulated& simulated) const {
    Curve curve = of_.curve;
    for (const MovedValue& each : of_.moved) curve.values[each.index] = value_at(each.formula, simulated);
    std::vector<double> out;
    for (int t = 1; t <= count_of(simulated.trajectory.steps); ++t) out.push_back(curve_value(curve, time_at(simulated.trajectory, t)));
    return out;
}

void Law::add_series_seeds(const Simulated& simulated, const std::vector<double>& weights, Seeds& seeds) const {
    if (of_.moved.empty()) return;
    std::vector<double> bar(of_.curve.values.size(), 0.0);
    for (int t = 0; t < count_of(weights); ++t) {
        if (weights[t] == 0) continue;
        const std::vector<double> at = curve_weights(of_.curve, time_at(simulated.trajectory, t + 1));
        for (std::size_t k = 0; k < bar.size(); ++k) bar[k] += weights[t] * at[k];
    }
    for (const MovedValue& each : of_.moved) add_formula_seed(each.formula, simulated, bar[each.index], seeds);
}

std::vector<std::string> Law::parameters() const {
    std::vector<std::string> names;
    for (const MovedValue& each : of_.moved) names.insert(names.end(), each.formula.inputs.begin(), each.formula.inputs.end());
    return names;
}

Errors Law::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    const auto add = [&](ErrorCode code, const char* message) { errors.push_back({code, "", message}); };
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
