// SPDX-License-Identifier: MIT
#include "core/solids/mesh_validity.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/contract.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::solids {
namespace {

using Corners = std::array<Vector3, 3>;

/// Beyond this many intersecting pairs the message says "at least".
constexpr int counted_intersections = 1000;

Corners corners_of(const Matrix3X& vertices, const geometry::Triangle& t) {
    return {vertices.col(t[0]), vertices.col(t[1]), vertices.col(t[2])};
}

geometry::Box box_of(const Corners& x) { return {x[0].cwiseMin(x[1]).cwiseMin(x[2]), x[0].cwiseMax(x[1]).cwiseMax(x[2])}; }

std::string coordinates(const Vector3& x) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
    return text;
}

std::string edge_text(const geometry::Mesh& mesh, int a, int b) {
    return "from " + coordinates(mesh.vertices.col(a)) + " to " + coordinates(mesh.vertices.col(b));
}

bool in_range(const geometry::Mesh& mesh, const geometry::Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int vertex) { return vertex >= 0 && vertex < mesh.vertices.cols(); });
}

bool all_in_range(const geometry::Mesh& mesh) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const geometry::Triangle& t) { return in_range(mesh, t); });
}

/// Faults of one kind: the first few in full, then how many more there are.
class Faults {
public:
    Faults(const geometry::Mesh& mesh, int max_per_kind, Errors& errors) : mesh_(mesh), max_per_kind_(max_per_kind), errors_(errors) {}

    void add(ErrorCode code, const std::string& where, const std::string& message) {
        if (count_++ < max_per_kind_) errors_.push_back({code, mesh_.name + ": " + where, message});
    }
    /// "and 12 more <what>", after the last of a kind.
    void finish(ErrorCode code, const std::string& what) {
        if (count_ > max_per_kind_) {
            errors_.push_back({code, mesh_.name, "and " + std::to_string(count_ - max_per_kind_) + " more " + what});
        }
        count_ = 0;
    }

private:
    const geometry::Mesh& mesh_;
    int max_per_kind_;
    int count_ = 0;
    Errors& errors_;
};

/// Calls visit(first, last) with the half edges of each edge that is not in exactly two triangles, once in each direction.
template <class Visit>
void visit_faulty_edges(const std::vector<geometry::HalfEdge>& halves, const Visit& visit) {
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        if (!geometry::is_sound_edge(halves, first, last)) visit(first, last);
    });
}

void check_numbers(const geometry::Mesh& mesh, Faults& faults) {
    for (int i = 0; i < mesh.vertices.cols(); ++i) {
        if (mesh.vertices.col(i).allFinite()) continue;
        faults.add(ErrorCode::not_finite, "vertex " + std::to_string(i),
                   "coordinates " + coordinates(mesh.vertices.col(i)) + " are not finite; export the mesh again");
    }
    faults.finish(ErrorCode::not_finite, "vertices that are not finite");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (in_range(mesh, mesh.triangles[t])) continue;
        const geometry::Triangle& v = mesh.triangles[t];
        faults.add(ErrorCode::out_of_range, "triangle " + std::to_string(t),
                   "vertex indices " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) +
                       " must be in 0 to " + std::to_string(mesh.vertices.cols() - 1));
    }
    faults.finish(ErrorCode::out_of_range, "triangles with vertex indices out of range");
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        if (in_range(mesh, {mesh.edges[e][0], mesh.edges[e][1], mesh.edges[e][1]})) continue;
        faults.add(ErrorCode::out_of_range, "edge " + std::to_string(e), "vertex indices are out of range");
    }
    faults.finish(ErrorCode::out_of_range, "edges with vertex indices out of range");
}

void check_areas(const geometry::Mesh& mesh, Faults& faults) {
    const std::vector<char> without_area = triangles_without_area(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (without_area[t] == 0) continue;
        const Corners x = corners_of(mesh.vertices, mesh.triangles[t]);
        faults.add(ErrorCode::mesh_invalid, "triangle " + std::to_string(t),
                   "has no area: its corners " + coordinates(x[0]) + ", " + coordinates(x[1]) + ", " + coordinates(x[2]) +
                       " are on one line; remove it and join its neighbours");
    }
    faults.finish(ErrorCode::mesh_invalid, "triangles without area");
}

void describe_faulty_edge(const geometry::Mesh& mesh, const std::vector<geometry::HalfEdge>& halves, std::size_t first, std::size_t last,
                          Faults& faults) {
    const geometry::HalfEdge& half = halves[first];
    const std::string where = "triangle " + std::to_string(half.triangle);
    const std::string edge = "its edge " + edge_text(mesh, half.low, half.high);
    const std::size_t count = last - first;
    if (half.low == half.high) {
        faults.add(ErrorCode::mesh_invalid, where, "has the same vertex twice; remove it");
    } else if (count == 1) {
        faults.add(ErrorCode::mesh_invalid, where, edge + " belongs to no other triangle: the surface is open; close the hole");
    } else if (count == 2) {
        faults.add(ErrorCode::mesh_invalid, where,
                   edge + " runs the same way in triangle " + std::to_string(halves[first + 1].triangle) +
                       ": one of the two is turned over; orient all triangles counter-clockwise seen from outside");
    } else {
        std::string others;
        for (std::size_t i = first + 1; i < last && i < first + 6; ++i)
            others += (i == first + 1 ? "" : ", ") + std::to_string(halves[i].triangle);
        faults.add(ErrorCode::mesh_invalid, where,
                   edge + " is shared with " + std::to_string(count - 1) + " triangles (" + others + (count > 6 ? ", ..." : "") +
                       "), one is allowed: separate the parts that touch there");
    }
}

/// True if every edge is sound.
bool check_closed(const geometry::Mesh& mesh, Faults& faults) {
    bool closed = !mesh.triangles.empty();
    if (!closed) faults.add(ErrorCode::mesh_invalid, "mesh", "has no triangles, so it is not the boundary of a solid");
    const std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    visit_faulty_edges(halves, [&](std::size_t first, std::size_t last) {
        closed = false;
        describe_faulty_edge(mesh, halves, first, last, faults);
    });
    faults.finish(ErrorCode::mesh_invalid, "edges that are not in exactly two triangles, once in each direction");

    for (std::size_t e = std::min(mesh.edges.size(), geometry::count_edges(halves)); e < mesh.edges.size(); ++e) {
        faults.add(ErrorCode::mesh_invalid, "edge " + std::to_string(e),
                   edge_text(mesh, mesh.edges[e][0], mesh.edges[e][1]) + " belongs to no triangle, so not to a solid; remove it");
    }
    faults.finish(ErrorCode::mesh_invalid, "edges without a triangle");
    for (const int vertex : mesh.codimensional_points) {
        faults.add(ErrorCode::mesh_invalid, "vertex " + std::to_string(vertex),
                   "at " + coordinates(mesh.vertices.col(vertex)) + " belongs to no triangle, so not to a solid; remove it");
    }
    faults.finish(ErrorCode::mesh_invalid, "vertices without a triangle");
    return closed;
}

/// True if there are none.
bool check_self_intersections(const geometry::Mesh& mesh, int max_per_kind, Errors& errors) {
    const auto pairs = self_intersections(mesh, std::max(counted_intersections, max_per_kind + 1));
    for (int i = 0; i < std::min(max_per_kind, count_of(pairs)); ++i) {
        const auto [t, u] = pairs[i];
        const geometry::Box a = box_of(corners_of(mesh.vertices, mesh.triangles[t])),
                            b = box_of(corners_of(mesh.vertices, mesh.triangles[u]));
        const Vector3 near = (a.low.cwiseMax(b.low) + a.high.cwiseMin(b.high)) / 2;
        errors.push_back({ErrorCode::mesh_invalid, mesh.name + ": triangle " + std::to_string(t),
                          "intersects triangle " + std::to_string(u) + " of the same mesh near " + coordinates(near) +
                              "; unite overlapping parts, or weld vertices that should be one"});
    }
    const int more = count_of(pairs) - max_per_kind;
    if (more > 0) {
        const std::string count = (count_of(pairs) >= counted_intersections ? "at least " : "") + std::to_string(more);
        errors.push_back({ErrorCode::mesh_invalid, mesh.name, "and " + count + " more pairs of intersecting triangles"});
    }
    return pairs.empty();
}

/// Each shell of a closed mesh without self-intersections: a solid (positive volume) within an even number of others, a cavity
/// (negative volume) within an odd number.
void check_orientation(const geometry::Mesh& mesh, Faults& faults) {
    for (const Shell& shell : shells_of(mesh)) {
        const std::string around = shell.around < 0 ? "" : mesh.shell_names[shell.around];
        const int sign = shell.volume_sign, depth = shell.depth;
        const std::string where = "shell \"" + mesh.shell_names[shell.index] + "\"";
        if (sign == 0) {
            faults.add(ErrorCode::mesh_invalid, where, "encloses no volume");
        } else if (sign < 0 && depth % 2 == 0) {
            faults.add(ErrorCode::mesh_invalid, where,
                       "is inside out: its triangles are clockwise seen from outside; reverse the order of their corners");
        } else if (sign > 0 && depth % 2 == 1) {
            faults.add(ErrorCode::mesh_invalid, where,
                       "is a solid inside the solid \"" + around +
                           "\", so its volume would count twice; for a cavity reverse its triangles, else make it a body of its own");
        }
    }
    faults.finish(ErrorCode::mesh_invalid, "shells that are inside out or empty");
}

}  // namespace

Errors validate_mesh(const geometry::Mesh& mesh, const MeshRequirements& requirements, int max_per_kind) {
    Errors errors = faults_of_numbers(mesh, max_per_kind);
    if (!errors.empty()) return errors;  // nothing else has a meaning
    Faults faults(mesh, max_per_kind, errors);
    check_areas(mesh, faults);
    const bool closed = requirements.closed && check_closed(mesh, faults);
    const bool simple = requirements.no_self_intersection && check_self_intersections(mesh, max_per_kind, errors);
    if (!closed) return errors;
    if (simple) {
        check_orientation(mesh, faults);
    } else if (geometry::volume_sign(mesh.vertices, mesh.triangles) <= 0) {
        // Where shells may cross, which is inside which has no answer: only the sum can be judged.
        faults.add(ErrorCode::mesh_invalid, "mesh", "its volume is not positive: it is inside out, or empty; reverse its triangles");
    }
    return errors;
}

Errors faults_of_numbers(const geometry::Mesh& mesh, int max_per_kind) {
    Errors errors;
    Faults faults(mesh, max_per_kind, errors);
    check_numbers(mesh, faults);
    return errors;
}

bool is_closed(const geometry::Mesh& mesh) { return all_in_range(mesh) && is_closed(geometry::sorted_half_edges(mesh)); }

bool is_closed(const std::vector<geometry::HalfEdge>& halves) {
    bool closed = !halves.empty();
    visit_faulty_edges(halves, [&](std::size_t, std::size_t) { closed = false; });
    return closed;
}

}  // namespace fettle::core::solids
