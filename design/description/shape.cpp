// SPDX-License-Identifier: MIT
#include "design/description/shape.hpp"

namespace fettle::design::description {

Result<ShapeInstance> Shape::differentiated(const std::vector<double>& values, const std::vector<bool>& /*wanted*/) const {
    return at(values);
}

Result<core::geometry::Mesh> Shape::mesh(const std::vector<double>& values) const {
    Result<ShapeInstance> part = at(values);
    if (!part) return part.errors();
    return std::move(part->mesh);
}

Result<RecordedShape> Shape::recorded(const std::vector<double>& /*values*/) const {
    return Error{ErrorCode::unsupported, "shape", "a program makes the part: its vertices are no formulas of its dimensions"};
}

Result<RemadeShape> Shape::remade(const std::vector<double>& values) const {
    Result<core::geometry::Mesh> made = mesh(values);
    if (!made) return made.errors();
    return RemadeShape{*std::move(made), {}};
}

std::vector<std::string> Shape::remarks(const std::vector<double>& /*values*/, const std::vector<bool>& /*wanted*/) const { return {}; }

std::vector<double> drawn_values(const Shape& shape) {
    std::vector<double> values;
    for (const ShapeDimension& dimension : shape.dimensions()) values.push_back(dimension.value);
    return values;
}

std::vector<bool> all_dimensions(const Shape& shape) { return std::vector<bool>(shape.dimensions().size(), true); }

Result<ShapeInstance> as_drawn(const Shape& shape) { return shape.at(drawn_values(shape)); }

Result<core::geometry::Mesh> drawn_mesh(const Shape& shape) { return shape.mesh(drawn_values(shape)); }

}  // namespace fettle::design::description
