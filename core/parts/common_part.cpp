// SPDX-License-Identifier: MIT
#include "core/parts/common_part.hpp"

#include <Eigen/Geometry>
#include <numeric>

#include "core/solids/mesh_validity.hpp"

namespace fettle::core::parts {
namespace {

double extent(const geometry::Mesh& mesh) { return geometry::box_sides(mesh.vertices).norm(); }

// Directions that no face of a usual part lies in.
constexpr std::array<std::array<double, 3>, 3> some_directions{{{0.43, 0.71, 0.56}, {-0.77, 0.37, 0.52}, {0.29, -0.61, 0.74}}};

struct Box {
    Vector3 low, high;
    explicit Box(const CommonPart& part) : low(part.points.front()), high(low) {
        for (const Vector3& x : part.points) {
            low = low.cwiseMin(x);
            high = high.cwiseMax(x);
        }
    }
    bool holds(const Box& other) const { return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all(); }
};

// A surface that is turned inwards belongs to the least of the others whose box holds its own.
std::vector<CommonPart> with_cavities(std::vector<CommonPart>& surfaces) {
    std::vector<CommonPart> pieces, cavities;
    for (CommonPart& surface : surfaces) (surface.volume() < 0 ? cavities : pieces).push_back(std::move(surface));
    for (CommonPart& cavity : cavities) {
        CommonPart* around = nullptr;
        for (CommonPart& piece : pieces)
            if (Box(piece).holds(Box(cavity)) && (!around || piece.volume() < around->volume())) around = &piece;
        if (!around) {  // thinner than rounding: nothing is lost
            pieces.push_back(std::move(cavity));
            continue;
        }
        const int shift = count_of(around->points);
        around->points.insert(around->points.end(), cavity.points.begin(), cavity.points.end());
        for (CutTriangle t : cavity.triangles) {
            for (int& v : t.corners) v += shift;
            around->triangles.push_back(t);
        }
    }
    return pieces;
}

// Nothing is moved onto the planes of flat faces.
FacedMesh without_faces(const geometry::Mesh& mesh) { return {mesh, std::vector<int>(mesh.triangles.size(), -1)}; }

}  // namespace

Vector3 CommonPart::area_of(const CutTriangle& t) const {
    const Vector3 from = corner(t, 0);
    return 0.5 * (corner(t, 1) - from).cross(corner(t, 2) - from);
}

double CommonPart::area() const {
    double sum = 0;
    for (const CutTriangle& t : triangles) sum += area_of(t).norm();
    return sum;
}

double CommonPart::volume() const {
    if (points.empty()) return 0;
    double sum = 0;
    for (const CutTriangle& t : triangles) sum += area_of(t).dot(corner(t, 0) - points.front());
    return sum / 3;
}

Result<CommonPart> common_part(const geometry::Mesh& a, const geometry::Mesh& b) {
    for (const geometry::Mesh* mesh : {&a, &b})
        if (Errors faults = solids::validate_mesh(*mesh, {}, 1); !faults.empty()) return faults;
    const FacedMesh faced_a = without_faces(a);
    FacedMesh faced_b = without_faces(b);
    Result<SolidCut> cut = cut_solids(faced_a, faced_b, 0, Combination::intersect);
    double moved = 0;
    for (const auto& direction : some_directions) {
        if (cut || !can_cut_solids()) break;
        moved = 1e-9 * (extent(a) + extent(b));
        faced_b.mesh.vertices = b.vertices.colwise() + moved * Vector3(direction[0], direction[1], direction[2]);
        cut = cut_solids(faced_a, faced_b, 0, Combination::intersect);
    }
    if (!cut) return cut.errors();
    return CommonPart{std::move(cut->points), std::move(cut->triangles), moved};
}

std::vector<CommonPart> pieces_of(const CommonPart& whole) {
    std::vector<int> root(whole.points.size());
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](int v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const CutTriangle& t : whole.triangles)
        for (const int v : t.corners) root[root_of(v)] = root_of(t.corners[0]);
    std::vector<int> piece_of_root(whole.points.size(), -1), place(whole.points.size(), -1);
    std::vector<CommonPart> pieces;
    for (CutTriangle t : whole.triangles) {
        int& piece = piece_of_root[root_of(t.corners[0])];
        if (piece < 0) {
            piece = count_of(pieces);
            pieces.push_back({{}, {}, whole.moved});
        }
        for (int& v : t.corners) {
            if (place[v] < 0) {
                place[v] = count_of(pieces[piece].points);
                pieces[piece].points.push_back(whole.points[v]);
            }
            v = place[v];
        }
        pieces[piece].triangles.push_back(t);
    }
    return with_cavities(pieces);
}

}  // namespace fettle::core::parts
