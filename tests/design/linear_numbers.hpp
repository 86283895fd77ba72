// SPDX-License-Identifier: MIT
/// Numbers of a scene that follow from a parameter linearly, whatever dimensions the two have.
#pragma once

#include "core/scene/place.hpp"
#include "design/description/design.hpp"

namespace fettle::tests::design_support {

/// number = scale p + offset, at a place that is there or not.
inline core::scene::BoundNumber linear_number(const design::description::Design& design, const std::string& parameter,
                                              const std::string& place, double scale = 1, double offset = 0) {
    using namespace core::expression;
    const core::scene::Scene scene = design::description::described_scene(design);
    const auto found = core::scene::find_place(scene, place);
    const DimensionPowers dimension = found ? powers_of(core::scene::dimension_at(scene, *found)) : DimensionPowers{};
    const Nodes nodes{{Operation::input, {0, 0, 0}, 0},
                      {Operation::constant, {0, 0, 0}, scale},
                      {Operation::multiply, {1, 0, 0}, 0},
                      {Operation::constant, {0, 0, 0}, offset},
                      {Operation::add, {2, 3, 0}, 0}};
    return {place, formula_of(nodes, {parameter}, dimension)};
}

inline void follow(design::description::Design& design, const std::string& parameter, const std::string& place, double scale = 1,
                   double offset = 0) {
    design.numbers.push_back(linear_number(design, parameter, place, scale, offset));
}

/// The components of a vector whose direction is not 0: direction scale p + offset.
inline void follow_vector(design::description::Design& design, const std::string& parameter, const std::string& place,
                          const Vector3& direction, double scale = 1, const Vector3& offset = Vector3::Zero()) {
    for (Eigen::Index k = 0; k < 3; ++k)
        if (direction[k] != 0) follow(design, parameter, place + "/" + std::to_string(k), scale * direction[k], offset[k]);
}

}  // namespace fettle::tests::design_support
