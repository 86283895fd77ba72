// SPDX-License-Identifier: MIT
#include "design/report/quantity_curves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/units.hpp"
#include "design/report/packed_numbers.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;
using description::NamedQuantity;
using description::Quantity;
using description::QuantityFacts;

constexpr std::size_t most_curves = 12, most_points = 2000;

/// How the curves of a dimension are shown.
struct Shown {
    Dimension dimension;
    const char *title, *quantity, *unit;  // "": a plain number
};
constexpr Shown all_shown[] = {
    {Dimension::length, "Lengths", "length", "mm"},
    {Dimension::angle, "Angles", "angle", "deg"},
    {Dimension::speed, "Speeds", "speed", "mm/s"},
    {Dimension::angular_speed, "Angular speeds", "angular speed", "deg/s"},
    {Dimension::acceleration, "Accelerations", "acceleration", "m/s^2"},
    {Dimension::angular_acceleration, "Angular accelerations", "angular acceleration", "deg/s^2"},
    {Dimension::force, "Forces", "force", "N"},
    {Dimension::torque, "Torques", "torque", "N mm"},
    {Dimension::energy, "Energies", "energy", "mJ"},
    {Dimension::power, "Powers", "power", "W"},
    {Dimension::number, "Numbers", "number", ""},
};

// Without the scenario that a requirement's name ends with.
std::string without_scenario(std::string name, const description::Design& design) {
    for (const description::Scenario& scenario : design.scenarios) {
        const std::string suffix = " [" + scenario.name + "]";
        if (name.ends_with(suffix)) return name.substr(0, name.size() - suffix.size());
    }
    return name;
}

std::vector<double> thinned(const std::vector<double>& all) {
    const std::size_t every = std::max<std::size_t>(1, (all.size() + most_points - 1) / most_points);
    std::vector<double> kept;
    for (std::size_t i = 0; i < all.size(); i += every) kept.push_back(all[i]);
    return kept;
}

}  // namespace

std::vector<NamedQuantity> quantities_with_curves(const std::vector<NamedQuantity>& named, const description::Design& design) {
    std::vector<NamedQuantity> all;
    std::set<const Quantity*> known;
    std::set<std::string> names;
    const std::function<void(const std::string&, const std::shared_ptr<const Quantity>&)> add =
        [&](const std::string& name, const std::shared_ptr<const Quantity>& quantity) {
            if (!quantity || !known.insert(quantity.get()).second) return;
            const QuantityFacts facts = quantity->facts();
            if (facts.curve && names.insert(without_scenario(name, design)).second)
                all.push_back({without_scenario(name, design), quantity});
            for (const NamedQuantity& part : facts.parts) add(part.name.empty() ? name : part.name, part.quantity);
        };
    for (const NamedQuantity& each : named) add(each.name, each.quantity);
    for (const description::ObjectiveTerm& term : design.objective) add(term.name, term.quantity);
    for (const description::Constraint& constraint : design.constraints) add(constraint.name, constraint.quantity);
    return all;
}

Json quantity_curves(const std::vector<NamedQuantity>& quantities, const description::Simulated& simulated) {
    Json charts = Json::array();
    const auto steps = count_of(simulated.trajectory.steps);
    std::vector<double> times;
    for (int t = 1; t <= steps; ++t) times.push_back(core::stepper::time_at(simulated.trajectory, t));
    for (const Shown& shown : all_shown) {
        Json lines = Json::array();
        std::size_t count = 0;
        const double unit = *shown.unit == '\0' ? 1 : core::base::to_si(1, *core::base::find_unit(shown.unit));
        for (const NamedQuantity& each : quantities) {
            if (each.quantity->facts().curve != shown.dimension || !each.quantity->check(simulated.model, steps).empty()) continue;
            std::vector<double> numbers = each.quantity->curve(simulated);
            if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) continue;
            if (++count > most_curves) continue;
            for (double& number : numbers) number /= unit;
            lines.push_back({{"name", each.name}, {"values", packed(thinned(numbers))}});
        }
        if (lines.empty()) continue;
        const Json note = count > most_curves ? Json("the first " + std::to_string(most_curves) + " of " + std::to_string(count)) : Json();
        charts.push_back({{"title", shown.title},
                          {"quantity", shown.quantity},
                          {"unit", shown.unit},
                          {"note", note},
                          {"time", packed(thinned(times))},
                          {"lines", lines}});
    }
    return charts;
}

}  // namespace fettle::design::report
