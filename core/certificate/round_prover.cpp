// SPDX-License-Identifier: MIT
#include "core/certificate/round_prover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::certificate {
namespace {

Interval norm(const Interval3& x) { return sqrt(square(x[0]) + square(x[1]) + square(x[2])); }

// g.x/|g| for the corners, from below. 0 where g has no length.
std::array<Interval, 3> along(const Interval3& g, const std::array<Interval3, 3>& x) {
    std::array<Interval, 3> out;
    const Interval length = norm(g);
    if (!(length.low > 0)) return out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = dot(g, x[i]) / length;
    return out;
}

double least_of(const std::array<Interval, 3>& values) { return std::min({values[0].low, values[1].low, values[2].low}); }

// Directions along which a triangle may be farthest from the origin: those of its corners, of the nearest points of its edges, and across
// it.
std::vector<Vector3> directions_of(const std::array<Vector3, 3>& x) {
    std::vector<Vector3> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3 &from = x[i], edge = x[(i + 1) % 3] - from;
        out.push_back(from);
        const double squared = edge.squaredNorm();
        if (squared > 0) out.emplace_back(from - std::clamp(from.dot(edge) / squared, -1.0, 0.0) * edge);
    }
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    out.push_back(normal);
    out.emplace_back(-normal);
    return out;
}

}  // namespace

RoundProver::RoundProver(const Linkage& linkage, const LinkedPair& pair, const kinematics::Pose& start_a, const kinematics::Pose& start_b)
    : about_(revolution_of(pair)), a_{start_a, {}}, b_{start_b, {}} {
    if (!about_ || !about_->is_about_axis()) return;
    for (const bool of_b : {true, false})
        for (Screw screw : of_b ? pair.b : pair.a) {
            if (screw.slide == 0) continue;
            if (!of_b) screw.slide = -screw.slide;
            slides_.push_back(screw);
            starts_.push_back(linkage.coordinates[pair.coordinates[screw.coordinate]].start);
        }
}

// Across the axis as long as x is from it times |z|, and turned by a right angle; or x itself.
Interval3 RoundProver::across_of(const Interval3& x) const { return about_->is_about_axis() ? cross(exactly(about_->axis), x) : x; }

const std::array<RoundProver::Corner, 3>& RoundProver::profile(Side& side, const Vector3* triangle) const {
    const auto [found, is_new] = side.triangles.try_emplace(triangle);
    if (!is_new) return found->second;
    std::array<Interval3, 3> across;
    std::array<Vector3, 3> middles;
    const Interval length = about_->is_about_axis() ? norm(exactly(about_->axis)) : Interval(1);
    for (std::size_t i = 0; i < 3; ++i) {
        Interval3 x = exactly(side.start.position) - exactly(about_->point);
        for (std::size_t k = 0; k < 3; ++k)
            x[k] = x[k] + dot(exactly(side.start.rotation.row(static_cast<Eigen::Index>(k)).transpose()), exactly(triangle[i]));
        across[i] = across_of(x);
        middles[i] = middle(across[i]);
        found->second[i].r = norm(across[i]) / length;
        found->second[i].z = about_->is_about_axis() ? dot(exactly(about_->axis), x) / length : Interval(0);
    }
    std::array<Interval, 3> best;  // 0: r is not less
    for (const Vector3& g : directions_of(middles)) {
        const std::array<Interval, 3> values = along(exactly(g), across);
        if (least_of(values) > least_of(best)) best = values;
    }
    for (std::size_t i = 0; i < 3; ++i) found->second[i].low = best[i] / length;
    return found->second;
}

// The least m_r r + m_z z over the region, from below.
double RoundProver::least(Side& side, const Region& region, double m_r, double m_z) const {
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 2 < region.points.size(); i += 3)
        for (const Corner& corner : profile(side, &region.points[i]))
            out = std::min(out, (Interval(m_r) * (m_r > 0 ? corner.low : corner.r) + Interval(m_z) * corner.z).low);
    return out;
}

Interval RoundProver::slide(const CoordinateBox& part) const {
    Interval out = 0;
    if (slides_.empty()) return out;
    const Interval length = norm(exactly(about_->axis));
    for (std::size_t j = 0; j < slides_.size(); ++j) {
        const auto k = static_cast<std::size_t>(slides_[j].coordinate);
        out = out + Interval(slides_[j].slide) * length * (Interval(part.low[k], part.high[k]) - Interval(starts_[j]));
    }
    return out;
}

bool RoundProver::prove(const Region& a, const Region& b, const CoordinateBox& part, const Vector3& m, double lower) {
    if (!about_ || !m.allFinite() || m[2] != 0) return false;
    const double length = norm_bound(exactly(m));
    if (!(length > 1e-6 && length < 1e6)) return false;
    const Interval apart = Interval(least(b_, b, m[0], m[1])) + Interval(least(a_, a, -m[0], -m[1])) + Interval(m[1]) * slide(part);
    return apart.low >= (Interval(lower) * Interval(length)).high;
}

}  // namespace fettle::core::certificate
