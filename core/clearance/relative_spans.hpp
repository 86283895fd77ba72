// SPDX-License-Identifier: MIT
/// The motion of body a as seen from body b, over many path segments at once: bounds of the distance of two pieces over up to fifteen
/// spans of time for little more than the price of one. What moves together is at rest here. Used before segment_bound.hpp, whose bounds
/// are finer and cost one segment each. (Here b is the body that serves as the frame, a the other one.)
///
/// A span is a path segment, or fifteen spans of the level below; a group holds up to fifteen consecutive ones and the relative poses
///   R_j = R_b^T R_a,   p_j = R_b^T (q_a - q_b)   at node j, where span j begins and span j - 1 ends.
/// For vectors n_j in b's frame with |n_j| <= 1 and points X of a, Z of b put f(t) = n(t).(R(t) X + p(t) - Z), n(t) between n_j and n_{j+1}
/// in span j. Then |R_b n| dist >= f, and f_j is a difference of support functions of the pieces. In span j, for |X| <= r,
///   f(t) >= min(f_j, f_{j+1}) - rest_shift_j - r rest_turn_j - |n_{j+1} - n_j| (step_shift_j + r step_turn_j)/4.
/// With x = R X + p that is for one segment, s in [0, 1]:
///   x = (1 - s) x(0) + s x(1) + 2 s (1 - s) g + e,  g = D X + d,  D = 2 R(1/2) - R(0) - R(1),  d likewise of p;
///   |g| <= |D| r + |d|,  2 s (1 - s) <= 1/2,  |e| <= M/124 (interpolation at 0, 1/2, 1);
///   M >= |x'''|: of the product of R_b^T (derivatives |w_b|^k) and R_a X + q_a - q_b (|w_a|^k r, and |q'| in the first), with
///   Q >= |q_a - q_b|:  M = (|w_a| + |w_b|)^3 r + |w_b|^3 Q + 3 |w_b|^2 |q'|;
///   and what the segment's end and the next one's start differ by (rounding, if the path is continuous; nothing depends on that);
///   of the product of the linear n and the linear part of x there remains s (1 - s) (n_1 - n_0).(x(1) - x(0)) beside its chord.
/// In a span of several segments: the largest of these, and how far the poses at its inner nodes are from the chord of R and p.
///
/// A span of one segment is not held to its chord alone. With x_m = (x(0) + x(1))/2 + g = R_m X + p_m, R_m = 2 R(1/2) - (R(0) + R(1))/2 and
/// p_m likewise, x - e is the parabola with Bernstein coefficients x(0), x_m, x(1), and n.(x - e - Z) a cubic. With n_m the mean of n_0 and
/// n_1, and f_m = n_m.(x_m - Z), least over the pieces a difference of supports like f_0 and f_1, its coefficients are f_0, f_1 and
///   (f_0 + 2 f_m)/3 + (n_1 - n_0).(x(0) - x_m)/3,   (f_1 + 2 f_m)/3 + (n_1 - n_0).(x_m - x(1))/3,
/// the inner two of which have a weight of 3 s (1 - s) <= 3/4 together: with f_least = min(f_0, f_1)
///   f >= min(f_least, (f_least + f_m)/2 - |n_1 - n_0| (|x(1) - x(0)|/2 + |g|)/4) - |e| - (what the ends differ by).
/// Both bounds hold. What the second one loses is of third order in time for planes that keep their direction; of one that turns half of
/// the first one's loss remains, and |g|. Only bounds by corners of elements use it.
///
/// Bases that are rotations up to rounding only: |R_b n| <= |B_b|, and R_b^T R_b = B_b^T B_b turns n.Z by at most (|B_b|^2 - 1) |Z|.
/// Rounding: with the errors of poses (segment_bound.hpp) an R_j is off by their sum, p_j by that of R_b times Q and 4u times the size of
/// the positions; products, functionals and supports by 64u of radii and Q. In all eight times: poses enter a bound with weight 7.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/clearance/piece_bound.hpp"
#include "core/clearance/relative_chain.hpp"
#include "core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

inline constexpr int most_spans = 15;
using Lanes = Eigen::Array<double, most_spans + 1, 1>;  ///< one value per node of a group
inline constexpr std::uint32_t all_nodes = (2U << most_spans) - 1;

/// The end of a path segment at which a node lies: s = 0 or 1.
struct SegmentEnd {
    int segment = 0;
    bool at_end = false;
};

struct SpanGroup {
    int level = 0;                  ///< 0: spans are segments; else they are groups of the level below
    int first = 0, count = 0;       ///< spans first .. first + count - 1: indices of segments, or of groups
    int first_segment = 0;          ///< where node 0 lies
    int length = 1;                 ///< segments of a span; the last may have fewer
    int segments = 0;               ///< of the whole path
    std::array<Lanes, 9> rotation;  ///< R_j by rows; nodes beyond `count` repeat the last
    std::array<Lanes, 3> offset;    ///< p_j
    Lanes rest_turn, rest_shift;    ///< by span: how far points leave their chords; the last is 0
    Lanes step_turn, step_shift;    ///< by span: how far they go; the last is 0

    SpanGroup() {}  // NOLINT: numbers are written once

    RelativePose at(int j) const;
    /// Counted in segments.
    int place_of(int j) const { return std::min(first_segment + std::min(j, count) * length, segments); }
    /// Where node j lies.
    SegmentEnd end_at(int j) const { return {std::min(place_of(j), segments - 1), place_of(j) == segments}; }
};

/// Middles of the spans of a group of single segments.
struct SpanMiddles {
    std::array<Lanes, 9> rotation;  ///< R_m by rows
    std::array<Lanes, 3> offset;    ///< p_m
    Lanes rest_turn, rest_shift;    ///< how far points leave their parabolas

    SpanMiddles() {}  // NOLINT: numbers are written once
};

/// As separation() of two placed boxes, the direction in b's frame.
Separation separation(const RelativePose& at, const Piece& a, const Piece& b);

/// The vectors n_j: n at one node, |n| <= 1, turned at the others as the center of a's piece goes round b: by `rate` times its displacement
/// across n.
struct TurningPlane {
    int node = 0;
    Vector3 n = Vector3::Zero();
    double rate = 0;
};

/// Any n_j, |n_j| <= 1, in b's frame, and f_j of two whole bodies [m].
struct NodePlanes {
    std::array<Vector3, most_spans + 1> n{};
    std::array<double, most_spans + 1> f{};
};

/// Lower bounds; entries beyond the group's count mean nothing.
struct SpanBounds {
    Lanes spans;  ///< over each span
    Lanes nodes;  ///< at each node
};

class RelativeSpans {
public:
    RelativeSpans(const std::vector<PairSegment>& segments, Frame frame, double radius_a, double radius_b);

    const SpanGroup& group(int i) const { return groups_[i]; }
    /// The group that holds all segments.
    int root() const { return count_of(groups_) - 1; }

    /// Bounds at the nodes of `wanted` (bits), and over the spans between two of them.
    SpanBounds of_boxes(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Piece& b,
                        std::uint32_t wanted = all_nodes) const;
    /// The same of pieces that are these elements.
    SpanBounds of_elements(const SpanGroup& group, const TurningPlane& plane, const Piece& a, std::span<const PieceElement> elements_a,
                           std::span<const PieceElement> elements_b, std::uint32_t wanted = all_nodes) const;

    /// Bounds of the whole bodies.
    SpanBounds of_planes(const SpanGroup& group, const NodePlanes& planes) const;

private:
    const SpanMiddles* middles(const SpanGroup& group) const { return group.length == 1 ? &middles_[group.first / most_spans] : nullptr; }

    std::vector<SpanGroup> groups_;     // level by level
    std::vector<SpanMiddles> middles_;  // of the first level
    double radius_ = 0, slack_ = 0, shrink_ = 1;
};

/// In which frame do points of the other body leave the chords of their segments by less? There bounds are better. Told by some of the
/// segments: either frame gives true bounds.
Frame better_frame(const std::vector<PairSegment>& segments, double radius_a, double radius_b);

}  // namespace fettle::core::clearance
