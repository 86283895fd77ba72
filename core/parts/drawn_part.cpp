// SPDX-License-Identifier: MIT
#include "core/parts/drawn_part.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/parts/fault_words.hpp"
#include "core/solids/mesh_validity.hpp"

namespace fettle::core::parts {
namespace {

using expression::Tape;

DrawnSurface drawn_surface(const Surface& surface) {
    DrawnSurface out;
    out.kind = surface.kind;
    out.feature = surface.feature;
    for (std::size_t k = 0; k < 3; ++k) {
        out.point[k] = surface.point[k].value;
        out.axis[k] = surface.axis[k].value;
    }
    out.radius = surface.radius.value;
    out.slope = surface.slope.value;
    out.hollow = surface.hollow;
    return out;
}

std::vector<Matrix3X> jacobian_of(const Drawing& drawing, const Solid& solid) {
    const int dimensions = drawing.dimension_count();
    const auto n = static_cast<Eigen::Index>(solid.vertices.size());
    std::vector<Matrix3X> out(dimensions, Matrix3X::Zero(3, n));
    if (dimensions == 0) return out;
    const auto& nodes = drawing.tape().nodes();
    // Inputs are at the values that they were recorded with: those that the nodes of the vertices have.
    const std::vector<double> at = expression::values<double>(nodes, drawing.dimensions());
    const MatrixX gradients = expression::gradients(nodes, at, dimensions);
    for (Eigen::Index v = 0; v < n; ++v) {
        const Point3& p = solid.vertices[v];
        int row = 0;
        for (const Number* x : {&p.x, &p.y, &p.z}) {
            if (!x->is_constant())
                for (int k = 0; k < dimensions; ++k) out[static_cast<std::size_t>(k)](row, v) = gradients(k, x->node);
            ++row;
        }
    }
    return out;
}

RecordedVertices recorded_vertices(const Drawing& drawing, const Solid& solid) {
    RecordedVertices out{drawing.tape().nodes(), {}};
    for (const Point3& p : solid.vertices) {
        std::array<int, 3>& nodes = out.vertices.emplace_back();
        std::size_t k = 0;
        for (const Number* x : {&p.x, &p.y, &p.z}) {
            nodes[k++] = x->is_constant() ? count_of(out.nodes) : x->node;
            if (x->is_constant()) out.nodes.push_back({expression::Operation::constant, {0, 0, 0}, x->value});
        }
    }
    return out;
}

// Numbers of vertices and triangles, and a hash of the latter.
std::vector<int> fingerprint(const geometry::Mesh& mesh) {
    std::uint64_t hash = 14695981039346656037u;
    for (const auto& triangle : mesh.triangles)
        for (const int v : triangle) hash = (hash ^ static_cast<std::uint64_t>(v)) * 1099511628211u;
    return {static_cast<int>(mesh.vertices.cols()), count_of(mesh.triangles), static_cast<int>(hash & 0x7fffffff),
            static_cast<int>(hash >> 33)};
}

std::string features_of(const Solid& solid, int a, int b) {
    const auto name = [&](int t) {
        const std::string& feature = solid.surfaces[solid.facets[t].surface].feature;
        return feature.empty() ? std::string("a face without a name") : "`" + feature + "`";
    };
    return name(a) == name(b) ? name(a) + " crosses itself" : name(a) + " and " + name(b) + " cross";
}

// Each name once, in the order of the surfaces; that of a face without one is empty.
void name_faces(const Solid& solid, geometry::Mesh& mesh) {
    std::vector<int> name_of_surface;
    for (const Surface& surface : solid.surfaces) {
        const auto known = std::find(mesh.face_names.begin(), mesh.face_names.end(), surface.feature);
        name_of_surface.push_back(static_cast<int>(known - mesh.face_names.begin()));
        if (known == mesh.face_names.end()) mesh.face_names.push_back(surface.feature);
    }
    for (const Facet& facet : solid.facets) mesh.triangle_face.push_back(name_of_surface[facet.surface]);
}

// That lengths are too far apart for a solid of rounded numbers, where they are: what went wrong then has no cause in the part's form.
Errors lengths_too_far_apart(const geometry::Mesh& mesh, const std::string& name) {
    constexpr double most = 1e8, large = 1e3;  // [m]
    double shortest = infinity;
    for (const geometry::Edge& edge : mesh.edges)
        shortest = std::min(shortest, (mesh.vertices.col(edge[0]) - mesh.vertices.col(edge[1])).norm());
    const double size = geometry::box_sides(mesh.vertices).maxCoeff();
    if (!(size > large && size > most * shortest)) return {};
    const auto millimetres = [](double x) { return base::formatted("%.3g mm", 1e3 * x); };
    return {{ErrorCode::mesh_invalid, name,
             "`" + name + "` would be " + millimetres(size) + " in size, with edges of " + millimetres(shortest) +
                 ": lengths so far apart make no solid; is one of its dimensions meant in another unit?"}};
}

}  // namespace

Result<DrawnPart> drawn(const Drawing& drawing, const Solid& solid, const std::string& name, const DrawnOptions& options) {
    if (solid.triangles.empty()) return Error{ErrorCode::mesh_invalid, name, "`" + name + "` is empty: nothing of it is left"};
    DrawnPart part;
    Matrix3X vertices(3, solid.vertices.size());
    for (std::size_t v = 0; v < solid.vertices.size(); ++v) vertices.col(v) = value(solid.vertices[v]);
    part.mesh = geometry::make_mesh(name, std::move(vertices), solid.triangles);
    if (options.check) {
        const auto crossing = [&] { return solids::self_intersections(part.mesh, 5); };
        Errors faults = solids::validate_mesh(part.mesh, {true, false});
        if (faults.empty())
            for (const auto& [a, b] : crossing()) {
                const Vector3 p = part.mesh.vertices.col(part.mesh.triangles[a][0]);
                faults.push_back({ErrorCode::mesh_invalid, name, features_of(solid, a, b) + " near " + place(p)});
                if (faults.size() > 1 && faults.back().message.substr(0, faults.back().message.find(" near")) ==
                                             faults[faults.size() - 2].message.substr(0, faults[faults.size() - 2].message.find(" near")))
                    faults.pop_back();
            }
        if (!faults.empty()) {
            const Errors cause = lengths_too_far_apart(part.mesh, name);
            return cause.empty() ? faults : cause;
        }
    }
    if (options.jacobian) part.jacobian = jacobian_of(drawing, solid);
    if (options.record) part.recorded = recorded_vertices(drawing, solid);
    for (const Surface& surface : solid.surfaces) part.surfaces.push_back(drawn_surface(surface));
    part.facets = solid.facets;
    name_faces(solid, part.mesh);
    part.deviation = solid.deviation;
    // Vertices are rounded, and the formulas that lead to them are some tens of operations long.
    const double rounding = usual_rounding(part.mesh.vertices.cwiseAbs().maxCoeff()) + solid.rounding;
    part.deviation.out += rounding;
    part.deviation.in += rounding;
    part.structure = drawing.structure();
    part.changes = drawing.changes();
    part.other_counts = drawing.other_counts();
    // Whatever was decided on the way: are the triangles those of before?
    const Decision triangles{"triangles", fingerprint(part.mesh)};
    const auto& kept = drawing.kept().decisions;
    if (part.changes.empty() && !kept.empty() && kept.back().what == triangles.what && kept.back().numbers != triangles.numbers)
        part.changes.push_back("the triangles are not those of before");
    part.structure.decisions.push_back(triangles);
    return part;
}

}  // namespace fettle::core::parts
