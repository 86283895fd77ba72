// SPDX-License-Identifier: MIT
/// Triangles of faces while they are refined: nodes in (u, v) for each face, and the lines of the solid's edges that faces share.
#pragma once

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/step_importer/surface_bound.hpp"

namespace fettle::core::step_importer {

using Side = std::pair<int, int>;  ///< of a triangle: two nodes of the face, the lesser first
inline Side side_of(int a, int b) { return a < b ? Side{a, b} : Side{b, a}; }

struct FaceMesh {
    TopoDS_Face face;
    int number = 0;  ///< from 1
    BRepAdaptor_Surface adaptor;
    SurfaceShape shape;
    bool is_reversed = false;
    std::vector<Vector2d> uv;
    std::vector<int> node;                                        ///< of the solid, per node of the face
    std::vector<std::array<int, 3>> triangles;                    ///< nodes of the face, as its surface is oriented
    std::map<Side, std::pair<int, int>> boundary;                 ///< (line, segment) of sides that lie on edges
    double bound = 0;                                             ///< the largest of its triangles
    double edges = 0;                                             ///< what its edges add, both ways
    bool is_bounded = true, faces_out = false, faces_in = false;  ///< of a radial face: its triangles' normals along the rays, or against
};

/// An edge as a line of nodes; in each face that has it, and twice where the face is closed along it.
struct EdgeLine {
    struct Use {
        int face = 0;
        BRepAdaptor_Curve2d curve;
        std::array<CurveShape, 2> shapes;
        std::vector<int> nodes;  ///< of the face
    };
    bool is_degenerate = false;  ///< one place
    double tolerance = 0;        ///< that the file, or Open CASCADE for it, declares
    BRepAdaptor_Curve curve;
    CurveShape shape;
    std::vector<double> parameters;
    std::vector<int> nodes;  ///< of the solid
    std::vector<Use> uses;
};

struct SolidMesh {
    std::vector<Vector3d> places;
    std::vector<FaceMesh> faces;
    std::vector<EdgeLine> lines;

    Corner corner(const FaceMesh& face, int node) const { return {places[face.node[node]], face.uv[node]}; }
    std::array<Corner, 3> corners(const FaceMesh& face, const std::array<int, 3>& t) const {
        return {corner(face, t[0]), corner(face, t[1]), corner(face, t[2])};
    }
};

/// Sets, from all triangles and edges, FaceMesh::bound, edges, is_bounded.
void bound_faces(SolidMesh& mesh);
/// What a face's edges add to its bound where its mesh ends beside the true edge. @param segment of `use` of `line`
double edge_bound(const SolidMesh& mesh, const EdgeLine& line, const EdgeLine::Use& use, std::size_t segment);
/// Splits what is bounded by more than `wanted`; false: nothing was. @param most  triangles of the solid
bool refine(SolidMesh& mesh, double wanted, std::size_t most);

}  // namespace fettle::core::step_importer
