// SPDX-License-Identifier: MIT
/// What a generator consists of, for those who write one: its table row, the relations between dimensions that make it a valid
/// solid, and its construction. Registered in shape_generator.cpp; users need only shape_generator.hpp.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fettle/design/shapes/dual.hpp"
#include "fettle/design/shapes/generator_info.hpp"
#include "fettle/design/shapes/mesh_builder.hpp"

namespace fettle::design::shapes {

using DimensionDual = Dual<>;
using ShapeBuilder = MeshBuilder<DimensionDual>;

/// Every dimension of a generator by name, as an input of the differentiation. `at` throws on a name that the table lacks.
using Dimensions = std::map<std::string, DimensionDual>;

/// "dimension must be below limit", all in metres.
struct Relation {
    std::string dimension;  ///< the one to name in the message
    double value = 0;
    double limit = 0;
    std::string reason;  ///< "or the pin leaves the disc"
};

struct ShapeDefinition {
    GeneratorInfo info;
    /// What must hold for a valid solid, lengths being positive already.
    std::vector<Relation> (*relations)(const Dimensions& dimensions, int segments) = nullptr;
    void (*build)(const Dimensions& dimensions, ShapeBuilder& builder) = nullptr;
};

}  // namespace fettle::design::shapes
