// SPDX-License-Identifier: MIT
/// Lower bounds of the distance of two pieces (boxes or elements) over a box of joint coordinates. The search: range_search.hpp.
///
/// Let the box have half widths w about c, let n_i be vectors of length <= 1 at its 2^n corners, n(u) their linear interpolant in
/// each coordinate, d = x_a - x_b. Then dist >= g(u) = n(u).d(u), and the interpolant of g between the corners is off by at most
///   sum over k of e_k,   e_k = 1/2 w_k^2 max |d2g/du_k2| <= 1/2 w_k^2 (2 |dn/du_k||dd/du_k| + |n.d2d/du_k2|),
/// so that dist >= min over the corners of n_i.d - sum e_k, and the least value over two convex pieces is a difference of support
/// functions: second order in the box, mixed derivatives have no effect, and what moves across n costs nothing at all (layers of a flat
/// mechanism). For a point, with the screws j of coordinate k (certificate/linkage.hpp) and r_j its greatest distance from screw j's axis
/// over the box,
///   |dx| <= sum |turn_j| r_j + |slide_j|,   |n.d2x| <= sum turn_j^2 r_j min(1, |n x z_j| + tilt_j)
///                                                      + 2 sum over i before j of |turn_i| (|turn_j| r_j + |slide_j|);
/// tilt_j, how far the screws before it can turn the axis z_j, is 2 sum |z_i x z_j|; and r_j is that at c and what the screws after it move
/// the point from there, min(|turn_i| w, 2) r_i + |slide_i| w each. Where one screw alone moves with u_k and n stays, w^2/2 is at most 2:
/// an arc and its chord are within two radii.
///
/// Rounding. A pose is the product of at most 32 screws. One is off by 40 u and what its angle is off, 3 u |turn d|, relative to the
/// points' distances from its axis and the world's origin; functionals, supports and sums by 64 u of the same. `slack` is charged to every
/// bound:
///   slack = 64 u (4 + screws) (1 + largest |turn d|) sum of (radius + |q| + |p_j| + |slide_j d|).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/certificate/linkage.hpp"
#include "core/clearance/element_pair.hpp"
#include "core/clearance/piece_tree.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::clearance {

using certificate::CoordinateBox;
using certificate::Coordinates;
using certificate::most_coordinates;
using certificate::most_screws;

Coordinates middle_of(const CoordinateBox& box);

/// A body that moves by screws, outermost first.
struct ScrewedBody {
    std::vector<certificate::Screw> screws;
    std::vector<double> starts;  ///< of each screw's coordinate
    std::vector<double> tilt;
    kinematics::Pose start;
};

struct ScrewedPair {
    const PieceTree& a;
    const PieceTree& b;
    ScrewedBody body_a, body_b;
    int count = 0;  ///< of coordinates
    CoordinateBox ranges;
    Coordinates start{};
    std::array<bool, most_coordinates> is_single{};  ///< one screw alone moves with it
    double slack = 0;                                ///< [m]
    std::optional<certificate::Revolution> revolution{};
};

/// Contract: at most most_coordinates and most_screws.
ScrewedPair screwed_pair(const PieceTree& a, const PieceTree& b, const certificate::Linkage& linkage, const certificate::LinkedPair& linked,
                         const kinematics::Pose& start_a, const kinematics::Pose& start_b);

/// What a screw takes a pose to, as its coordinate is d beyond its start.
kinematics::Pose moved(const certificate::Screw& screw, double d, const kinematics::Pose& pose);

/// Where a body is.
kinematics::Pose pose_of(const ScrewedBody& body, const Coordinates& at);

/// A lower bound over a box, and what to split.
struct RangeBound {
    double lower = 0;     ///< slack charged
    double loosened = 0;  ///< by the box: what it is below the same at the box's middle
    int widest = 0;       ///< the coordinate that loosens it most
};

/// A box, prepared for many pairs of pieces.
class BoxBound {
public:
    BoxBound(const ScrewedPair& pair, const CoordinateBox& box);

    const kinematics::Pose& middle_a() const { return a_.middle; }
    const kinematics::Pose& middle_b() const { return b_.middle; }
    int corners() const { return 1 << pair_.count; }

    /// Distance of two elements at a corner, or at the middle (-1); points in the world.
    ElementPairDistance distance(const Corners& a, const Corners& b, int corner) const;

    /// Along one vector. Elements by their corners, of boxes these are null. Contract: |n| <= 1.
    RangeBound along(const Vector3& n, const Piece& a, const Piece& b, const Corners* element_a, const Corners* element_b) const;
    /// The bound of two elements, along one vector per corner.
    RangeBound along(const std::vector<Vector3>& normals, const Corners& element_a, const Corners& element_b) const;

private:
    using Radii = std::array<double, most_screws>;
    struct View {
        const ScrewedBody& body;
        kinematics::Pose middle;
        std::vector<kinematics::Pose> corners;
        std::vector<kinematics::Pose> inner;  // at the middle, by the screws after each
    };
    struct Losses {
        std::array<double, most_coordinates> along{};
        double total = 0;
    };

    View view_of(const ScrewedBody& body, const CoordinateBox& box) const;
    Radii radii(const View& view, const Piece& piece, const Corners* element) const;
    void add_losses(const View& view, const Radii& r, const std::vector<Vector3>& normals, const Coordinates& change, Losses& losses) const;
    RangeBound bound(const std::array<double, 1 << most_coordinates>& values, double at_middle, const Losses& losses) const;

    const ScrewedPair& pair_;
    Coordinates half_{};
    View a_, b_;
};

}  // namespace fettle::core::clearance
