// SPDX-License-Identifier: MIT
/// Open CASCADE's triangles of a solid's faces, joined where faces share an edge or a vertex.
#pragma once

#include <TopoDS_Shape.hxx>
#include <functional>
#include <set>
#include <string>

#include "core/step_importer/face_mesh.hpp"

namespace fettle::core::step_importer {

/// Why a solid is refused: what is the matter, with the face's number and its entity in the file.
struct Fault {
    std::string text;
    int face = 0;  ///< the number of the face whose triangles are at fault; 0: none
};

/// The number of a shape's entity in the file, "#123"; empty: not known.
using EntityOf = std::function<std::string(const TopoDS_Shape&)>;
std::string in_file(const std::string& entity);  ///< " (#123)"
/// "face 7 (#123), a cone,"
std::string told_face(const FaceMesh& face, const EntityOf& entity);

/// The triangles of a solid that Open CASCADE has meshed. Faces that it has left out, and `own` by their numbers, are triangulated here
/// between their edges' nodes. Throws Fault: faces or edges without triangles.
SolidMesh joined_mesh(const TopoDS_Shape& solid, const std::set<int>& own, const EntityOf& entity);
/// Sets FaceMesh::faces_out and faces_in. Throws Fault: triangles that are folded over others in a face's parameters, or about its axis.
void check_folds(SolidMesh& mesh, const EntityOf& entity);

}  // namespace fettle::core::step_importer
