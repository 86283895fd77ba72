// SPDX-License-Identifier: MIT
#include "design/description/design.hpp"

#include <algorithm>

#include "core/base/contract.hpp"
#include "core/scene/place.hpp"

namespace fettle::design::description {

void describe(const Shape& shape, core::scene::Body& body) {
    if (!body.shape) body.shape.emplace();
    for (const ShapeDimension& dimension : shape.dimensions()) body.shape->dimensions[dimension.name] = dimension.value;
}

int scenario_count(const Design& design) { return std::max(1, count_of(design.scenarios)); }

Design design_of_scenario(const Design& design, int scenario) {
    Design out = design;
    if (design.scenarios.empty()) return out;
    const Scenario& own = design.scenarios[scenario];
    out.scenarios.clear();
    out.scene = own.scene;
    out.shapes = own.shapes;
    out.numbers = own.numbers;
    out.steps = own.steps;
    return out;
}

std::string scenario_prefix(const Design& design, int scenario) {
    return design.scenarios.empty() ? std::string() : design.scenarios[scenario].name + ": ";
}

core::scene::Scene described_scene(const Design& design) {
    core::scene::Scene scene = design.scene;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const Shape* shape = shape_of(design, static_cast<int>(i));
        shape != nullptr ? describe(*shape, scene.bodies[i]) : scene.bodies[i].shape.reset();
    }
    return scene;
}

std::vector<bool> moved_dimensions(const core::scene::Scene& scene, const std::vector<core::scene::BoundNumber>& numbers, int body,
                                   const Shape& shape) {
    std::vector<std::string> pointers;
    for (const core::scene::BoundNumber& number : numbers)
        if (const auto place = core::scene::find_place(scene, number.place)) pointers.push_back(core::scene::pointer_to(scene, *place));
    std::vector<bool> moved;
    for (const ShapeDimension& dimension : shape.dimensions()) {
        const std::string pointer = "/bodies/" + std::to_string(body) + "/shape/dimensions/" + core::scene::escaped(dimension.name);
        moved.push_back(std::find(pointers.begin(), pointers.end(), pointer) != pointers.end());
    }
    return moved;
}

Errors set_number(Design& design, const std::string& place, const std::string& formula) {
    const core::scene::Scene scene = described_scene(design);
    const Result<core::scene::Place> found = core::scene::find_place(scene, place);
    if (!found) return found.errors();
    const Dimension dimension = core::scene::dimension_at(scene, *found);
    Result<core::expression::Formula> parsed =
        core::expression::parse_formula_of(formula, scope_of(design.parameters), dimension, 1, place);
    if (!parsed) return parsed.errors();
    const std::string pointer = core::scene::pointer_to(scene, *found);
    std::erase_if(design.numbers, [&](const core::scene::BoundNumber& number) { return number.place == pointer; });
    design.numbers.push_back({pointer, std::move(parsed).value()});
    return {};
}

Result<int> add_part(Design& design, core::scene::Body body, std::shared_ptr<const Shape> shape) {
    FETTLE_ASSERT(shape != nullptr, "a part has a shape; a body with a fixed mesh goes into the scene as it is");
    Result<core::geometry::Mesh> drawn = drawn_mesh(*shape);
    if (!drawn) return drawn.errors();
    body.mesh = std::move(drawn).value();
    design.scene.bodies.push_back(std::move(body));
    design.shapes.resize(design.scene.bodies.size());
    design.shapes.back() = std::move(shape);
    return count_of(design.scene.bodies) - 1;
}

}  // namespace fettle::design::description
