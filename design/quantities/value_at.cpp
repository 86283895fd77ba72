// SPDX-License-Identifier: MIT
#include "design/quantities/value_at.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/quantities/interpolant.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

namespace {

constexpr double rounding_of_a_step = 1e-9;  // by which a time may be outside of the motion

bool is_in_some_scenario(const description::Quantity& quantity) {
    const description::QuantityFacts facts = quantity.facts();
    return facts.kind == description::QuantityFacts::Kind::in_scenario ||
           std::any_of(facts.parts.begin(), facts.parts.end(),
                       [](const description::NamedQuantity& part) { return is_in_some_scenario(*part.quantity); });
}

}  // namespace

// Counted in steps from the first number.
double ValueAt::place_of(double time, const Simulated& simulated) const {
    return time / simulated.trajectory.timestep - of_.series->first_instant();
}

Measurement ValueAt::value(const Simulated& simulated) const {
    Measurement out = description::computed(std::numeric_limits<double>::quiet_NaN());
    out.parts.push_back(of_.time->value(simulated));
    const Measurement& time = out.parts.front();
    out.fault = time.fault;
    if (std::isnan(time.value)) return out;
    const std::vector<double> y = of_.series->numbers(simulated);
    const double last = count_of(y) - 1, place = place_of(time.value, simulated);
    if (!(place >= -rounding_of_a_step && place <= last + rounding_of_a_step)) {
        const double first = of_.series->first_instant() * simulated.trajectory.timestep;
        out.fault = core::base::formatted("%.4g s is no time that this is known at: from %.4g s to %.4g s", time.value, first,
                                          first + last * simulated.trajectory.timestep);
        return out;
    }
    const double value = interpolated(y, std::clamp(place, 0.0, last)).value;
    out.value = out.lower = out.upper = value;
    return out;
}

void ValueAt::add_seeds(const Simulated& simulated, const Measurement& measured, double scale, Seeds& seeds) const {
    if (std::isnan(measured.value)) return;
    const std::vector<double> y = of_.series->numbers(simulated);
    const double place = std::clamp(place_of(measured.parts.front().value, simulated), 0.0, static_cast<double>(y.size()) - 1);
    const Interpolated here = interpolated(y, place);
    std::vector<double> weights(y.size(), 0.0);
    for (int k = 0; k < 4; ++k)
        if (here.weights[k] != 0) weights[here.first + k] = scale * here.weights[k];
    of_.series->add_number_seeds(simulated, weights, seeds);
    of_.time->add_seeds(simulated, measured.parts.front(), scale * here.slope / simulated.trajectory.timestep, seeds);
}

std::string ValueAt::doubt(const Simulated& simulated, const Measurement& measured) const {
    return of_.time->doubt(simulated, measured.parts.front());
}

std::vector<std::string> ValueAt::parameters() const {
    std::vector<std::string> names = of_.series->parameters();
    for (std::string& name : of_.time->parameters()) names.push_back(std::move(name));
    return names;
}

Errors ValueAt::check(const core::model::Model& model, int steps) const {
    Errors errors = of_.series->check(model, steps);
    for (const Error& error : of_.time->check(model, steps)) errors.push_back(error);
    const auto add = [&](ErrorCode code, const char* message) { errors.push_back({code, "", message}); };
    if (!of_.series->reduction().is_plain())
        add(ErrorCode::unsupported, "what is asked for at a time has a number at each instant; leave out what is taken over them");
    if (of_.time->dimension() != Dimension::time)
        add(ErrorCode::wrong_type, "the time of an event, or an expression of such times, is wanted");
    if (is_in_some_scenario(*of_.time))
        add(ErrorCode::unsupported, "the time is one of the same scenario: leave `scenario` out of it, and say it of what is asked for");
    return errors;
}

}  // namespace fettle::design::quantities
