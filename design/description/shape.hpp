// SPDX-License-Identifier: MIT
/// A part whose vertices are a function of named dimensions: what a parameter of kind `dimension` moves. Parts of files implement it
/// (shapes/file_part.hpp). Add one: derive from Shape, and hand it to the design (design.hpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/expression/operation.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::design::description {

struct ShapeDimension {
    std::string name;
    double value = 0;  ///< of the part as drawn [SI: m, for an angle rad]
};

/// A part at given dimensions.
struct ShapeInstance {
    core::geometry::Mesh mesh;       ///< [m], in the body's file frame
    std::vector<Matrix3X> jacobian;  ///< per dimension k: d vertices / d dimension k, 3 x n [1], exact; 3 x 0 where it was not wanted
};

/// Vertices as formulas of the dimensions (core/expression/tape.hpp).
struct RecordedShape {
    core::expression::Nodes nodes;             ///< Operation::input counts through dimensions()
    std::vector<std::array<int, 3>> vertices;  ///< of the mesh: nodes of x, y and z
};

/// A part within tolerances, and why it is none of those that the part as drawn stands for.
struct RemadeShape {
    core::geometry::Mesh mesh;  ///< with as many facets as the part as drawn
    std::vector<std::string>
        other_facets;  ///< where it has others if it is drawn by itself, a sentence each: "segments of `ball`: 21, not 20"
};

class Shape {
public:
    virtual ~Shape() = default;

    /// Never empty, names unique.
    virtual const std::vector<ShapeDimension>& dimensions() const = 0;

    /// The part at other dimensions, one value for each of dimensions(), in their order [m]. A pure function; the mesh's connectivity is
    /// the same for all values, unless has_fixed_triangles() says otherwise. Called from several threads at once.
    /// Errors: values that make no valid part; `where` names the dimension.
    virtual Result<ShapeInstance> at(const std::vector<double>& values) const = 0;

    /// at(), with the derivatives in some dimensions only, where each costs something: those in the others may be left out (3 x 0).
    /// @param wanted  One for each of dimensions(), in their order. Errors: those of at(), of dimensions that are wanted.
    virtual Result<ShapeInstance> differentiated(const std::vector<double>& values, const std::vector<bool>& wanted) const;

    /// The mesh alone, where its derivative costs something.
    virtual Result<core::geometry::Mesh> mesh(const std::vector<double>& values) const;

    /// Are the mesh's triangles the same for all values? Where not, each trial has its own.
    virtual bool has_fixed_triangles() const { return true; }

    /// Does it take seconds to make a mesh, as where a program makes it? Then fewer are made where fewer will do.
    virtual bool is_costly() const { return false; }

    /// Vertices as they follow from the dimensions near these values, with the triangles of the mesh there; what is decided while the part
    /// is made (numbers of facets, how solids cut each other) stays as it is there. Errors: those of at(); unsupported, where vertices are
    /// no formulas, as here.
    virtual Result<RecordedShape> recorded(const std::vector<double>& values) const;

    /// The part at these values, compared with the one that is drawn by itself there. Errors: those of at().
    virtual Result<RemadeShape> remade(const std::vector<double>& values) const;

    /// What is to be said of the part at these dimensions: how its derivatives were found, and how exact they are. A sentence each.
    /// @param wanted  As of differentiated().
    virtual std::vector<std::string> remarks(const std::vector<double>& values, const std::vector<bool>& wanted) const;

    /// Are the triangles that at() returns always a solid's: closed, outward oriented, without self-intersection? Where this is not said,
    /// the mesh of every trial is checked, and one that is no solid is a trial that cannot be built.
    virtual bool is_always_solid() const { return false; }
};

/// The values of the part as drawn.
std::vector<double> drawn_values(const Shape& shape);
/// For differentiated() and remarks(): all of them are wanted.
std::vector<bool> all_dimensions(const Shape& shape);
/// The part as drawn; its mesh alone.
Result<ShapeInstance> as_drawn(const Shape& shape);
Result<core::geometry::Mesh> drawn_mesh(const Shape& shape);

}  // namespace fettle::design::description
