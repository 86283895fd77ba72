// SPDX-License-Identifier: MIT
// By CGAL's corefinement, with exact constructions. The only file of core that includes CGAL; its Polygon_mesh_processing is under the GPL.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fettle/core/parts/solid_cut.hpp"

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

ExactMesh exact_mesh(const geometry::Mesh& mesh, int first_origin) {
    ExactMesh out;
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) out.add_vertex({mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)});
    Origins origins = out.add_property_map<Face, int>(origin_name, -1).first;
    int origin = first_origin;
    for (const auto& t : mesh.triangles) {
        const auto vertex = [&](std::size_t k) { return Vertex(static_cast<ExactMesh::size_type>(t[k])); };
        const Face face = out.add_face(vertex(0), vertex(1), vertex(2));
        if (face != ExactMesh::null_face()) origins[face] = origin;
        ++origin;
    }
    return out;
}

// What CGAL finds, before it changes the meshes, and what becomes of faces.
struct Record {
    const geometry::Mesh *mesh_a, *mesh_b;
    const ExactMesh *a, *b;
    Origins of_a, of_b, of_result;
    int triangles_a = 0;
    int splitting = -1;
    std::map<std::size_t, VertexOrigin> by_node;
    std::map<Kernel::Point_3, VertexOrigin> by_point;

    Origins& origins(const ExactMesh& mesh) { return &mesh == a ? of_a : &mesh == b ? of_b : of_result; }
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
        const bool edge_of_a = &of_edge == record->a;
        VertexOrigin origin;
        if (at_target || at_source) {
            origin.kind = edge_of_a ? Kind::vertex_of_a : Kind::vertex_of_b;
            origin.from = origin.to = static_cast<int>(at_target ? of_edge.target(edge) : of_edge.source(edge));
        } else if (dimension == 0) {
            origin.kind = edge_of_a ? Kind::vertex_of_b : Kind::vertex_of_a;
            origin.from = origin.to = static_cast<int>(of_face.target(met));
        } else {
            origin.kind = edge_of_a ? Kind::edge_of_a : Kind::edge_of_b;
            const int source = static_cast<int>(of_edge.source(edge)), target = static_cast<int>(of_edge.target(edge));
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
        const int source = static_cast<int>(mesh.source(edge)), target = static_cast<int>(mesh.target(edge));
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

Error no_solid() {
    return {ErrorCode::unsupported,
            {},
            "the result touches itself along an edge, which no mesh of a solid can say: move one of the two solids by a little, or give "
            "them an overlap"};
}

}  // namespace

bool can_cut_solids() { return true; }

Result<SolidCut> cut_solids(const geometry::Mesh& mesh_a, const geometry::Mesh& mesh_b, Combination combination) {
    const int triangles_a = count_of(mesh_a.triangles);
    ExactMesh a = exact_mesh(mesh_a, 0), b = exact_mesh(mesh_b, triangles_a), result;
    if (a.number_of_faces() != mesh_a.triangles.size() || b.number_of_faces() != mesh_b.triangles.size())
        return Error{ErrorCode::unsupported, {}, "one of the two meshes touches itself at a vertex or along an edge"};
    Record record;
    record.mesh_a = &mesh_a;
    record.mesh_b = &mesh_b;
    record.a = &a;
    record.b = &b;
    record.triangles_a = triangles_a;
    record.of_a = a.property_map<Face, int>(origin_name).first;
    record.of_b = b.property_map<Face, int>(origin_name).first;
    record.of_result = result.add_property_map<Face, int>(origin_name, -1).first;
    for (const bool of_a : {true, false}) {
        const ExactMesh& mesh = of_a ? a : b;
        for (const Vertex v : mesh.vertices()) {
            const int index = static_cast<int>(v);
            record.by_point.emplace(mesh.point(v), VertexOrigin{of_a ? Kind::vertex_of_a : Kind::vertex_of_b, index, index, 0});
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
    if (!is_solid) return no_solid();
    SolidCut cut;
    std::map<Vertex, int> index;
    for (const Face face : result.faces()) {
        CutTriangle triangle;
        std::size_t k = 0;
        for (const Vertex v : result.vertices_around_face(result.halfedge(face))) {
            const auto [place, is_new] = index.emplace(v, count_of(cut.vertices));
            if (is_new) {
                const auto origin = record.by_point.find(result.point(v));
                FETTLE_ASSERT(origin != record.by_point.end(), "every vertex of a combination of solids is from somewhere");
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
