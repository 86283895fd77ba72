// SPDX-License-Identifier: MIT
#include "core/clearance/piece_bound.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

using Functionals = Eigen::Matrix<double, 4, 3>;
using Values = Eigen::Matrix<double, 4, 1>;

Vector3 excess(const Vector3& d, const Vector3& extent) {
    const Vector3 gap = (d.cwiseAbs() - extent).cwiseMax(0);
    return gap.cwiseProduct(d.cwiseSign());
}

// How far a piece reaches beyond its center along each functional.
Values extent(const Functionals& f, const Piece& piece) { return (f * piece.axes).cwiseAbs() * piece.half_extent; }

}  // namespace

Separation box_separation(const Vector3& d, const Matrix3& axes_a, const Vector3& extent_a, const Matrix3& axes_b,
                          const Vector3& extent_b) {
    const Matrix3 size = axes_a.transpose().lazyProduct(axes_b).cwiseAbs();
    const Vector3 gap_a = excess(axes_a.transpose() * d, extent_a + size * extent_b);
    const Vector3 gap_b = excess(axes_b.transpose() * d, extent_b + size.transpose() * extent_a);
    const double squared_a = gap_a.squaredNorm(), squared_b = gap_b.squaredNorm();
    if (squared_a == 0 && squared_b == 0) return {unit_direction(d), 0};
    if (squared_a >= squared_b) return {unit_direction(axes_a * gap_a), std::sqrt(squared_a)};
    return {unit_direction(axes_b * gap_b), std::sqrt(squared_b)};
}

Separation separation(const Instant& at, const Piece& a, const Piece& b) {
    return box_separation(at.offset + at.rotation_a * a.center - at.rotation_b * b.center, at.rotation_a * a.axes, a.half_extent,
                          at.rotation_b * b.axes, b.half_extent);
}

IntervalBound::IntervalBound(const PairSegment& segment, const Instant& start, const Instant& middle, const Instant& end)
    : length_(end.s - start.s), slack_(segment.slack) {
    const double third = 1.0 / 3;
    const auto prepare = [&](const Matrix3& r0, const Matrix3& rm, const Matrix3& r1, std::array<Functionals, 3>& out) {
        const Matrix3 first = third * (4 * rm - r1), second = third * (4 * rm - r0);
        for (int k = 0; k < 3; ++k) out[k] << r0.row(k), first.row(k), second.row(k), r1.row(k);
    };
    prepare(start.rotation_a, middle.rotation_a, end.rotation_a, of_a_);
    prepare(start.rotation_b, middle.rotation_b, end.rotation_b, of_b_);
    const Vector3 first = third * (4 * middle.offset - end.offset), second = third * (4 * middle.offset - start.offset);
    for (int k = 0; k < 3; ++k) offset_[k] << start.offset[k], first[k], second[k], end.offset[k];
    const double half = 0.5 * length_, cube = length_ * length_ * length_ / 36 * rounded_up;
    drift_ = half * (segment.a->path.position_step - segment.b->path.position_step).norm() * rounded_up;
    rate_a_ = half * segment.a->speed * segment.a->base_norm * rounded_up;
    rate_b_ = half * segment.b->speed * segment.b->base_norm * rounded_up;
    rest_a_ = cube * segment.a->speed * segment.a->speed * segment.a->speed * segment.a->base_norm;
    rest_b_ = cube * segment.b->speed * segment.b->speed * segment.b->speed * segment.b->base_norm;
}

double IntervalBound::motion(const Piece& a, const Piece& b) const {
    return (drift_ + rate_a_ * a.radius + rate_b_ * b.radius) * rounded_up;
}

SegmentBound IntervalBound::along(const Vector3& n, const Piece& a, const Piece& b, const Corners* element_a,
                                  const Corners* element_b) const {
    const Functionals fa = n[0] * of_a_[0] + n[1] * of_a_[1] + n[2] * of_a_[2];
    const Functionals fb = n[0] * of_b_[0] + n[1] * of_b_[1] + n[2] * of_b_[2];
    const Values offset = n[0] * offset_[0] + n[1] * offset_[1] + n[2] * offset_[2];
    const double rest = (rest_a_ * a.radius + rest_b_ * b.radius) * rounded_up + 2 * slack_;
    const auto bound = [&](const Values& c) {
        SegmentBound result;
        result.at_ends = least_of(c[0], c[3]);
        result.lower = (length_ > 0 ? least_value({c[0], c[1] - rest, c[2] - rest, c[3]}, result.dip) : result.at_ends) - slack_;
        return result;
    };
    if (element_a != nullptr && element_b != nullptr)
        return bound(offset + ((fa * element_a->x).rowwise().minCoeff() - (fb * element_b->x).rowwise().maxCoeff()));
    return bound(offset + (fa * a.center - fb * b.center) - (extent(fa, a) + extent(fb, b)));
}

}  // namespace fettle::core::clearance
