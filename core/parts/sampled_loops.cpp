// SPDX-License-Identifier: MIT
#include "core/parts/sampled_loops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"

namespace fettle::core::parts {
double sampled_area(const Loop& loop) {
    double area = 0;
    for (const Segment& segment : loop.segments) {
        const int count = sample_count(segment.curve);
        Vector2 p = value(start_of(segment.curve));
        for (int k = 1; k <= count; ++k) {
            const Vector2 q = at(segment.curve, static_cast<double>(k) / count).position;
            area += p.x() * q.y() - p.y() * q.x();
            p = q;
        }
    }
    return area;
}

SampledLoops::SampledLoops(const std::vector<Loop>& loops) {
    low_ = Vector2::Constant(std::numeric_limits<double>::infinity());
    high_ = -low_;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        for (std::size_t s = 0; s < loops[l].segments.size(); ++s) {
            Piece piece{frozen(loops[l].segments[s].curve), l, s, {}, {}, {}};
            const int count = sample_count(piece.curve);
            piece.samples.push_back(value(start_of(piece.curve)));
            for (int k = 1; k < count; ++k) piece.samples.push_back(at(piece.curve, static_cast<double>(k) / count).position);
            piece.samples.push_back(value(end_of(piece.curve)));
            piece.low = piece.high = piece.samples.front();
            double longest = 0;
            for (std::size_t k = 0; k < piece.samples.size(); ++k) {
                piece.low = piece.low.cwiseMin(piece.samples[k]);
                piece.high = piece.high.cwiseMax(piece.samples[k]);
                if (k > 0) longest = std::max(longest, (piece.samples[k] - piece.samples[k - 1]).norm());
            }
            if (count > 1) {
                piece.low.array() -= 0.3 * longest;
                piece.high.array() += 0.3 * longest;
            }
            low_ = low_.cwiseMin(piece.low);
            high_ = high_.cwiseMax(piece.high);
            pieces_.push_back(std::move(piece));
        }
    }
}

bool SampledLoops::contains(const Vector2& p) const {
    // Crossings of the ray towards +x; samples decide where they are clear, bisection along the curve where not.
    bool inside = false;
    for (const Piece& piece : pieces_) {
        if (piece.low.y() > p.y() || piece.high.y() < p.y() || piece.high.x() < p.x()) continue;
        const std::size_t count = piece.samples.size() - 1;
        for (std::size_t k = 0; k < count; ++k) {
            const Vector2 &a = piece.samples[k], &b = piece.samples[k + 1];
            if ((a.y() > p.y()) == (b.y() > p.y())) continue;
            const double margin = count > 1 ? 0.3 * (b - a).norm() : 0;
            if (std::max(a.x(), b.x()) + margin < p.x()) continue;
            if (std::min(a.x(), b.x()) - margin > p.x()) {
                inside = !inside;
                continue;
            }
            double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
            if (count > 1) {
                double from = static_cast<double>(k) / static_cast<double>(count),
                       to = static_cast<double>(k + 1) / static_cast<double>(count);
                const bool above = a.y() > p.y();
                for (int i = 0; i < 45; ++i) {
                    const double middle = (from + to) / 2;
                    ((at(piece.curve, middle).position.y() > p.y()) == above ? from : to) = middle;
                }
                x = at(piece.curve, from).position.x();
            }
            if (x > p.x()) inside = !inside;
        }
    }
    return inside;
}

SampledLoops::Nearest SampledLoops::nearest(const Vector2& p) const {
    FETTLE_ASSERT(!pieces_.empty(), "loops without curves have no nearest point");
    Nearest best;
    best.distance = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
        const double to_box = (piece.low - p).cwiseMax(p - piece.high).cwiseMax(0.0).norm();
        if (to_box >= best.distance) continue;
        const double u = nearest_parameter(piece.curve, p);
        const Vector2 point = at(piece.curve, u).position;
        const double distance = (point - p).norm();
        if (distance < best.distance) best = {distance, piece.loop, piece.segment, u, point};
    }
    return best;
}

}  // namespace fettle::core::parts
