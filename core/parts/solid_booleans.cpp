// SPDX-License-Identifier: MIT
#include "core/parts/solid_booleans.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/parts/aligned_solids.hpp"
#include "core/parts/cut_situation.hpp"
#include "core/parts/merged_faces.hpp"
#include "core/parts/short_edges.hpp"
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {
namespace {

using geometry::Mesh;
using Kind = VertexOrigin::Kind;
using Corners = TriangleCorners;

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

std::vector<Vector3> points_of(const SolidCut& cut, const Mesh& a, const Mesh& b) {
    std::vector<Vector3> out;
    for (const Point3& p : vertices_of(cut, frozen(a), frozen(b))) out.push_back(value(p));
    return out;
}

Vector3 normal_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

// Does every triangle of a kept cut still face the way of the one that it is a part of?
bool faces_the_same_way(const SolidCut& cut, const Mesh& a, const Mesh& b, Combination combination) {
    const std::vector<Vector3> points = points_of(cut, a, b);
    for (const CutTriangle& t : cut.triangles) {
        Corners c;
        for (std::size_t k = 0; k < 3; ++k) c[k] = points[t.corners[k]];
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

// Sine of the angle at which a corner's edge goes through its face: an error of the corners is so much larger where they meet. 1
// where the corner is one of the two's own.
double steepness_of(const VertexOrigin& origin, const Mesh& a, const Mesh& b) {
    if (origin.kind == Kind::vertex_of_a || origin.kind == Kind::vertex_of_b || origin.side >= 0) return 1;
    const bool of_a = origin.kind == Kind::edge_of_a;
    const Mesh &mesh = of_a ? a : b, &other = of_a ? b : a;
    const Vector3 way = mesh.vertices.col(origin.to) - mesh.vertices.col(origin.from);
    return std::abs(normal_of(corners_of(other, origin.triangle)).normalized().dot(way.normalized()));
}

double least_steepness(const SolidCut& cut, const Mesh& a, const Mesh& b) {
    double least = 1;
    for (const VertexOrigin& origin : cut.vertices) least = std::min(least, steepness_of(origin, a, b));
    return least;
}

// How well each corner's place is known: those that one of the two has are known best.
std::vector<double> worth_of(const SolidCut& cut, const Mesh& a, const Mesh& b) {
    std::vector<double> out;
    for (const VertexOrigin& origin : cut.vertices)
        out.push_back(origin.kind == Kind::vertex_of_a || origin.kind == Kind::vertex_of_b ? 2 : steepness_of(origin, a, b));
    return out;
}

Deviation combined_deviation(const Deviation& a, const Deviation& b, Combination combination, double factor) {
    Deviation out;
    if (combination == Combination::unite) {
        out = a;
        out.add(b);
        return out;
    }
    // In a subtraction, the tool's material beyond its mesh is missing from the part, and the mesh's excess over the tool is left.
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

// Flat surfaces are one face each.
FacedMesh faced(const Solid& solid) {
    FacedMesh out{plain_mesh(solid), {}};
    for (const Facet& facet : solid.facets)
        out.face.push_back(solid.surfaces[facet.surface].kind == SurfaceKind::plane ? facet.surface : -1);
    return out;
}

double largest_coordinate(const Mesh& a, const Mesh& b) {
    return std::max(a.vertices.cwiseAbs().maxCoeff(), b.vertices.cwiseAbs().maxCoeff());
}

// Vertices, faces and deviation of a combination.
Solid put_together(const SolidCut& cut, const Solid& a, const Solid& b, Combination combination) {
    Solid out;
    out.vertices = vertices_of(cut, a, b);
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
    for (const CutTriangle& t : cut.triangles) {
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
    out.deviation = combined_deviation(a.deviation, b.deviation, combination, drawn_out(cut, out.vertices));
    return out;
}

std::optional<Error> unusable(const Solid& solid) {
    for (const Point3& p : solid.vertices)
        if (!value(p).allFinite()) return Error{ErrorCode::not_finite, name_of(solid), name_of(solid) + " has corners that are not finite"};
    return std::nullopt;
}

Result<Solid> combined(Drawing& drawing, Solid a, Solid b, Combination combination) {
    for (const Solid* solid : {&a, &b})
        if (auto error = unusable(*solid)) return *error;
    align(a, b);
    const FacedMesh faced_a = faced(a), faced_b = faced(b);
    const Mesh &mesh_a = faced_a.mesh, &mesh_b = faced_b.mesh;
    const std::string names = name_of(a) + " and " + name_of(b);
    const double rounding = 4 * usual_rounding(largest_coordinate(mesh_a, mesh_b));
    std::vector<int> situation = situation_of(mesh_a, mesh_b);
    const bool apart = situation.front() == 0 && !(can_cut_solids() && touch(mesh_a, mesh_b, rounding));
    situation.push_back(apart ? 1 : 0);
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
            if (apart) {
                pack(shells_of(mesh_a, mesh_b, combination), out);
                return out;
            }
            auto cut = cut_solids(faced_a, faced_b, rounding, combination);
            if (cut) {
                const std::vector<double> worth = worth_of(*cut, mesh_a, mesh_b);
                cut = without_short_edges(*std::move(cut), worth, rounding);
                const std::vector<Vector3> points = points_of(*cut, mesh_a, mesh_b);
                const bool are_known = std::all_of(points.begin(), points.end(), [](const Vector3& p) { return p.allFinite(); });
                pack(are_known ? with_merged_faces(std::move(*cut), faced_a.face, faced_b.face, points, rounding) : *cut, out);
            } else {
                errors = cut.errors();
            }
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
    Solid out = put_together(*cut, a, b, combination);
    if (unusable(out))
        return Error{ErrorCode::mesh_invalid, names,
                     names + " cut each other at so small an angle that where is lost to rounding: make them flush, or steeper"};
    const double steepness = least_steepness(*cut, mesh_a, mesh_b), of_corners = std::max(a.rounding, b.rounding);
    out.rounding = steepness < 1 ? (rounding / 4 + of_corners) / std::max(steepness, 1e-300) : of_corners;
    return out;
}

}  // namespace

bool has_solid_booleans() { return can_cut_solids(); }

Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::unite); }
Result<Solid> difference(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::subtract); }
Result<Solid> intersection(Drawing& drawing, const Solid& a, const Solid& b) { return combined(drawing, a, b, Combination::intersect); }

namespace {

// The result does not depend on the order, but what stands in between does, and may be no solid: the cut is then tried later.
bool may_work_later(const Errors& errors) { return can_cut_solids() && errors.size() == 1 && errors[0].code == ErrorCode::unsupported; }

Result<Solid> one_after_another(Drawing& drawing, Solid out, std::vector<Solid> others, Combination combination) {
    while (!others.empty()) {
        std::vector<Solid> left;
        Errors refused;
        for (Solid& other : others) {
            auto next = combined(drawing, out, other, combination);
            if (next) {
                out = std::move(*next);
            } else if (may_work_later(next.errors())) {
                if (left.empty()) refused = next.errors();
                left.push_back(std::move(other));
            } else {
                return next;
            }
        }
        if (left.size() == others.size()) return refused;
        others = std::move(left);
    }
    return out;
}

}  // namespace

// Neighbours first, then what they became: each is looked at as often as the number can be halved.
Result<Solid> united(Drawing& drawing, const std::vector<Solid>& solids) {
    if (solids.empty()) return Error{ErrorCode::inconsistent, {}, "a union of no solids is empty"};
    std::vector<Solid> left = solids;
    for (bool goes_on = true; goes_on && left.size() > 1;) {
        goes_on = false;
        std::vector<Solid> next;
        for (std::size_t k = 0; k < left.size(); k += 2) {
            if (k + 1 == left.size()) {
                next.push_back(std::move(left[k]));
                break;
            }
            auto both = united(drawing, left[k], left[k + 1]);
            if (both) {
                next.push_back(std::move(*both));
                goes_on = true;
            } else if (may_work_later(both.errors())) {
                next.push_back(std::move(left[k]));
                next.push_back(std::move(left[k + 1]));
            } else {
                return both;
            }
        }
        left = std::move(next);
    }
    Solid first = std::move(left.front());
    left.erase(left.begin());
    return one_after_another(drawing, std::move(first), std::move(left), Combination::unite);
}

Result<Solid> difference(Drawing& drawing, const Solid& a, const std::vector<Solid>& cut) {
    return one_after_another(drawing, a, cut, Combination::subtract);
}

Result<Solid> intersection(Drawing& drawing, const std::vector<Solid>& solids) {
    if (solids.empty()) return Error{ErrorCode::inconsistent, {}, "an intersection of no solids is nothing"};
    return one_after_another(drawing, solids.front(), {solids.begin() + 1, solids.end()}, Combination::intersect);
}

}  // namespace fettle::core::parts
