// SPDX-License-Identifier: MIT
/// Bounds of the distance of two pieces over an interval by a plane that keeps its direction: cheaper than segment_bound.hpp, whose theory
/// (parabolas, rests, rounding) they share with n0 = n1 = n, and good enough until pieces are small.
#pragma once

#include <array>

#include "core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

/// How far apart two pieces are at an instant at least, and the direction from b to a that shows it.
struct Separation {
    Vector3 direction = Vector3::Zero();
    double apart = 0;  ///< 0: they may overlap, and the direction is that of the centers
};

/// The better of the boxes' gaps along the axes of a's and along those of b's; `d` is a's center seen from b's.
Separation box_separation(const Vector3& d, const Matrix3& axes_a, const Vector3& extent_a, const Matrix3& axes_b, const Vector3& extent_b);
Separation separation(const Instant& at, const Piece& a, const Piece& b);

/// An interval of a segment, prepared for many pairs of pieces.
class IntervalBound {
public:
    IntervalBound(const PairSegment& segment, const Instant& start, const Instant& middle, const Instant& end);

    /// Upper bound of how far points of the pieces move relative to each other from the middle of the interval.
    double motion(const Piece& a, const Piece& b) const;

    /// Lower bound along n: of two elements by their corners, of boxes if these are null. Rests, slack and all. Contract: |n| <= 1.
    SegmentBound along(const Vector3& n, const Piece& a, const Piece& b, const Corners* element_a, const Corners* element_b) const;

private:
    using Functionals = Eigen::Matrix<double, 4, 3>;
    using Values = Eigen::Matrix<double, 4, 1>;
    std::array<Functionals, 3> of_a_, of_b_;  // by component of n
    std::array<Values, 3> offset_;
    double length_, slack_;
    double drift_ = 0, rate_a_ = 0, rate_b_ = 0;  // of the motion
    double rest_a_ = 0, rest_b_ = 0;              // per radius: h^3 |w|^3 |B| / 36
};

}  // namespace fettle::core::clearance
