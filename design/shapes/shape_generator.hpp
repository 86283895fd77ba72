// SPDX-License-Identifier: MIT
/// Shapes from dimensions: solids with fixed connectivity and the exact derivative of every vertex with respect to every
/// dimension (docs/method/shapes.md). Each is one closed, outward oriented mesh without self-intersection for every set of
/// dimensions that `generate` accepts; dimensions that would break that are refused with what is allowed.
/// How circles become polygons: unit_circle.hpp. The parts: engine_parts.hpp says how they go together.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"
#include "fettle/core/geometry/mesh.hpp"
#include "fettle/design/shapes/generator_info.hpp"

namespace fettle::design::shapes {

struct ShapeOptions {
    int segments = 24;  ///< of a full circle: a multiple of 4, from 8 to 720. Decides the connectivity, so it is no dimension.
};

struct GeneratedShape {
    core::geometry::Mesh mesh;            ///< [m], in the generator's frame; named after the generator
    std::vector<std::string> dimensions;  ///< in the order of generator_table()
    std::vector<Matrix3X> jacobian;       ///< per dimension k: d vertices / d dimension k, 3 x n [1]
};

/// All generators with their dimensions.
std::vector<GeneratorInfo> generator_table();

/// What must hold between the dimensions of a generator for a valid solid, at its defaults; empty for a name that is none.
std::vector<DimensionLimit> dimension_limits(const std::string& generator, const ShapeOptions& options = {});

/// @param generator   Name of a row of generator_table().
/// @param dimensions  By name [m]; those left out take their defaults.
/// @return  The shape, or every fault: unknown_key (generator or dimension, with the nearest known one), not_finite, out_of_range (what
///          was found, what is allowed and why). `where` is "generator" or "generator/dimension".
Result<GeneratedShape> generate(const std::string& generator, const std::map<std::string, double>& dimensions,
                                const ShapeOptions& options = {});

}  // namespace fettle::design::shapes
