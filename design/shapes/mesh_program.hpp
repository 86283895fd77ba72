// SPDX-License-Identifier: MIT
/// Parts from the designer's own program: any that writes a mesh file when it is given dimensions, as OpenSCAD does.
///     { "openscad", "-o", "{out}", "-D", "radius={radius}", "rod.scad" }
/// {out} stands for the file to write, {radius} for the dimension of that name, a number in the file's unit. No shell is asked. Programs
/// run only where the user has allowed it; who calls this has seen to that.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/scene/scene.hpp"
#include "design/shapes/rebuilt_shape.hpp"

namespace fettle::design::shapes {

using core::scene::MeshProgram;

/// What is wrong with the command: no {out}, a name in braces that is no dimension (with the nearest), a dimension that it does not name.
Errors check_program(const MeshProgram& program, const std::vector<description::ShapeDimension>& dimensions);

/// Runs the program once, and reads what it wrote; vertices and triangles in an order of their own, whatever the file's. Errors:
/// file_not_found (no such program), inconsistent (it failed, or took longer than `time_limit`; with its last words), and those of the
/// mesh's reader.
Result<core::geometry::Mesh> run_program(const MeshProgram& program, const std::vector<description::ShapeDimension>& dimensions,
                                         const std::vector<double>& values);

class ProgramPart : public RebuiltShape {
public:
    /// Tells the read record (core/base/read_record.hpp) of the program and of the files that its command names; what these read in turn
    /// nobody knows. Errors: those of check_program.
    static Result<std::shared_ptr<const ProgramPart>> create(const MeshProgram& program,
                                                             std::vector<description::ShapeDimension> dimensions);

    const MeshProgram& program() const { return program_; }

private:
    ProgramPart(const MeshProgram& program, std::vector<description::ShapeDimension> dimensions);
    MeshProgram program_;
};

}  // namespace fettle::design::shapes
