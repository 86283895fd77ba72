// SPDX-License-Identifier: MIT
/// Reads a mesh file into a geometry::Mesh in metres: STL, OBJ, OFF, PLY and 3MF by readers of our own; COLLADA, glTF, 3DS and AMF
/// by assimp; the solids of STEP files by Open CASCADE, where fettle was built with it.
///
/// Precision. What is read by our own is read in full double precision (binary STL is float by definition): another program's design may
/// have parts that touch, and rounding to float could make them intersect. assimp keeps coordinates in float32: 100.123456789 becomes
/// 100.123459. Where more is needed, export 3MF or OBJ.
///
/// Files may come from anywhere. Every count and every index is checked before it is used; assimp runs in a process of its own, with limits
/// of time (3 s of processor time and 1 s for each MiB of the file) and memory (1 GiB and 100 times the file), so that what it makes of a
/// damaged file is an error here. Files beyond 2 GiB are refused, and so is what places more than 10 million vertices and triangles.
///
/// Axes are those of the file: up in a glTF file is y.
///
/// STEP (docs/method/step.md): each solid of each instance is meshed, with a proven bound of how far the mesh is from its exact faces
/// (Mesh::deviation), checked against the exact volume, area, centroid and box. A solid with a face that cannot be bounded, an open shell
/// or anything else that would be left out is an error that names the face and its entity. Limits: 60 s of processor time and 20 s for each
/// MiB, 2 GiB of memory and 200 times the file. Faces are called after their kind and number ("cylinder 7").
///
/// What is kept: positions, faces (polygons are cut into triangles), polylines and two-vertex faces as codimensional edges, points that the
/// file names as such (`p` in OBJ, faces of one vertex) and the vertices of a file that has nothing else as codimensional points. What is
/// dropped: vertices that nothing uses beside faces, edges or points, edges between vertices in one place, normals, colours, texture
/// coordinates, materials, STL attributes. All objects of a file become one mesh; shells are named after their object (`o` or `g` in OBJ,
/// `solid` in STL, in 3MF the object's name, else "Object_<id>"): "name", or "name/0", "name/1", ... where one object has several shells.
/// From a 3MF everything that its build places is read, except support.
///
/// Validity as a solid is solids/mesh_validity.hpp; which part of a scene the mesh is for, scene/scene.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::mesh_files {

struct MeshReadOptions {
    /// Metres per unit of the file. Formats without a unit only, which are STL, OBJ, OFF, PLY and 3DS: 3MF, AMF (both: millimeter if they
    /// do not say) and COLLADA (metre) state their own, and glTF is in metres; that is used instead.
    double unit = 1;
    /// Merge vertices with exactly equal coordinates, and drop the triangles that become degenerate by it (geometry::weld_exactly). STL
    /// needs it.
    bool weld = true;
    /// Optional, asked on any thread while assimp reads: true ends it, with an error that says so.
    std::function<bool()> should_stop = {};
    /// STEP alone: how far facets may be from round faces [m]; 0: two ten-thousandths of the solid's diagonal, between 1 um and 0.1 mm.
    double chord = 0;
    /// STEP alone: the user's word for how far the mesh is from faces that no bound is known of [m]; 0: these are errors.
    double surface_tolerance = 0;
};

/// The extensions of what is read, as messages list them: ".stl .obj .off ...".
std::string mesh_extensions();
/// In any case: "GEAR.STL".
bool has_mesh_extension(const std::string& path);
/// STEP files, in any case: ".step", ".stp".
bool is_step(const std::string& path);
/// Is it of a format that has a unit of its own, so that MeshReadOptions::unit is not used?
bool states_its_unit(const std::string& path);

/// @param path  The extension decides the format, in any case.
/// @return      The mesh in metres, named after the file ("gear.obj"), connectivity built. Errors, with `where` the path (and line, in
///              text): file_not_found (with the full path looked for), file_unreadable, unsupported (extension, free-form OBJ, binary
///              OFF), parse, out_of_range (vertex index), not_finite (which vertices), mesh_invalid (nothing in it, or a polygon that
///              crosses itself).
/// Contract: options.unit > 0.
Result<geometry::Mesh> read_mesh(const std::string& path, const MeshReadOptions& options = {});

/// The parts of a file: of a 3MF one mesh for each item that its build places, where it places it, named after its object (two items of one
/// object have one name); of a STEP file one for each solid, named after its product ("pin", "pin#2"); of every other format the one mesh,
/// named after the file without its extension. Errors: as read_mesh.
Result<std::vector<geometry::Mesh>> read_mesh_parts(const std::string& path, const MeshReadOptions& options = {});

/// What item_called finds each of the parts by: its name, with "#1", "#2", ... where several have it.
std::vector<std::string> item_names(const std::vector<geometry::Mesh>& parts);

/// One of the parts, by its name. Errors, with `where` the path: inconsistent (none is called so, or several), with the names that there
/// are.
Result<geometry::Mesh> item_called(const std::vector<geometry::Mesh>& parts, const std::string& name, const std::string& path);

}  // namespace fettle::core::mesh_files
