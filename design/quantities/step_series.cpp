// SPDX-License-Identifier: MIT
#include "design/quantities/step_series.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

std::vector<double> StepSeries::numbers(const Simulated& simulated) const { return series_derivative(simulated, reduction_.derivative); }

void StepSeries::add_number_seeds(const Simulated& simulated, const std::vector<double>& weights, Seeds& seeds) const {
    add_series_derivative_seeds(simulated, reduction_.derivative, weights, seeds);
}

const StepSeries* series_of(const description::Quantity& quantity) { return dynamic_cast<const StepSeries*>(&quantity); }

std::shared_ptr<const StepSeries> series_of(const std::shared_ptr<const description::Quantity>& quantity) {
    return std::dynamic_pointer_cast<const StepSeries>(quantity);
}

std::string instant_words(int instant) { return instant == 0 ? "the start" : "step " + std::to_string(instant); }

StepSeries::Window StepSeries::window(const Simulated& simulated) const {
    const std::vector<double> all = numbers(simulated);
    const auto [first, past] = window_of(reduction_, instants(simulated.trajectory.timestep), count_of(all));
    return {{all.begin() + first, all.begin() + past}, first + first_instant()};
}

std::vector<double> StepSeries::series_derivative(const Simulated& simulated, int order) const {
    return time_derivative(series(simulated), simulated.trajectory.timestep, order);
}

void StepSeries::add_series_derivative_seeds(const Simulated& simulated, int order, const std::vector<double>& weights,
                                             Seeds& seeds) const {
    add_series_seeds(simulated, time_derivative_adjoint(weights, simulated.trajectory.timestep, order), seeds);
}

Dimension StepSeries::numbers_dimension() const {
    return dimension_of({Over::end, reduction_.derivative}, instant_dimension()).value_or(Dimension::number);
}

Dimension StepSeries::dimension() const { return dimension_of(reduction_, instant_dimension()).value_or(Dimension::number); }

description::QuantityFacts StepSeries::facts() const { return {.is_number = true, .curve = numbers_dimension()}; }

std::vector<double> StepSeries::curve(const Simulated& simulated) const {
    std::vector<double> out = numbers(simulated);
    out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(simulated.trajectory.steps.size()));
    return out;
}

Measurement StepSeries::value(const Simulated& simulated) const {
    return description::computed(number_of(reduction_, numbers(simulated), instants(simulated.trajectory.timestep)));
}

void StepSeries::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    std::vector<double> weights = weights_of(reduction_, numbers(simulated), instants(simulated.trajectory.timestep));
    for (double& weight : weights) weight *= scale;
    add_number_seeds(simulated, weights, seeds);
}

std::vector<description::Branch> StepSeries::branches(const Simulated& simulated, const Measurement& measured, double limit) const {
    constexpr double near = 0.25;  // of the range
    if (reduction_.at || !is_extreme(over()) || std::isnan(measured.value)) return {};
    const std::vector<double> all = numbers(simulated);
    const auto [first, past] = window_of(reduction_, instants(simulated.trajectory.timestep), count_of(all));
    const std::vector<double> inside(all.begin() + first, all.begin() + past);
    const auto [least, largest] = std::minmax_element(inside.begin(), inside.end());
    const double reach = std::min(limit - measured.value, near * (*largest - *least));
    std::vector<description::Branch> out;
    for (const SignedExtreme& extreme : extremes_of(over(), inside)) {
        const double value = value_of(over(), extreme);
        if (std::abs(value - measured.value) > reach || count_of(out) == most_branches) break;
        std::vector<double> weights = weights_of(over(), extreme, inside.size());
        weights.insert(weights.begin(), static_cast<std::size_t>(first), 0.0);
        weights.resize(all.size(), 0.0);
        out.push_back({value, [this, &simulated, weights = std::move(weights)](double scale, Seeds& seeds) {
                           std::vector<double> scaled = weights;
                           for (double& weight : scaled) weight *= scale;
                           add_number_seeds(simulated, scaled, seeds);
                       }});
    }
    if (out.size() == 1) out.clear();  // it is smooth
    return out;
}

Errors StepSeries::check(const core::model::Model& model, int steps) const {
    Errors errors = quantities::check(reduction_, instant_dimension(), instants(model.timestep), steps);
    if (reduction_.derivative > 0 && is_magnitude())
        errors.push_back({ErrorCode::inconsistent, "", "the derivative in time of a magnitude says little; name an `axis`"});
    return errors;
}

}  // namespace fettle::design::quantities
