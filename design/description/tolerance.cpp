// SPDX-License-Identifier: MIT
#include "design/description/tolerance.hpp"

#include <algorithm>
#include <cmath>

#include "core/expression/formula.hpp"
#include "core/scene/place.hpp"

namespace fettle::design::description {

namespace {

using core::expression::Formula;
using core::scene::BoundNumber;

void add_to(const core::scene::Scene& scene, std::vector<BoundNumber>& numbers, const core::scene::Place& place, const std::string& input) {
    const std::string pointer = core::scene::pointer_to(scene, place);
    const auto dimension = core::expression::powers_of(core::scene::dimension_at(scene, place));
    const Formula deviation = core::expression::input_formula(input, dimension);
    const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const BoundNumber& number) {
        const auto other = core::scene::find_place(scene, number.place);
        return other && *other == place;
    });
    if (found != numbers.end()) {
        found->formula = core::expression::sum_of(found->formula, deviation);
        return;
    }
    const Formula nominal = core::expression::constant_formula(core::scene::value_at(scene, place), dimension);
    numbers.push_back({pointer, core::expression::sum_of(nominal, deviation)});
}

}  // namespace

Result<int> add_deviation(Design& design, const std::string& place, const Unit& unit) {
    const core::scene::Scene scene = described_scene(design);
    const Result<core::scene::Place> found = core::scene::find_place(scene, place);
    if (!found) return found.errors();
    std::vector<core::scene::Scene> scenes;
    for (int s = 0; s < scenario_count(design); ++s) {
        scenes.push_back(design.scenarios.empty() ? scene : described_scene(design_of_scenario(design, s)));
        if (std::isnan(core::scene::value_at(scenes.back(), *found)))
            return Error{ErrorCode::unsupported, place,
                         scenario_prefix(design, s) +
                             "the scene leaves this number to its default: write it there, so that it has a size to deviate from"};
    }
    Parameter parameter;
    parameter.name = "deviation of " + place;
    parameter.unit = unit;
    design.parameters.push_back(parameter);
    for (int s = 0; s < count_of(scenes); ++s)
        add_to(scenes[s], design.scenarios.empty() ? design.numbers : design.scenarios[s].numbers, *found, parameter.name);
    return count_of(design.parameters) - 1;
}

VectorX with_deviations(const Design& as_made, const std::vector<Tolerance>& tolerances, const VectorX& deviations) {
    VectorX p = values_of(as_made.parameters);
    for (int k = 0; k < count_of(tolerances); ++k) p[tolerances[k].parameter] += deviations[k];
    return p;
}

}  // namespace fettle::design::description
