// SPDX-License-Identifier: MIT
#include "core/clearance/revolved_bound.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/limits.hpp"
#include "core/clearance/simplex.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int few_elements = 64;  // of a piece whose corners are gone through one by one

}  // namespace

RevolvedBound::RevolvedBound(const ScrewedPair& pair)
    : pair_(pair),
      about_(*pair.revolution),
      length_(about_.is_about_axis() ? about_.axis.norm() : 1),
      a_(side_of(pair.a, pair.body_a.start)),
      b_(side_of(pair.b, pair.body_b.start)) {}

// Every other one is the opposite of the one eight before it, and four of them are along r and z.
RevolvedBound::Plane RevolvedBound::fixed(std::size_t direction) {
    static const auto all = [] {
        std::array<Plane, directions> out;
        for (std::size_t k = 0; k < directions; ++k) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(directions);
            out[k] = {std::cos(angle), std::sin(angle)};
        }
        out[0] = {1, 0};
        out[4] = {0, 1};
        out[8] = {-1, 0};
        out[12] = {0, -1};
        return out;
    }();
    return all[direction];
}

double RevolvedBound::least_along(const Plane& m, const Corner& corner) { return m.r * (m.r > 0 ? corner.low : corner.r) + m.z * corner.z; }

double RevolvedBound::least_along(const Plane& m, const Side& side, const Piece& piece) {
    double least = base::infinity;
    for (int i = piece.first; i < piece.first + piece.count; ++i)
        for (const Corner& corner : side.elements[i]) least = std::min(least, least_along(m, corner));
    return least;
}

std::array<RevolvedBound::Corner, 3> RevolvedBound::profile(const Corners& element, const kinematics::Pose& start) const {
    std::array<Vector3, 4> out;  // from the axis, or from the point
    std::array<Corner, 3> corners;
    const Vector3 axis = about_.is_about_axis() ? Vector3(about_.axis / length_) : Vector3(Vector3::Zero());
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3 x = kinematics::world_position(start, element.x.col(static_cast<Eigen::Index>(i))) - about_.point;
        corners[i].z = axis.dot(x);
        out[i] = x - corners[i].z * axis;
        corners[i].r = out[i].norm();
    }
    const Vector3 nearest = nearest_to_origin(out, 3).point;
    const double distance = nearest.norm();
    const bool is_beside = distance > 16 * pair_.slack;  // else the axis goes through it, and 0 is all that is known
    for (std::size_t i = 0; i < 3; ++i) corners[i].low = is_beside ? nearest.dot(out[i]) / distance : 0;
    return corners;
}

RevolvedBound::Side RevolvedBound::side_of(const PieceTree& tree, const kinematics::Pose& start) const {
    Side side{tree, {}, std::vector<std::array<double, directions>>(tree.pieces.size())};
    for (const PieceElement& element : tree.elements) side.elements.push_back(profile(element.corners, start));
    for (std::size_t k = tree.pieces.size(); k-- > 0;) {  // in preorder: parts come after the whole
        const Piece& piece = tree.pieces[k];
        for (std::size_t i = 0; i < directions; ++i)
            side.least[k][i] =
                piece.is_element() ? least_along(fixed(i), side, piece) : std::min(side.least[piece.left][i], side.least[piece.right][i]);
    }
    return side;
}

RevolvedBound::Slides RevolvedBound::slides_over(const CoordinateBox& box) const {
    Slides out;
    const auto add = [&](const ScrewedBody& body, double sign) {
        for (std::size_t j = 0; j < body.screws.size(); ++j) {
            const certificate::Screw& screw = body.screws[j];
            const auto k = static_cast<std::size_t>(screw.coordinate);
            const double by = sign * screw.slide * length_;
            const double low = by * (box.low[k] - body.starts[j]), high = by * (box.high[k] - body.starts[j]);
            out.least += std::min(low, high);
            out.most += std::max(low, high);
        }
    };
    add(pair_.body_b, 1);
    add(pair_.body_a, -1);
    return out;
}

// The normals of a triangle's edges in the half plane of r and z.
void RevolvedBound::add_normals(const std::array<Corner, 3>& element, std::vector<Plane>& out) {
    for (const bool low : {true, false})
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner &from = element[i], &to = element[(i + 1) % 3];
            const double dr = low ? to.low - from.low : to.r - from.r, dz = to.z - from.z, length = std::hypot(dr, dz);
            if (!(length > 0)) continue;
            out.push_back({dz / length, -dr / length});
            out.push_back({-dz / length, dr / length});
        }
}

RevolvedBound::Found RevolvedBound::bound(int a, int b, const CoordinateBox& box) const {
    const Slides slides = slides_over(box);
    Plane best;
    double most = -base::infinity;
    const auto take = [&](const Plane& m, double of_b, double of_a) {
        const double lower = of_b + of_a + std::min(m.z * slides.least, m.z * slides.most);
        if (!(lower > most)) return;
        most = lower;
        best = m;
    };
    for (std::size_t k = 0; k < directions; ++k) take(fixed(k), b_.least[b][k], a_.least[a][(k + directions / 2) % directions]);
    const Piece &of_a = a_.tree.pieces[a], &of_b = b_.tree.pieces[b];
    if (about_.is_about_axis() && std::max(of_a.count, of_b.count) <= few_elements) {
        std::vector<Plane> normals;
        add_normals(a_.elements[of_a.first], normals);
        add_normals(b_.elements[of_b.first], normals);
        for (const Plane& m : normals) take(m, least_along(m, b_, of_b), least_along({-m.r, -m.z}, a_, of_a));
    }
    return {most - pair_.slack, {best.r, best.z, 0}};
}

}  // namespace fettle::core::clearance
