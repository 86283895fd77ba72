// SPDX-License-Identifier: MIT
/// Faces of a mesh by the names that its part gives them (Mesh::face_names), and a part of a mesh as a mesh of its own.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// The names that faces can be asked for by: each once, copies ("slot 1", "slot 2") as one ("slot") and by themselves.
std::vector<std::string> names_of_faces(const Mesh& mesh);

/// The triangles of all faces of that name, increasing: those called so, and its copies. Empty: there are none.
std::vector<int> triangles_of_face(const Mesh& mesh, const std::string& name);

/// Some triangles of a mesh with their vertices and edges alone, and what each is in the whole.
struct SubMesh {
    Mesh mesh;
    std::vector<int> vertices, edges, triangles;  ///< indices into the whole's
};
/// @param triangles  Triangles of the mesh, each once; at least one. Loose edges and points are left out.
SubMesh sub_mesh(const Mesh& mesh, const std::vector<int>& triangles);

}  // namespace fettle::core::geometry
