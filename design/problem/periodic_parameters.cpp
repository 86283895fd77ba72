// SPDX-License-Identifier: MIT
#include "design/problem/periodic_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/scene/place.hpp"

namespace fettle::design::problem {

namespace {

constexpr double nearly = 1e-9;

bool spans_a_turn(const description::Parameter& parameter) {
    constexpr double turn = 2 * std::numbers::pi;
    return parameter.unit.dimension == core::base::Dimension::angle && std::abs(parameter.upper - parameter.lower - turn) <= nearly * turn;
}

VectorX with(VectorX p, Eigen::Index k, double value) {
    p[k] = value;
    return p;
}

// The start, and two places among the bounds of the others.
std::vector<VectorX> places_to_ask(const std::vector<description::Parameter>& parameters) {
    std::vector<VectorX> places{description::values_of(parameters)};
    for (const double share : {0.371, 0.618}) {
        VectorX place = places.front();
        for (Eigen::Index k = 0; k < place.size(); ++k)
            place[k] = parameters[k].lower + share * (parameters[k].upper - parameters[k].lower);
        places.push_back(place);
    }
    return places;
}

// Is a function the same at both ends, to within what is small beside the values that it takes between them?
template <class Function>
bool returns(const Function& value, double lower, double upper) {
    const double first = value(lower), last = value(upper), turn = upper - lower;
    double size = std::max(std::abs(first), std::abs(last));
    for (const double share : {0.15, 0.4, 0.75}) size = std::max(size, std::abs(value(lower + share * turn)));
    return std::abs(first - last) <= nearly * size;  // false of what is not a number
}

bool is_named(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool turns_a_body(const description::Design& design, const core::scene::BoundNumber& number) {
    return core::scene::kind_of(core::scene::find_place(design.scene, number.place).value()) == core::scene::PlaceKind::rotation;
}

bool followed_by_a_quantity(const description::Design& design, const std::string& name) {
    const auto follows = [&](const auto& wanted) { return is_named(wanted.quantity->parameters(), name); };
    return std::any_of(design.objective.begin(), design.objective.end(), follows) ||
           std::any_of(design.constraints.begin(), design.constraints.end(), follows);
}

// The numbers that follow from a parameter, but for bodies' angles: these are asked of as rotations.
bool numbers_return(const description::Design& design, const VectorX& p, Eigen::Index k) {
    const description::Parameter& parameter = design.parameters[k];
    return std::all_of(design.numbers.begin(), design.numbers.end(), [&](const core::scene::BoundNumber& number) {
        if (!is_named(number.formula.inputs, parameter.name) || turns_a_body(design, number)) return true;
        const auto at = description::function_of(number.formula, design.parameters);
        return returns([&](double value) { return at(with(p, k, value)).value; }, parameter.lower, parameter.upper);
    });
}

// The bodies' rotations alone; nothing is made.
std::vector<Matrix3> rotations(const description::Design& design, const VectorX& p) {
    core::scene::Scene scene = description::described_scene(design);
    for (const core::scene::BoundNumber& number : design.numbers) {
        if (!turns_a_body(design, number)) continue;
        core::scene::at(scene, core::scene::find_place(scene, number.place).value()) =
            description::function_of(number.formula, design.parameters)(p).value;
    }
    std::vector<Matrix3> out;
    for (core::scene::Body& body : scene.bodies) {
        core::scene::settle_rotation(body);
        out.push_back(body.pose.rotation);
    }
    return out;
}

bool rotations_return(const description::Design& design, const VectorX& p, Eigen::Index k) {
    const std::vector<Matrix3> first = rotations(design, with(p, k, design.parameters[k].lower)),
                               last = rotations(design, with(p, k, design.parameters[k].upper));
    return std::equal(first.begin(), first.end(), last.begin(),
                      [](const Matrix3& a, const Matrix3& b) { return (a - b).norm() <= nearly; });
}

bool relations_return(const description::Design& design, const VectorX& p, Eigen::Index k) {
    return std::all_of(design.relations.begin(), design.relations.end(), [&](const description::Relation& relation) {
        const auto value = [&](double at) { return relation.at(with(p, k, at)).value; };
        return returns(value, design.parameters[k].lower, design.parameters[k].upper);
    });
}

bool is_periodic(const description::Design& design, Eigen::Index k) {
    const description::Parameter& parameter = design.parameters[k];
    if (!spans_a_turn(parameter) || followed_by_a_quantity(design, parameter.name)) return false;
    for (const VectorX& p : places_to_ask(design.parameters)) {
        if (!relations_return(design, p, k)) return false;
        for (int s = 0; s < description::scenario_count(design); ++s) {
            const description::Design scenario = description::design_of_scenario(design, s);
            if (!numbers_return(scenario, p, k) || !rotations_return(scenario, p, k)) return false;
        }
    }
    return true;
}

}  // namespace

std::vector<bool> periodic_parameters(const description::Design& design) {
    std::vector<bool> periodic;
    for (Eigen::Index k = 0; k < count_of(design.parameters); ++k) periodic.push_back(is_periodic(design, k));
    return periodic;
}

}  // namespace fettle::design::problem
