// SPDX-License-Identifier: MIT
/// The loops of a profile on plain numbers, for questions that decide: is a point within them, what of their edge is nearest.
#pragma once

#include <vector>

#include "core/parts/curve_geometry.hpp"
#include "core/parts/path.hpp"

namespace fettle::core::parts {

class SampledLoops {
public:
    explicit SampledLoops(const std::vector<Loop>& loops);

    /// Right for points that are not within rounding of the edge.
    bool contains(const Vector2& p) const;

    struct Nearest {
        double distance = 0;
        std::size_t loop = 0, segment = 0;
        double u = 0;
        Vector2 point = Vector2::Zero();
    };
    /// Contract: there is a curve.
    Nearest nearest(const Vector2& p) const;

    Vector2 low() const { return low_; }
    Vector2 high() const { return high_; }
    /// Diagonal of its box.
    double size() const { return (high_ - low_).norm(); }

private:
    struct Piece {
        Curve curve;  ///< on plain numbers where it is no law
        std::size_t loop, segment;
        std::vector<Vector2> samples;
        Vector2 low, high;
    };
    std::vector<Piece> pieces_;
    Vector2 low_, high_;
};

/// Twice the area that samples of the loop enclose; negative: it runs clockwise.
double sampled_area(const Loop& loop);

}  // namespace fettle::core::parts
