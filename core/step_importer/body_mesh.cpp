// SPDX-License-Identifier: MIT
#include "core/step_importer/body_mesh.hpp"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/step_importer/occt_shapes.hpp"

namespace fettle::core::step_importer {
namespace {

constexpr double widest_angle = 0.35;  // [rad] between neighbouring facets, for Open CASCADE
constexpr int most_rounds = 24;
constexpr std::size_t most_triangles = 500'000;  // of a solid: beyond it facets stay as they are, and are charged so
constexpr double rounding = 0x1p-36;             // of the size: far above what evaluating in double precision loses

double diagonal_of(const TopoDS_Shape& solid) {
    Bnd_Box box;
    BRepBndLib::Add(solid, box, false);
    return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

SolidMesh refined(const TopoDS_Solid& solid, double chord, const std::set<int>& own, const EntityOf& entity) {
    SolidMesh mesh = joined_mesh(solid, own, entity);
    bound_faces(mesh);
    for (int round = 0; round < most_rounds && refine(mesh, chord, most_triangles); ++round) bound_faces(mesh);
    check_folds(mesh, entity);
    return mesh;
}

/// Cones: Open CASCADE sets rows of nodes into them, and wrinkles them about an apex.
std::set<int> cones_of(const TopoDS_Solid& solid) {
    std::set<int> out;
    int number = 0;
    for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
        ++number;
        if (BRepAdaptor_Surface(TopoDS::Face(faces.Current())).GetType() == GeomAbs_Cone) out.insert(number);
    }
    return out;
}

/// With the chord that is wanted; where Open CASCADE folds a face, it is triangulated here, and where that does not do, with another chord.
SolidMesh meshed(const TopoDS_Solid& solid, double chord, const EntityOf& entity) {
    std::optional<Fault> first;
    for (const double factor : {0.9, 0.3, 2.0}) {
        BRepTools::Clean(solid);
        const BRepMesh_IncrementalMesh mesher(solid, factor * chord, false, widest_angle, false);
        std::set<int> own = cones_of(solid), tried;
        while (true) {
            try {
                return refined(solid, chord, own, entity);
            } catch (const Fault& fault) {
                if (!first) first = fault;
                // The other way for this face, once.
                if (fault.face == 0 || !tried.insert(fault.face).second) break;
                if (own.erase(fault.face) == 0) own.insert(fault.face);
            }
        }
    }
    throw *first;
}

/// The largest distance of a node from where its face's parameters have it.
double node_distance(const SolidMesh& mesh) {
    double most = 0;
    for (const FaceMesh& face : mesh.faces)
        for (std::size_t i = 0; i < face.uv.size(); ++i)
            most = std::max(most, (vector_of(face.adaptor.Value(face.uv[i][0], face.uv[i][1]).XYZ()) - mesh.places[face.node[i]]).norm());
    return most;
}

double declared_tolerance(const TopoDS_Shape& solid) {
    double most = 0;
    for (TopExp_Explorer edges(solid, TopAbs_EDGE); edges.More(); edges.Next())
        most = std::max(most, BRep_Tool::Tolerance(TopoDS::Edge(edges.Current())));
    for (TopExp_Explorer vertices(solid, TopAbs_VERTEX); vertices.More(); vertices.Next())
        most = std::max(most, BRep_Tool::Tolerance(TopoDS::Vertex(vertices.Current())));
    return most;
}

void set_deviation(const SolidMesh& mesh, const MeshWishes& wishes, const EntityOf& entity, BodyMesh& out) {
    for (const FaceMesh& face : mesh.faces) {
        if (!face.is_bounded && wishes.surface_tolerance <= 0)
            throw Fault{told_face(face, entity) +
                        " is of a kind whose distance from its triangles has no bound here; say one yourself with --surface-tolerance"};
        const double own = face.is_bounded ? face.bound : wishes.surface_tolerance,
                     both = face.is_bounded ? std::max(face.edges, face.shape.recognised_within) : own;
        out.is_proven = out.is_proven && face.is_bounded;
        // A facet moves out along its rays onto a cylinder that bulges, in onto a bore; faces that are no such may do either.
        out.out = std::max({out.out, both, face.shape.is_radial() && !face.faces_out ? 0 : own});
        out.in = std::max({out.in, both, face.shape.is_radial() && !face.faces_in ? 0 : own});
    }
    for (const Vector3d& place : mesh.places) out.largest = std::max(out.largest, place.norm());
    const double nodes = node_distance(mesh) + out.declared + rounding * out.largest;
    out.out += nodes;
    out.in += nodes;
}

/// The largest angle between a triangle's plane and the surface's at its corners, as 1 / cos.
double tilt(const FaceMesh& face, const std::array<int, 3>& t, const Vector3d& normal) {
    double least = 1;
    for (const int node : t) {
        gp_Pnt place;
        gp_Vec u, v;
        face.adaptor.D1(face.uv[node][0], face.uv[node][1], place, u, v);
        const Vector3d own = vector_of(u.Crossed(v).XYZ());
        if (own.norm() > 0) least = std::min(least, std::abs(own.normalized().dot(normal)));
    }
    return 1 / std::max(least, 0.3);
}

void add_triangles(const SolidMesh& mesh, double nodes, BodyMesh& out) {
    for (const FaceMesh& face : mesh.faces) {
        out.face_names.push_back(std::string(name_of(face.shape.kind)) + " " + std::to_string(face.number));
        for (const auto& t : face.triangles) {
            const int a = face.node[t[0]], b = face.node[t[1]], c = face.node[t[2]];
            if (a == b || b == c || c == a) continue;
            out.triangles.push_back(face.is_reversed ? std::array<int, 3>{a, c, b} : std::array<int, 3>{a, b, c});
            out.triangle_face.push_back(static_cast<int>(out.face_names.size()) - 1);
            const Vector3d normal = (mesh.places[b] - mesh.places[a]).cross(mesh.places[c] - mesh.places[a]);
            const double area = normal.norm() / 2;
            if (!(area > 0)) continue;
            const double steep = tilt(face, t, normal.normalized());
            out.area_allowance += area * (steep - 1);
            out.volume_allowance += area * steep * (std::max(face.bound, face.edges) + nodes);
        }
    }
    // Beside the chords of edges.
    for (const EdgeLine& line : mesh.lines) {
        for (std::size_t k = 0; k + 1 < line.nodes.size() && !line.is_degenerate; ++k) {
            const double chord = chord_bound(line.shape, line.parameters[k], line.parameters[k + 1]).value_or(0) + nodes;
            const double length = (mesh.places[line.nodes[k + 1]] - mesh.places[line.nodes[k]]).norm();
            out.area_allowance += static_cast<double>(line.uses.size()) * length * chord;
            out.volume_allowance += length * chord * chord;
        }
    }
}

void check_closed(const std::vector<std::array<int, 3>>& triangles) {
    std::set<std::pair<int, int>> sides;
    for (const auto& t : triangles)
        for (int k = 0; k < 3; ++k)
            if (!sides.insert({t[k], t[(k + 1) % 3]}).second)
                throw Fault{"its faces do not bound a solid: two pass along an edge the same way"};
    for (const auto& [a, b] : sides)
        if (sides.count({b, a}) == 0) throw Fault{"its surface is open: an edge has one face only"};
}

}  // namespace

double usual_chord(double diagonal) { return std::clamp(2e-4 * diagonal, 1e-3, 0.1); }

BodyMesh mesh_of(const TopoDS_Solid& solid, const MeshWishes& wishes, const EntityOf& entity) {
    const double diagonal = diagonal_of(solid), chord = wishes.chord > 0 ? wishes.chord : usual_chord(diagonal);
    if (!(diagonal > 0) || !(diagonal < 1e9)) throw Fault{"it has no size, or one beyond 1000 km"};
    BodyMesh out;
    out.declared = declared_tolerance(solid);
    constexpr double most_declared = 1e-2;  // of the size
    if (out.declared > most_declared * diagonal)
        throw Fault{"its edges lie up to " + std::to_string(out.declared) + " mm beside its faces, more than a hundredth of its size"};
    const SolidMesh mesh = meshed(solid, chord, entity);
    set_deviation(mesh, wishes, entity, out);
    out.places = mesh.places;
    add_triangles(mesh, node_distance(mesh) + out.declared, out);
    check_closed(out.triangles);
    return out;
}

}  // namespace fettle::core::step_importer
