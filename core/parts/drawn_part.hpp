// SPDX-License-Identifier: MIT
/// A part as drawn: mesh, exact Jacobian, true surfaces. Plain values, which do not need the drawing any more.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"
#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// Vertices as what was recorded of them (expression/tape.hpp).
struct RecordedVertices {
    expression::Nodes nodes;                   ///< Operation::input counts through the dimensions
    std::vector<std::array<int, 3>> vertices;  ///< of the mesh: nodes of x, y and z
};

struct DrawnPart {
    geometry::Mesh mesh;             ///< [m]
    std::vector<Matrix3X> jacobian;  ///< per dimension k: d vertices / d dimension k, 3 x n, exact
    std::vector<DrawnSurface> surfaces;
    std::vector<Facet> facets;  ///< per triangle of the mesh
    Deviation deviation;
    Structure structure;                    ///< for the next drawing of this part
    std::vector<std::string> changes;       ///< against the structure that the drawing was given (drawing.hpp)
    std::vector<std::string> other_counts;  ///< kept of it, where a part drawn by itself would have others (the same); if asked for
    RecordedVertices recorded{};            ///< if it was asked for
};

struct DrawnOptions {
    bool jacobian = true;
    bool record = false;          ///< DrawnPart::recorded
    bool compare_counts = false;  ///< DrawnPart::other_counts
    bool check = true;            ///< that the mesh is a solid: closed, oriented, without self-intersection (solids/mesh_validity.hpp)
};

/// Errors: a mesh that is no solid; faults name the features whose facets meet ("`slot 2` and `rim` cross").
Result<DrawnPart> drawn(const Drawing& drawing, const Solid& solid, const std::string& name, const DrawnOptions& options = {});

}  // namespace fettle::core::parts
