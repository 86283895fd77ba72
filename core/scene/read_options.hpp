// SPDX-License-Identifier: MIT
/// What the readers of scenes take besides the file.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/units.hpp"
#include "core/expression/formula.hpp"
#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::scene {

/// Makes the mesh of a `shape` body [m]. Errors: their `where` is replaced by the body's place in the file.
using ShapeMaker = std::function<base::Result<geometry::Mesh>(const ShapeSpec&)>;

/// Which dimensions the part of a shape has, by name, and what quantity each is. Errors: as for ShapeMaker.
using PartDimensions = std::function<base::Result<std::map<std::string, base::Dimension>>(const ShapeSpec&)>;

/// A name that formulas of the file may use as if it were one of its variables: a design's parameter. Takes the place of the variable of
/// its name.
struct FormulaInput {
    std::string name;
    expression::DimensionPowers dimension;
    double value = 0;                                 ///< SI
    std::optional<expression::Formula> meaning = {};  ///< over other inputs; none: an input itself, with this value
    std::string added_to = {};                        ///< a variable of the file, to whose value it is added; empty: it is not
};

/// A value that replaces something in the file (files/json_document.hpp, replace).
struct Replacement {
    std::string pointer;
    files::JsonNode value;
};

struct ReadOptions {
    std::vector<std::string> mesh_dirs;      ///< also looked in for meshes; see find_mesh_file in mesh_files/find_mesh_file.hpp
    ShapeMaker shape_maker;                  ///< empty: a body with `shape` is an error that says so
    PartDimensions part_dimensions = {};     ///< of parts that are files; goes with shape_maker
    std::function<bool()> should_stop = {};  ///< optional, asked on any thread while a mesh is read that may take long: true ends it
    std::vector<FormulaInput> inputs = {};
    std::vector<Replacement> replacements = {};  ///< their document outlives the reading
    bool strict_meshes = false;  ///< meshes of our own format: MeshPolicy::strict, and nothing is repaired (geometry/mesh_repair.hpp)
};

}  // namespace fettle::core::scene
