// SPDX-License-Identifier: MIT
#include "core/step_importer/face_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/step_importer/occt_shapes.hpp"

namespace fettle::core::step_importer {
namespace {

constexpr double unbounded = 1e100;

/// Do the chords of an edge, seen along the rays of a face, lie on the edge itself? Circles about its axis, and straight lines; splines
/// that are such to within their edge's own tolerance.
bool runs_along_rays(const EdgeLine& line, const SurfaceShape& surface) {
    if (line.shape.kind == CurveShape::Kind::line) return true;
    const bool is_round = surface.kind != SurfaceShape::Kind::sphere;
    if (line.curve.GetType() == GeomAbs_Circle) {
        const gp_Circ circle = line.curve.Circle();
        const Vector3d arm = vector_of(circle.Location().XYZ()) - surface.point;
        if (!is_round) return arm.norm() < line.tolerance;  // a great circle
        constexpr double alike = 1e-9;
        return circle.Radius() * vector_of(circle.Axis().Direction().XYZ()).cross(surface.axis).norm() < line.tolerance &&
               (arm - arm.dot(surface.axis) * surface.axis).norm() < line.tolerance + alike * circle.Radius();
    }
    if (line.shape.kind != CurveShape::Kind::spline) return false;
    const auto place = [](const Pole& pole) { return Vector3d(pole.head<3>() / pole[3]); };
    const Vector3d begin = place(line.shape.pieces.front().poles.front()), end = place(line.shape.pieces.back().poles.back());
    const Vector3d chord = (end - begin).norm() > 0 ? Vector3d((end - begin).normalized()) : Vector3d(Vector3d::Zero());
    bool is_level = is_round, is_straight = chord.norm() > 0;
    for (const BezierCurve& piece : line.shape.pieces) {
        for (const Pole& pole : piece.poles) {
            const Vector3d arm = place(pole) - begin;
            is_level = is_level && std::abs(arm.dot(surface.axis)) <= line.tolerance;
            is_straight = is_straight && (arm - arm.dot(chord) * chord).norm() <= line.tolerance;
        }
    }
    return is_level || is_straight;
}

/// Does one of them stand on the axis, where its angle says nothing?
bool is_at_apex(const SurfaceShape& shape, const Corner& a, const Corner& b) {
    return ray_at(shape, a.place).isZero() || ray_at(shape, b.place).isZero();
}

/// How much of a triangle's bound each of its sides is to blame for.
double weight_of(const SurfaceShape& shape, const std::optional<SurfaceSuprema>& most, const Corner& a, const Corner& b) {
    if (shape.kind == SurfaceShape::Kind::cylinder || shape.kind == SurfaceShape::Kind::cone)
        return shape.is_recognised || is_at_apex(shape, a, b) ? ray_at(shape, a.place).cross(ray_at(shape, b.place)).norm()
                                                              : std::abs(a.uv[0] - b.uv[0]);
    if (!most) return (a.place - b.place).norm();
    const double du = std::abs(a.uv[0] - b.uv[0]), dv = std::abs(a.uv[1] - b.uv[1]);
    return most->uu * du * du + 2 * most->uv * du * dv + most->vv * dv * dv + 2 * (most->jump_u * du + most->jump_v * dv);
}

int worst_side(const SolidMesh& mesh, const FaceMesh& face, const std::array<int, 3>& t) {
    const auto corners = mesh.corners(face, t);
    const auto [low_u, high_u] = std::minmax({corners[0].uv[0], corners[1].uv[0], corners[2].uv[0]});
    const auto [low_v, high_v] = std::minmax({corners[0].uv[1], corners[1].uv[1], corners[2].uv[1]});
    const auto most = suprema(face.shape, {low_u, low_v}, {high_u, high_v});
    int worst = 0;
    double largest = -1;
    for (int k = 0; k < 3; ++k) {
        const double weight = weight_of(face.shape, most, corners[k], corners[(k + 1) % 3]);
        if (weight <= largest) continue;
        largest = weight;
        worst = k;
    }
    return worst;
}

int add_node(FaceMesh& face, const Vector2d& uv, int node) {
    face.uv.push_back(uv);
    face.node.push_back(node);
    return static_cast<int>(face.uv.size()) - 1;
}

/// Halves a segment of an edge, in every face that has it. @param split  per face: the new node on a side
void split_segment(SolidMesh& mesh, EdgeLine& line, std::size_t k, std::vector<std::map<Side, int>>& split) {
    const double t = (line.parameters[k] + line.parameters[k + 1]) / 2;
    int node = line.nodes[k];
    if (!line.is_degenerate) {
        node = static_cast<int>(mesh.places.size());
        mesh.places.push_back(vector_of(line.curve.Value(t).XYZ()));
    }
    for (EdgeLine::Use& use : line.uses) {
        const gp_Pnt2d uv = use.curve.Value(t);
        const int own = add_node(mesh.faces[use.face], {uv.X(), uv.Y()}, node);
        split[use.face][side_of(use.nodes[k], use.nodes[k + 1])] = own;
        use.nodes.insert(use.nodes.begin() + static_cast<std::ptrdiff_t>(k) + 1, own);
    }
    line.nodes.insert(line.nodes.begin() + static_cast<std::ptrdiff_t>(k) + 1, node);
    line.parameters.insert(line.parameters.begin() + static_cast<std::ptrdiff_t>(k) + 1, t);
}

void split_triangles(FaceMesh& face, const std::map<Side, int>& split) {
    std::vector<std::array<int, 3>> out;
    out.reserve(face.triangles.size());
    for (const std::array<int, 3>& t : face.triangles) {
        std::array<int, 3> on{};
        int count = 0, at = 0;
        for (int k = 0; k < 3; ++k) {
            const auto found = split.find(side_of(t[k], t[(k + 1) % 3]));
            on[k] = found == split.end() ? -1 : found->second;
            count += on[k] >= 0 ? 1 : 0;
        }
        if (count == 0) {
            out.push_back(t);
            continue;
        }
        // Turned so that with one side it is the first, with two the last is whole.
        if (count == 1)
            while (on[at] < 0) ++at;
        if (count == 2)
            while (on[(at + 2) % 3] >= 0) ++at;
        const int a = t[at], b = t[(at + 1) % 3], c = t[(at + 2) % 3], ab = on[at], bc = on[(at + 1) % 3], ca = on[(at + 2) % 3];
        if (count == 1) out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
        if (count == 2) out.insert(out.end(), {{a, ab, c}, {ab, b, bc}, {ab, bc, c}});
        if (count == 3) out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {bc, c, ca}, {ab, bc, ca}});
    }
    face.triangles = std::move(out);
}

void find_boundaries(SolidMesh& mesh) {
    for (FaceMesh& face : mesh.faces) face.boundary.clear();
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
        for (const EdgeLine::Use& use : mesh.lines[l].uses)
            for (std::size_t k = 0; k + 1 < use.nodes.size(); ++k)
                mesh.faces[use.face].boundary[side_of(use.nodes[k], use.nodes[k + 1])] = {static_cast<int>(l), static_cast<int>(k)};
}

}  // namespace

double edge_bound(const SolidMesh& mesh, const EdgeLine& line, const EdgeLine::Use& use, std::size_t k) {
    const FaceMesh& face = mesh.faces[use.face];
    const double from = line.parameters[k], to = line.parameters[k + 1];
    if (face.shape.kind == SurfaceShape::Kind::plane) return 0;  // its own plane it does not leave
    if (face.shape.is_radial()) {
        if (line.is_degenerate || runs_along_rays(line, face.shape)) return 0;
        const auto chord = chord_bound(line.shape, from, to);
        // From the chord both its rays' ends and the true edge are this far; what lies between them on the surface is nearly straight.
        return chord ? std::max(*chord, face.bound) + (*chord + face.bound) / 4 : unbounded;
    }
    const auto du = chord_bound(use.shapes[0], from, to), dv = chord_bound(use.shapes[1], from, to);
    if (!du || !dv) return unbounded;
    if (*du == 0 && *dv == 0) return 0;
    const Vector2d beside(*du, *dv), a = face.uv[use.nodes[k]], b = face.uv[use.nodes[k + 1]];
    const auto most = suprema(face.shape, a.cwiseMin(b) - beside, a.cwiseMax(b) + beside);
    return most ? face.bound + most->u * *du + most->v * *dv : unbounded;
}

void bound_faces(SolidMesh& mesh) {
    for (FaceMesh& face : mesh.faces) {
        face.bound = face.edges = 0;
        face.is_bounded = face.shape.kind != SurfaceShape::Kind::unknown;
        for (const auto& t : face.triangles) {
            const auto bound = triangle_bound(face.shape, mesh.corners(face, t));
            face.is_bounded = face.is_bounded && bound.has_value();
            face.bound = std::max(face.bound, bound.value_or(0));
        }
    }
    for (const EdgeLine& line : mesh.lines) {
        for (const EdgeLine::Use& use : line.uses) {
            FaceMesh& face = mesh.faces[use.face];
            for (std::size_t k = 0; k + 1 < line.nodes.size(); ++k) face.edges = std::max(face.edges, edge_bound(mesh, line, use, k));
            face.is_bounded = face.is_bounded && face.edges < unbounded;
        }
    }
}

bool refine(SolidMesh& mesh, double wanted, std::size_t most) {
    std::size_t count = 0;
    for (const FaceMesh& face : mesh.faces) count += face.triangles.size();
    if (count >= most) return false;
    find_boundaries(mesh);
    std::vector<std::set<Side>> inner(mesh.faces.size());
    std::vector<std::set<int>> segments(mesh.lines.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const FaceMesh& face = mesh.faces[f];
        if (!face.is_bounded || face.bound <= wanted) continue;
        for (const auto& t : face.triangles) {
            const auto bound = triangle_bound(face.shape, mesh.corners(face, t));
            if (!bound || *bound <= wanted) continue;
            const int k = worst_side(mesh, face, t);
            const Side side = side_of(t[k], t[(k + 1) % 3]);
            if (const auto found = face.boundary.find(side); found == face.boundary.end()) {
                inner[f].insert(side);
            } else {
                segments[found->second.first].insert(found->second.second);
            }
        }
    }
    // An edge is halved for what it adds beyond the triangles, which have their own turn.
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
        for (const EdgeLine::Use& use : mesh.lines[l].uses)
            for (std::size_t k = 0; k + 1 < mesh.lines[l].nodes.size() && mesh.faces[use.face].is_bounded; ++k)
                if (edge_bound(mesh, mesh.lines[l], use, k) > std::max(1.5 * wanted, 1.6 * mesh.faces[use.face].bound))
                    segments[l].insert(static_cast<int>(k));
    bool any = false;
    std::vector<std::map<Side, int>> split(mesh.faces.size());
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
        for (auto k = segments[l].rbegin(); k != segments[l].rend(); ++k, any = true)
            split_segment(mesh, mesh.lines[l], static_cast<std::size_t>(*k), split);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        FaceMesh& face = mesh.faces[f];
        for (const Side& side : inner[f]) {
            const Vector2d uv = (face.uv[side.first] + face.uv[side.second]) / 2;
            const int node = static_cast<int>(mesh.places.size());
            mesh.places.push_back(vector_of(face.adaptor.Value(uv[0], uv[1]).XYZ()));
            split[f][side] = add_node(face, uv, node);
            any = true;
        }
        if (!split[f].empty()) split_triangles(face, split[f]);
    }
    return any;
}

}  // namespace fettle::core::step_importer
