// SPDX-License-Identifier: MIT
// By CGAL's corefinement, with exact constructions. The only file of core that includes CGAL; its Polygon_mesh_processing is under the GPL.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/geometry/half_edges.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = ExactMesh::Face_index;
using Halfedge = ExactMesh::Halfedge_index;
using Vertex = ExactMesh::Vertex_index;
using Origins = ExactMesh::Property_map<Face, int>;
using Kind = VertexOrigin::Kind;

const char* const origin_name = "f:origin";

// A mesh, and which of its vertices each of the exact one's is: where a surface touches itself in a point it takes one for each fan.
struct Operand {
    ExactMesh exact;
    std::vector<int> vertex;
};

// Per triangle and corner, numbered through: the fan of triangles round its vertex, by one of its corners. Nothing: an edge is not in two
// triangles, once in each direction.
std::optional<std::vector<int>> fans_of(const geometry::Mesh& mesh) {
    std::vector<int> fan(3 * mesh.triangles.size());
    std::iota(fan.begin(), fan.end(), 0);
    const auto root = [&](int c) {
        while (fan[c] != c) c = fan[c] = fan[fan[c]];
        return c;
    };
    const std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    bool closed = !halves.empty();
    const auto corner_at = [&](int triangle, int v) {
        const auto& t = mesh.triangles[triangle];
        return 3 * triangle + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
    };
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        closed = closed && geometry::is_sound_edge(halves, first, last);
        if (!closed) return;
        for (const int v : {halves[first].low, halves[first].high})
            fan[root(corner_at(halves[first].triangle, v))] = root(corner_at(halves[first + 1].triangle, v));
    });
    if (!closed) return std::nullopt;
    for (int& c : fan) c = root(c);
    return fan;
}

using Exact = Kernel::FT;
using Point = Kernel::Point_3;

Exact determinant(const std::array<std::array<Exact, 3>, 3>& m, std::size_t size) {
    if (size == 1) return m[0][0];
    const Exact minor = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    if (size == 2) return minor;
    return m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) - m[1][2] * (m[0][0] * m[2][1] - m[0][1] * m[2][0]) + m[2][2] * minor;
}

// The nearest point that lies in all of the planes, exactly: p + sum_k s_k n_k, with (n_i . n_k) s = d - n . p by Cramer's rule.
Point put_on_planes(const Vector3& at, const std::vector<int>& which, const std::vector<FlatPlane>& planes, double rounding) {
    const Point p(at.x(), at.y(), at.z());
    const std::size_t size = which.size();
    std::vector<Kernel::Vector_3> normals;
    std::vector<Exact> left;
    bool is_there = true;
    for (const int k : which) {
        const FlatPlane& plane = planes[k];
        normals.emplace_back(plane.normal.x(), plane.normal.y(), plane.normal.z());
        left.push_back(plane.offset - normals.back() * (p - CGAL::ORIGIN));
        is_there = is_there && CGAL::is_zero(left.back());
    }
    if (is_there) return p;
    std::array<std::array<Exact, 3>, 3> gram;
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t k = 0; k < size; ++k) gram[i][k] = normals[i] * normals[k];
    const Exact all = determinant(gram, size);
    Kernel::Vector_3 way(0, 0, 0);
    for (std::size_t k = 0; k < size; ++k) {
        auto replaced = gram;
        for (std::size_t i = 0; i < size; ++i) replaced[i][k] = left[i];
        way = way + (determinant(replaced, size) / all) * normals[k];
    }
    if (CGAL::to_double(way.squared_length()) > 64 * rounding * rounding) return p;
    const Point out = p + way;
    CGAL::exact(out);  // what is computed with it starts from here
    return out;
}

// Nothing: it is no closed surface.
std::optional<Operand> operand_of(const geometry::Mesh& mesh, int first_origin, const std::vector<std::vector<int>>& planes_of_vertex,
                                  const std::vector<FlatPlane>& planes, double rounding) {
    const auto fans = fans_of(mesh);
    if (!fans || !mesh.vertices.allFinite()) return std::nullopt;
    Operand out;
    std::vector<Vertex> made(fans->size());
    for (std::size_t c = 0; c < fans->size(); ++c) {
        if ((*fans)[c] != static_cast<int>(c)) continue;
        const int v = mesh.triangles[c / 3][c % 3];
        made[c] = out.exact.add_vertex(put_on_planes(mesh.vertices.col(v), planes_of_vertex[v], planes, rounding));
        out.vertex.push_back(v);
    }
    Origins origins = out.exact.add_property_map<Face, int>(origin_name, -1).first;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto vertex = [&](std::size_t k) { return made[(*fans)[3 * t + k]]; };
        const Face face = out.exact.add_face(vertex(0), vertex(1), vertex(2));
        if (face == ExactMesh::null_face()) return std::nullopt;
        origins[face] = first_origin + static_cast<int>(t);
    }
    return out;
}

// A record of what CGAL finds, before it changes the meshes, and of where the faces end up.
struct Record {
    const geometry::Mesh *mesh_a, *mesh_b;
    const Operand *a, *b;
    Origins of_a, of_b, of_result;
    int triangles_a = 0;
    int splitting = -1;
    std::map<std::size_t, VertexOrigin> by_node;
    std::map<Kernel::Point_3, VertexOrigin> by_point;

    Origins& origins(const ExactMesh& mesh) { return &mesh == &a->exact ? of_a : &mesh == &b->exact ? of_b : of_result; }
    int vertex(const ExactMesh& mesh, Vertex v) const { return (&mesh == &a->exact ? a : b)->vertex[static_cast<std::size_t>(v)]; }
};

Vector3 point_of(const geometry::Mesh& mesh, int v) { return mesh.vertices.col(v); }

struct Visitor : processing::Corefinement::Default_visitor<ExactMesh> {
    Record* record = nullptr;

    void before_subface_creations(Face split, ExactMesh& mesh) { record->splitting = record->origins(mesh)[split]; }
    void after_subface_created(Face made, ExactMesh& mesh) { record->origins(mesh)[made] = record->splitting; }
    void after_face_copy(Face from, const ExactMesh& mesh, Face to, ExactMesh& target) {
        record->origins(target)[to] = record->origins(mesh)[from];
    }

    void intersection_point_detected(std::size_t node, int dimension, Halfedge edge, Halfedge met, const ExactMesh& of_edge,
                                     const ExactMesh& of_face, bool at_target, bool at_source) {
        const bool edge_of_a = &of_edge == &record->a->exact;
        VertexOrigin origin;
        if (at_target || at_source) {
            origin.kind = edge_of_a ? Kind::vertex_of_a : Kind::vertex_of_b;
            origin.from = origin.to = record->vertex(of_edge, at_target ? of_edge.target(edge) : of_edge.source(edge));
        } else if (dimension == 0) {
            origin.kind = edge_of_a ? Kind::vertex_of_b : Kind::vertex_of_a;
            origin.from = origin.to = record->vertex(of_face, of_face.target(met));
        } else {
            origin.kind = edge_of_a ? Kind::edge_of_a : Kind::edge_of_b;
            const int source = record->vertex(of_edge, of_edge.source(edge)), target = record->vertex(of_edge, of_edge.target(edge));
            origin.from = std::min(source, target);
            origin.to = std::max(source, target);
            const int offset = edge_of_a ? record->triangles_a : 0;
            const auto triangle = [&](Halfedge h) { return record->origins(of_face)[of_face.face(h)] - offset; };
            origin.triangle = triangle(met);
            // On an edge of the other mesh: that of its two faces which the edge goes through more steeply.
            if (dimension == 1) {
                const int other = triangle(of_face.opposite(met));
                const double one = steepness(origin, origin.triangle, edge_of_a), two = steepness(origin, other, edge_of_a);
                if (two > one) origin.triangle = other;
                if (std::max(one, two) < 1e-9) origin.side = side_of(origin.triangle, met, of_face, edge_of_a);
            }
        }
        record->by_node.emplace(node, origin);
    }

    void new_vertex_added(std::size_t node, Vertex vertex, const ExactMesh& mesh) {
        const auto found = record->by_node.find(node);
        if (found != record->by_node.end()) record->by_point.emplace(mesh.point(vertex), found->second);
    }

    int side_of(int triangle, Halfedge edge, const ExactMesh& mesh, bool edge_of_a) const {
        const auto& t = (edge_of_a ? *record->mesh_b : *record->mesh_a).triangles[triangle];
        const int source = record->vertex(mesh, mesh.source(edge)), target = record->vertex(mesh, mesh.target(edge));
        for (std::size_t k = 0; k < 3; ++k)
            if (std::minmax(t[k], t[(k + 1) % 3]) == std::minmax(source, target)) return static_cast<int>(k);
        return -1;
    }

    double steepness(const VertexOrigin& origin, int triangle, bool edge_of_a) const {
        const geometry::Mesh &of_edge = edge_of_a ? *record->mesh_a : *record->mesh_b,
                             &of_face = edge_of_a ? *record->mesh_b : *record->mesh_a;
        const auto& t = of_face.triangles[triangle];
        const Vector3 p = point_of(of_face, t[0]);
        const Vector3 normal = (point_of(of_face, t[1]) - p).cross(point_of(of_face, t[2]) - p).normalized();
        return std::abs(normal.dot((point_of(of_edge, origin.to) - point_of(of_edge, origin.from)).normalized()));
    }
};

Vector3 rounded(const Kernel::Point_3& p) { return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())}; }

// The angles between which a solid is, about an edge of its surface: from the first on, counter-clockwise seen against the edge.
std::array<double, 2> wedge_about(const ExactMesh& mesh, Halfedge edge, const Vector3& start, const Vector3& axis) {
    Eigen::Index least = 0;
    axis.cwiseAbs().minCoeff(&least);
    const Vector3 aside = axis.cross(Vector3::Unit(least)).normalized(), up = axis.cross(aside);
    const auto angle = [&](Halfedge half) {
        const Vector3 d = rounded(mesh.point(mesh.target(mesh.next(half)))) - start;
        return std::atan2(d.dot(up), d.dot(aside));
    };
    return {angle(mesh.opposite(edge)), angle(edge)};
}

double turned(double from, double to) {
    const double turn = std::fmod(to - from, 2 * std::numbers::pi);
    return turn < 0 ? turn + 2 * std::numbers::pi : turn;
}

// Is the combination on more than one side of an edge that both surfaces have?
bool touches_itself(const std::array<double, 2>& a, const std::array<double, 2>& b, Combination combination) {
    const auto is_in = [](const std::array<double, 2>& wedge, double angle) {
        return turned(wedge[0], angle) < turned(wedge[0], wedge[1]);
    };
    std::array<double, 4> ends{a[0], a[1], b[0], b[1]};
    std::sort(ends.begin(), ends.end());
    std::vector<bool> is_kept;
    for (std::size_t k = 0; k < 4; ++k) {
        const double way = turned(ends[k], ends[(k + 1) % 4]);
        if (way < 1e-9) continue;
        const bool in_a = is_in(a, ends[k] + way / 2), in_b = is_in(b, ends[k] + way / 2);
        is_kept.push_back(combination == Combination::unite       ? in_a || in_b
                          : combination == Combination::intersect ? in_a && in_b
                                                                  : in_a && !in_b);
    }
    int changes = 0;
    for (std::size_t k = 0; k < is_kept.size(); ++k) changes += is_kept[k] != is_kept[(k + 1) % is_kept.size()] ? 1 : 0;
    return changes > 2;
}

// The error about two meshes that have been cut by each other.
Error no_solid(const ExactMesh& a, const ExactMesh& b, Combination combination) {
    std::map<std::pair<Kernel::Point_3, Kernel::Point_3>, Halfedge> of_b;
    for (const Halfedge h : b.halfedges()) of_b.emplace(std::pair(b.point(b.source(h)), b.point(b.target(h))), h);
    std::string place;
    for (const auto edge : a.edges()) {
        const Halfedge h = a.halfedge(edge);
        const auto other = of_b.find(std::pair(a.point(a.source(h)), a.point(a.target(h))));
        if (other == of_b.end()) continue;
        const Vector3 start = rounded(a.point(a.source(h))), end = rounded(a.point(a.target(h))), axis = (end - start).normalized();
        if (!touches_itself(wedge_about(a, h, start, axis), wedge_about(b, other->second, start, axis), combination)) continue;
        place = " from " + fettle::core::parts::place(start) + " to " + fettle::core::parts::place(end);
        break;
    }
    return {
        ErrorCode::unsupported,
        {},
        "what is left touches itself along the edge" + place + ", which no solid does: " +
            (combination == Combination::unite ? "let the two overlap there, or keep them apart"
                                               : "let the cut go farther there, or less far, so that some material or some room is left")};
}

}  // namespace

bool can_cut_solids() { return true; }

Result<SolidCut> cut_solids(const FacedMesh& faced_a, const FacedMesh& faced_b, double rounding, Combination combination) {
    const geometry::Mesh &mesh_a = faced_a.mesh, &mesh_b = faced_b.mesh;
    const FlatFaces flat = flat_faces(faced_a, faced_b, rounding);
    const int triangles_a = count_of(mesh_a.triangles);
    std::optional<Operand> of_a = operand_of(mesh_a, 0, flat.of_vertex[0], flat.planes, rounding),
                           of_b = operand_of(mesh_b, triangles_a, flat.of_vertex[1], flat.planes, rounding);
    if (!of_a || !of_b)
        return Error{ErrorCode::mesh_invalid, {}, std::string("the surface of the ") + (of_a ? "second" : "first") + " is not closed"};
    ExactMesh &a = of_a->exact, &b = of_b->exact, result;
    Record record;
    record.mesh_a = &mesh_a;
    record.mesh_b = &mesh_b;
    record.a = &*of_a;
    record.b = &*of_b;
    record.triangles_a = triangles_a;
    record.of_a = a.property_map<Face, int>(origin_name).first;
    record.of_b = b.property_map<Face, int>(origin_name).first;
    record.of_result = result.add_property_map<Face, int>(origin_name, -1).first;
    for (const bool first : {true, false}) {
        const Operand& operand = first ? *of_a : *of_b;
        for (const Vertex v : operand.exact.vertices()) {
            const int index = operand.vertex[static_cast<std::size_t>(v)];
            record.by_point.emplace(operand.exact.point(v), VertexOrigin{first ? Kind::vertex_of_a : Kind::vertex_of_b, index, index, 0});
        }
    }
    Visitor visitor;
    visitor.record = &record;
    const auto options = CGAL::parameters::visitor(visitor).throw_on_self_intersection(true);
    bool is_solid = false;
    try {
        if (combination == Combination::unite)
            is_solid = processing::corefine_and_compute_union(a, b, result, options);
        else if (combination == Combination::subtract)
            is_solid = processing::corefine_and_compute_difference(a, b, result, options);
        else
            is_solid = processing::corefine_and_compute_intersection(a, b, result, options);
    } catch (const processing::Corefinement::Self_intersection_exception&) {
        return Error{ErrorCode::mesh_invalid, {}, "one of the two solids cuts itself near the other: it cannot be cut"};
    }
    if (!is_solid) return no_solid(a, b, combination);
    SolidCut cut;
    std::map<const VertexOrigin*, int> index;  // a surface that touches itself in a point has one vertex there
    for (const Face face : result.faces()) {
        CutTriangle triangle;
        std::size_t k = 0;
        for (const Vertex v : result.vertices_around_face(result.halfedge(face))) {
            const auto origin = record.by_point.find(result.point(v));
            FETTLE_ASSERT(origin != record.by_point.end(), "every vertex of a combination of solids is from somewhere");
            const auto [place, is_new] = index.emplace(&origin->second, count_of(cut.vertices));
            if (is_new) {
                cut.vertices.push_back(origin->second);
                const auto& p = result.point(v);
                cut.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
            }
            if (k < 3) triangle.corners[k++] = place->second;
        }
        const int origin = record.of_result[face];
        FETTLE_ASSERT(origin >= 0, "every face of a combination of solids is from somewhere");
        triangle.of_a = origin < triangles_a;
        triangle.triangle = triangle.of_a ? origin : origin - triangles_a;
        cut.triangles.push_back(triangle);
    }
    return cut;
}

}  // namespace fettle::core::parts
