// SPDX-License-Identifier: MIT
#include "fettle/core/parts/solid_booleans.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "fettle/core/geometry/box_sweep.hpp"
#include "fettle/core/geometry/overlapping_boxes.hpp"
#include "fettle/core/geometry/predicates.hpp"
#include "fettle/core/parts/solid_cut.hpp"
#include "fettle/core/solids/point_in_solid.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Mesh;
using Kind = VertexOrigin::Kind;
using Corners = std::array<Vector3, 3>;

// Its first feature that is not the flat end of another.
std::string name_of(const Solid& solid) {
    const auto is_end = [&](const std::string& feature) {
        return std::any_of(solid.surfaces.begin(), solid.surfaces.end(),
                           [&](const Surface& other) { return !other.feature.empty() && end_of_feature(other.feature) == feature; });
    };
    for (const Surface& surface : solid.surfaces)
        if (!surface.feature.empty() && !is_end(surface.feature)) return "`" + surface.feature + "`";
    return "a solid";
}

Mesh plain_mesh(const Solid& solid) {
    Matrix3X vertices(3, solid.vertices.size());
    for (std::size_t v = 0; v < solid.vertices.size(); ++v) vertices.col(v) = value(solid.vertices[v]);
    return geometry::make_mesh({}, std::move(vertices), solid.triangles);
}

Corners corners_of(const Mesh& mesh, int triangle) {
    const auto& t = mesh.triangles[triangle];
    return {Vector3(mesh.vertices.col(t[0])), Vector3(mesh.vertices.col(t[1])), Vector3(mesh.vertices.col(t[2]))};
}

// Which sides of each of two triangles meet the other: six bits; 0 if they have no point in common.
int meeting_sides(const Corners& a, const Corners& b) {
    int bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (geometry::segment_intersects_triangle(a[k], a[(k + 1) % 3], b)) bits |= 1 << k;
        if (geometry::segment_intersects_triangle(b[k], b[(k + 1) % 3], a)) bits |= 8 << k;
    }
    return bits;
}

// All that decides how two meshes cut each other, but for where: which sides go through which triangles, and which shells that do not meet
// the other mesh are inside of it.
std::vector<int> situation_of(const Mesh& a, const Mesh& b) {
    const int count_a = count_of(a.triangles);
    std::vector<geometry::Box> boxes;
    for (const Mesh* mesh : {&a, &b}) {
        for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
            const Corners c = corners_of(*mesh, static_cast<int>(t));
            boxes.push_back({c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])});
        }
    }
    const auto pairs = geometry::overlapping_pairs(boxes, [&](int i, int j) {
        return i < count_a && j >= count_a && meeting_sides(corners_of(a, i), corners_of(b, j - count_a)) != 0;
    });
    std::vector<int> out{count_of(pairs)};
    std::vector<char> met_a(a.shell_names.size(), 0), met_b(b.shell_names.size(), 0);
    for (const auto& [i, j] : pairs) {
        out.insert(out.end(), {i, j - count_a, meeting_sides(corners_of(a, i), corners_of(b, j - count_a))});
        met_a[a.triangle_shell[i]] = 1;
        met_b[b.triangle_shell[j - count_a]] = 1;
    }
    const auto add_shells = [&](const Mesh& mesh, const std::vector<char>& met, const Mesh& other) {
        std::vector<char> done(met);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto shell = static_cast<std::size_t>(mesh.triangle_shell[t]);
            if (done[shell]) continue;
            done[shell] = 1;
            out.push_back(solids::point_in_solid(mesh.vertices.col(mesh.triangles[t][0]), other.vertices, other.triangles) ? 1 : 0);
        }
    };
    add_shells(a, met_a, b);
    add_shells(b, met_b, a);
    return out;
}

// Of meshes that do not meet: whole shells.
SolidCut shells_of(const Mesh& a, const Mesh& b, Combination combination) {
    SolidCut cut;
    const auto add = [&](const Mesh& mesh, const Mesh& other, bool of_a) {
        std::map<int, bool> is_kept;
        std::map<int, int> index;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const int shell = mesh.triangle_shell[t];
            if (!is_kept.contains(shell)) {
                const bool inside = solids::point_in_solid(mesh.vertices.col(mesh.triangles[t][0]), other.vertices, other.triangles);
                is_kept[shell] = inside == (combination == Combination::intersect || (combination == Combination::subtract && !of_a));
            }
            if (!is_kept[shell]) continue;
            CutTriangle out{{}, of_a, static_cast<int>(t)};
            for (std::size_t k = 0; k < 3; ++k) {
                const int v = mesh.triangles[t][k];
                const auto [place, is_new] = index.emplace(v, count_of(cut.vertices));
                if (is_new) cut.vertices.push_back({of_a ? Kind::vertex_of_a : Kind::vertex_of_b, v, v, 0});
                out.corners[k] = place->second;
            }
            if (combination == Combination::subtract && !of_a) std::swap(out.corners[1], out.corners[2]);
            cut.triangles.push_back(out);
        }
    };
    add(a, b, true);
    add(b, a, false);
    return cut;
}

void pack(const SolidCut& cut, std::vector<int>& out) {
    out.push_back(count_of(cut.vertices));
    for (const VertexOrigin& v : cut.vertices) out.insert(out.end(), {static_cast<int>(v.kind), v.from, v.to, v.triangle, v.side});
    for (const CutTriangle& t : cut.triangles)
        out.insert(out.end(), {t.corners[0], t.corners[1], t.corners[2], t.of_a ? 1 : 0, t.triangle});
}

// Nothing: the numbers are no cut of meshes of these sizes.
std::optional<SolidCut> unpacked(const std::vector<int>& numbers, std::size_t first, const Mesh& a, const Mesh& b) {
    SolidCut cut;
    if (first >= numbers.size() || numbers[first] < 0) return std::nullopt;
    const auto count = static_cast<std::size_t>(numbers[first]);
    std::size_t k = first + 1;
    if (k + 5 * count > numbers.size() || (numbers.size() - k - 5 * count) % 5 != 0) return std::nullopt;
    const auto within = [](int i, auto size) { return i >= 0 && i < static_cast<int>(size); };
    for (std::size_t v = 0; v < count; ++v, k += 5) {
        if (!within(numbers[k], 4) || !within(numbers[k + 4] + 1, 4)) return std::nullopt;
        const VertexOrigin origin{static_cast<Kind>(numbers[k]), numbers[k + 1], numbers[k + 2], numbers[k + 3], numbers[k + 4]};
        const bool of_a = origin.kind == Kind::vertex_of_a || origin.kind == Kind::edge_of_a;
        const Mesh &mesh = of_a ? a : b, &other = of_a ? b : a;
        if (!within(origin.from, mesh.vertices.cols()) || !within(origin.to, mesh.vertices.cols()) ||
            !within(origin.triangle, other.triangles.size()))
            return std::nullopt;
        cut.vertices.push_back(origin);
    }
    for (; k < numbers.size(); k += 5) {
        const bool of_a = numbers[k + 3] != 0;
        const CutTriangle triangle{{numbers[k], numbers[k + 1], numbers[k + 2]}, of_a, numbers[k + 4]};
        for (const int corner : triangle.corners)
            if (!within(corner, count)) return std::nullopt;
        if (!within(triangle.triangle, (of_a ? a : b).triangles.size())) return std::nullopt;
        cut.triangles.push_back(triangle);
    }
    return cut;
}

// The point where the line through p and q goes through the plane through a.
Point3 crossing(const Point3& p, const Point3& q, const Point3& a, const Point3& normal) {
    const Point3 way = q - p;
    return p + (dot(normal, a - p) / dot(normal, way)) * way;
}

std::vector<Point3> vertices_of(const SolidCut& cut, const Solid& a, const Solid& b) {
    std::vector<Point3> out;
    for (const VertexOrigin& origin : cut.vertices) {
        const bool of_a = origin.kind == Kind::vertex_of_a || origin.kind == Kind::edge_of_a;
        const Solid &solid = of_a ? a : b, &other = of_a ? b : a;
        const Point3& from = solid.vertices[origin.from];
        if (origin.kind == Kind::vertex_of_a || origin.kind == Kind::vertex_of_b) {
            out.push_back(from);
            continue;
        }
        const auto& t = other.triangles[origin.triangle];
        const auto corner = [&](std::size_t k) -> const Point3& { return other.vertices[t[k]]; };
        const Point3& to = solid.vertices[origin.to];
        const Point3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        if (origin.side < 0) {
            out.push_back(crossing(from, to, corner(0), normal));
        } else {  // through the plane that stands upright on the side
            const auto side = static_cast<std::size_t>(origin.side);
            out.push_back(crossing(from, to, corner(side), cross(corner((side + 1) % 3) - corner(side), normal)));
        }
    }
    return out;
}

Solid frozen(const Mesh& mesh) {
    Solid out;
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) out.vertices.push_back(constant(Vector3(mesh.vertices.col(v))));
    out.triangles = mesh.triangles;
    return out;
}

Vector3 normal_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

// Does every triangle of a kept cut still face the way of the one that it is a part of?
bool faces_the_same_way(const SolidCut& cut, const Mesh& a, const Mesh& b, Combination combination) {
    const auto vertices = vertices_of(cut, frozen(a), frozen(b));
    for (const CutTriangle& t : cut.triangles) {
        Corners c;
        for (std::size_t k = 0; k < 3; ++k) c[k] = value(vertices[t.corners[k]]);
        const double sign = combination == Combination::subtract && !t.of_a ? -1 : 1;
        if (!(sign * normal_of(c).dot(normal_of(corners_of(t.of_a ? a : b, t.triangle))) > 0)) return false;
    }
    return true;
}

// Where faces of the two meet, their deviations are drawn out by the angle between them: bands of half-width r about two planes at the
// angle phi have a rhombus in common that reaches r / sin(phi / 2) and r / cos(phi / 2) far.
double drawn_out(const SolidCut& cut, const std::vector<Point3>& vertices) {
    std::map<std::pair<int, int>, std::size_t> sides;
    for (std::size_t t = 0; t < cut.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) sides[{cut.triangles[t].corners[k], cut.triangles[t].corners[(k + 1) % 3]}] = t;
    const auto normal = [&](const CutTriangle& t) {
        Corners c;
        for (std::size_t k = 0; k < 3; ++k) c[k] = value(vertices[t.corners[k]]);
        return Vector3(normal_of(c).normalized());
    };
    double factor = 1;
    for (const auto& [side, t] : sides) {
        if (side.first > side.second) continue;
        const auto back = sides.find({side.second, side.first});
        if (back == sides.end()) continue;
        const CutTriangle &one = cut.triangles[t], &other = cut.triangles[back->second];
        if (one.of_a == other.of_a) continue;
        const double cosine = std::clamp(normal(one).dot(normal(other)), -1.0, 1.0);
        const double half = std::acos(std::abs(cosine)) / 2;  // of the angle between the planes, at most a right one: sin <= cos
        factor = std::max(factor, 1 / std::max(std::sin(half), 1e-3));
    }
    return factor;
}

// Sine of the least angle at which an edge goes through a face: an error of the corners is so much larger where they meet.
double least_steepness(const SolidCut& cut, const Mesh& a, const Mesh& b) {
    double least = 1;
    for (const VertexOrigin& origin : cut.vertices) {
        if (origin.kind == Kind::vertex_of_a || origin.kind == Kind::vertex_of_b || origin.side >= 0) continue;
        const bool of_a = origin.kind == Kind::edge_of_a;
        const Mesh &mesh = of_a ? a : b, &other = of_a ? b : a;
        const Vector3 way = mesh.vertices.col(origin.to) - mesh.vertices.col(origin.from);
        least = std::min(least, std::abs(normal_of(corners_of(other, origin.triangle)).normalized().dot(way.normalized())));
    }
    return least;
}

Deviation combined_deviation(const Deviation& a, const Deviation& b, Combination combination, double factor) {
    Deviation out;
    if (combination == Combination::unite) {
        out = a;
        out.add(b);
        return out;
    }
    // Cut away, what is beyond the tool's mesh is missing from the part, and what the mesh has too much of is left.
    const bool subtract = combination == Combination::subtract;
    const double b_out = subtract ? b.in : b.out, b_in = subtract ? b.out : b.in;
    const bool b_out_is_proven = subtract ? b.in_is_proven : b.out_is_proven, b_in_is_proven = subtract ? b.out_is_proven : b.in_is_proven;
    const auto combined = [&](double x, double y, bool x_is_proven, bool y_is_proven, double& bound, bool& is_proven) {
        bound = std::max(x, y) > 0 ? factor * std::max(x, y) : 0;
        is_proven = bound == 0 && x_is_proven && y_is_proven;
    };
    combined(a.out, b_out, a.out_is_proven, b_out_is_proven, out.out, out.out_is_proven);
    combined(a.in, b_in, a.in_is_proven, b_in_is_proven, out.in, out.in_is_proven);
    return out;
}

Result<Solid> combined(Drawing& drawing, const Solid& a, const Solid& b, Combination combination) {
    const Mesh mesh_a = plain_mesh(a), mesh_b = plain_mesh(b);
    const std::vector<int> situation = situation_of(mesh_a, mesh_b);
    const std::string names = name_of(a) + " and " + name_of(b);
    Errors errors;
    const auto numbers = drawing.decision(
        "cut of " + names,
        [&](const std::vector<int>& kept) {
            if (kept.size() <= situation.size() || !std::equal(situation.begin(), situation.end(), kept.begin())) return false;
            const auto cut = unpacked(kept, situation.size(), mesh_a, mesh_b);
            return cut && faces_the_same_way(*cut, mesh_a, mesh_b, combination);
        },
        [&] {
            std::vector<int> out = situation;
            if (situation.front() == 0) {
                pack(shells_of(mesh_a, mesh_b, combination), out);
                return out;
            }
            auto cut = cut_solids(mesh_a, mesh_b, combination);
            if (cut)
                pack(*cut, out);
            else
                errors = cut.errors();
            return out;
        });
    for (Error& error : errors) {
        error.where = names;
        error.message = names + ": " + error.message;
    }
    if (!errors.empty()) return errors;
    const auto cut = unpacked(numbers, situation.size(), mesh_a, mesh_b);
    FETTLE_ASSERT(cut.has_value(), "a cut is of its two meshes");
    if (cut->triangles.empty())
        return Error{ErrorCode::mesh_invalid, names,
                     combination == Combination::subtract ? "nothing is left of " + name_of(a) + " when " + name_of(b) + " is cut away"
                                                          : names + " have nothing in common"};
    Solid out;
    out.vertices = vertices_of(*cut, a, b);
    out.surfaces = a.surfaces;
    const bool subtract = combination == Combination::subtract;
    for (Surface surface : b.surfaces) {
        if (subtract) {
            surface.hollow = !surface.hollow;
            if (surface.kind == SurfaceKind::plane)
                for (Number& x : surface.axis) x = -x;
        }
        out.surfaces.push_back(std::move(surface));
    }
    const int first_of_b = count_of(a.surfaces);
    for (const CutTriangle& t : cut->triangles) {
        out.triangles.push_back(t.corners);
        Facet facet = (t.of_a ? a : b).facets[t.triangle];
        if (!t.of_a) {
            facet.surface += first_of_b;
            if (subtract && facet.side == Side::outside)
                facet.side = Side::inside;
            else if (subtract && facet.side == Side::inside)
                facet.side = Side::outside;
        }
        out.facets.push_back(facet);
    }
    const double largest = std::max(mesh_a.vertices.cwiseAbs().maxCoeff(), mesh_b.vertices.cwiseAbs().maxCoeff());
    const double steepness = least_steepness(*cut, mesh_a, mesh_b), of_corners = std::max(a.rounding, b.rounding);
    out.rounding = steepness < 1 ? (usual_rounding(largest) + of_corners) / std::max(steepness, 1e-300) : of_corners;
    out.deviation = combined_deviation(a.deviation, b.deviation, combination, drawn_out(*cut, out.vertices));
    return out;
}

}  // namespace

bool has_solid_booleans() { return can_cut_solids(); }

Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::unite); }

Result<Solid> united(Drawing& drawing, const std::vector<Solid>& solids) {
    if (solids.empty()) return Error{ErrorCode::inconsistent, {}, "a union of no solids is empty"};
    Solid out = solids.front();
    for (std::size_t k = 1; k < solids.size(); ++k) {
        auto next = united(drawing, out, solids[k]);
        if (!next) return next;
        out = std::move(*next);
    }
    return out;
}

Result<Solid> difference(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::subtract); }
Result<Solid> intersection(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::intersect); }

}  // namespace fettle::core::parts
