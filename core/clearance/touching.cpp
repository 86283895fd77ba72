// SPDX-License-Identifier: MIT
#include "core/clearance/touching.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/certificate/disjoint_solids.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/solids/self_intersection.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::clearance {
namespace {

constexpr double touch_share = 1e-5;    // of the larger body's size
constexpr int most_sweeps = 60;         // of the solution below
constexpr long most_looks = 4'000'000;  // at pairs of pieces

// The shortest d with n . d >= 1 for all of these unit normals, if there is one (Hildreth); close enough to it.
Vector3 common_direction(const std::vector<Vector3>& normals) {
    std::vector<double> weights(normals.size(), 0.0);
    Vector3 d = Vector3::Zero();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double most = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const double change = std::max(-weights[i], 1 - normals[i].dot(d));
            weights[i] += change;
            d += change * normals[i];
            most = std::max(most, std::abs(change));
        }
        if (most < 1e-3) break;
    }
    return d;
}

// Each vertex moved inwards by at most `by`, faces by half of that where the corners are not too sharp.
geometry::Mesh thinner(const geometry::Mesh& mesh, double by) {
    geometry::Mesh out = mesh;
    const double outwards = geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3) < 0 ? -1 : 1;
    std::vector<std::vector<Vector3>> normals(mesh.vertices.cols());
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vector3 a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]);
        const Vector3 n = outwards * (b - a).cross(c - a);
        if (!(n.norm() > 0)) continue;
        for (const int v : t) {
            auto& list = normals[v];
            const Vector3 unit = n.normalized();
            if (std::none_of(list.begin(), list.end(), [&](const Vector3& other) { return other.dot(unit) > 1 - 1e-9; }))
                list.push_back(unit);
        }
    }
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (normals[v].empty()) continue;
        const Vector3 d = common_direction(normals[v]);
        const double length = d.norm();
        if (!(length > 0)) continue;
        out.vertices.col(v) -= std::min(0.5 * by, by / length) * d;
    }
    return out;
}

std::optional<double> apart_if_thinner(const PairMotion& pair, bool is_a, const certificate::PairStart& start, double depth,
                                       SearchOptions search) {
    const PieceTree& whole = is_a ? pair.a : pair.b;
    const double by = 0.5 * depth * (1 - 1e-6);
    const geometry::Mesh mesh = thinner(*whole.mesh, by);
    const geometry::BodyHierarchy hierarchy(mesh);
    const PieceTree tree = make_piece_tree(mesh, hierarchy);
    const certificate::SolidMesh solid = certificate::solid_mesh(mesh);
    PairMotion thin{is_a ? tree : pair.a,        is_a ? pair.b : tree,       pair.trajectory, {},
                    is_a ? solid : pair.solid_a, is_a ? pair.solid_b : solid};
    for (const PairSegment& segment : pair.segments) {
        thin.segments.push_back(pair_segment(*segment.a, *segment.b, thin.a.radius(), thin.b.radius()));
        thin.segments.back().step = segment.step;
        thin.segments.back().segment = segment.segment;
    }
    search.tolerance = by / 32;
    search.enough = by / 8;
    search.refuted = 1e-6 * by;
    search.exact_witness = search.sample_nodes = search.nodes_only = false;
    search.seed.reset();
    const SearchResult found = search_pair(thin.a, thin.b, thin.segments, search);
    if (found.intersecting || !(found.lower > 0)) return std::nullopt;
    if (!certificate::are_apart(certificate::solids_of(thin.solid_a, thin.solid_b, start, found.lower))) return std::nullopt;
    return found.lower;
}

// What a place of bodies and of their frames needs, at one instant.
struct Looked {
    const PairMotion& pair;
    Instant at;
    double depth = 0;

    Vector3 of_a(const Vector3& X) const { return at.rotation_a * X + at.offset; }
    Vector3 of_b(const Vector3& X) const { return at.rotation_b * X; }

    bool are_near(const Piece& a, const Piece& b) const {
        const Vector3 d = of_a(a.center) - of_b(b.center);
        const Vector3 half_a = (at.rotation_a * a.axes).cwiseAbs() * a.half_extent,
                      half_b = (at.rotation_b * b.axes).cwiseAbs() * b.half_extent;
        return ((d.cwiseAbs() - half_a - half_b).array() <= 2 * depth).all();
    }
};

using Polygon = std::vector<Vector3>;

// The part of it on the inner side of the plane through a, b along the normal n.
Polygon clipped(const Polygon& polygon, const Vector3& a, const Vector3& b, const Vector3& n) {
    const Vector3 inwards = n.cross(b - a);
    Polygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = inwards.dot(p - a), at_q = inwards.dot(q - a);
        if (at_p >= 0) out.push_back(p);
        if ((at_p < 0) != (at_q < 0)) out.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    return out;
}

double common_area(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b, double depth) {
    const Vector3 across_a = (a[1] - a[0]).cross(a[2] - a[0]), across_b = (b[1] - b[0]).cross(b[2] - b[0]);
    if (!(across_a.dot(across_b) < 0)) return 0;
    const Vector3 n = across_a.normalized();
    Polygon common{b[2], b[1], b[0]};
    for (int i = 0; i < 3 && !common.empty(); ++i) common = clipped(common, a[i], a[(i + 1) % 3], n);
    if (common.size() < 3) return 0;
    if (std::any_of(common.begin(), common.end(), [&](const Vector3& x) { return std::abs(n.dot(x - a[0])) > depth; })) return 0;
    Vector3 area = Vector3::Zero();
    for (std::size_t i = 2; i < common.size(); ++i) area += (common[i - 1] - common[0]).cross(common[i] - common[0]);
    return 0.5 * area.norm();
}

}  // namespace

bool winds_once(const geometry::Mesh& mesh) {
    if (!solids::self_intersections(mesh, 1).empty()) return false;
    const std::vector<solids::Shell> shells = solids::shells_of(mesh);
    const auto are_turned = [&](int outwards) {
        return std::all_of(shells.begin(), shells.end(),
                           [&](const solids::Shell& shell) { return shell.volume_sign == (shell.depth % 2 == 0 ? outwards : -outwards); });
    };
    return are_turned(1) || are_turned(-1);
}

double default_touch_depth(const geometry::Mesh& a, const geometry::Mesh& b) {
    const auto size = [](const Matrix3X& x) { return geometry::box_sides(x).norm(); };
    return touch_share * std::max(size(a.vertices), size(b.vertices));
}

double default_touch_depth(const PairMotion& pair) { return default_touch_depth(*pair.a.mesh, *pair.b.mesh); }

std::optional<double> proven_touch(const PairMotion& pair, const certificate::PairStart& start, double depth, const SearchOptions& search) {
    std::array<bool, 2> order{true, false};  // the simpler one first
    if (pair.b.elements.size() < pair.a.elements.size()) std::swap(order[0], order[1]);
    for (const bool is_a : order) {
        const certificate::SolidMesh& solid = is_a ? pair.solid_a : pair.solid_b;
        if (!solid.is_closed || solid.shells.empty() || !winds_once(*(is_a ? pair.a : pair.b).mesh)) continue;
        if (const auto room = apart_if_thinner(pair, is_a, start, depth, search)) return room;
    }
    return std::nullopt;
}

TouchingArea touching_area(const PairMotion& pair, int segment, double s, double depth) {
    const Looked looked{pair, instant_at(pair.segments[segment], s), depth};
    TouchingArea found;
    long looks = 0;
    std::vector<std::pair<int, int>> open{{0, 0}};
    while (!open.empty()) {
        if (++looks > most_looks) {
            found.is_whole = false;
            break;
        }
        const auto [i, j] = open.back();
        open.pop_back();
        const Piece &a = pair.a.pieces[i], &b = pair.b.pieces[j];
        if (!looked.are_near(a, b)) continue;
        if (!a.is_element() && (b.is_element() || a.size >= b.size)) {
            open.emplace_back(a.left, j);
            open.emplace_back(a.right, j);
        } else if (!b.is_element()) {
            open.emplace_back(i, b.left);
            open.emplace_back(i, b.right);
        } else {
            const auto &x = pair.a.elements[a.first], &y = pair.b.elements[b.first];
            if (x.vertices[2] < 0 || y.vertices[2] < 0) continue;
            std::array<Vector3, 3> of_a, of_b;
            for (std::size_t k = 0; k < 3; ++k) {
                of_a[k] = looked.of_a(pair.a.mesh->vertices.col(x.vertices[k]));
                of_b[k] = looked.of_b(pair.b.mesh->vertices.col(y.vertices[k]));
            }
            found.area += common_area(of_a, of_b, depth);
        }
    }
    return found;
}

}  // namespace fettle::core::clearance
