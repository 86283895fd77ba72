// SPDX-License-Identifier: MIT
#include "tests/support/inclusion_ccd.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <vector>

namespace fettle::tests::support {

namespace {

using core::ccd::LinearCcdOptions;
using core::ccd::LinearCcdResult;
using core::geometry::PairType;
using core::geometry::PairVertices;

constexpr double inclusion_rounding = 36 * 0x1p-52;
/// Halving stops here whatever the tolerance: middles of boxes stay exact.
constexpr double least_width = 0x1p-50;

/// A box of (t, u, v): lower corner and widths, all dyadic and exact.
struct ParameterBox {
    std::array<double, 3> low{0, 0, 0}, width{1, 1, 1};
    bool small = false;  // as far as the tolerance asks: not to be halved
};

/// Earliest first; among equals the smallest, so that the search dives.
struct LaterBox {
    bool operator()(const ParameterBox& a, const ParameterBox& b) const {
        if (a.low[0] != b.low[0]) return a.low[0] > b.low[0];
        return a.width[0] * a.width[1] * a.width[2] > b.width[0] * b.width[1] * b.width[2];
    }
};

struct CornerRange {
    double low, high;
};

class InclusionSearch {
public:
    InclusionSearch(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin, const LinearCcdOptions& options)
        : type_(type), options_(options) {
        double size = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            x_t0_[i] = t0[i] - t0[0];
            x_t1_[i] = t1[i] - t0[0];
            size = std::max({size, x_t0_[i].cwiseAbs().maxCoeff(), x_t1_[i].cwiseAbs().maxCoeff()});
            finite_ = finite_ && x_t0_[i].allFinite() && x_t1_[i].allFinite();
        }
        if (!finite_ || size == 0) return;
        int exponent = 0;
        std::frexp(size, &exponent);
        for (std::size_t i = 0; i < 4; ++i) {
            for (int k = 0; k < 3; ++k) {
                x_t0_[i][k] = std::ldexp(x_t0_[i][k], -exponent);
                x_t1_[i][k] = std::ldexp(x_t1_[i][k], -exponent);
            }
        }
        reach_ = std::ldexp(dmin, -exponent) * (1 + 0x1p-50) + inclusion_rounding;
        tolerance_ = std::ldexp(options.tolerance, -exponent);
        set_dimension_tolerances();
    }

    LinearCcdResult run() const {
        if (!finite_) return {true, 0};
        std::priority_queue<ParameterBox, std::vector<ParameterBox>, LaterBox> queue;
        add({}, queue);
        for (long boxes = 1; !queue.empty(); boxes += 2) {
            const ParameterBox box = queue.top();
            if (box.small || boxes > options_.max_iterations) return {true, box.low[0]};
            queue.pop();
            halve(box, queue);
        }
        return {};
    }

private:
    /// Least and largest corner value on one axis. Rounding is monotone, so the extremes of a sum over all corners are the sums of each
    /// term's extremes, bit for bit: four ends instead of eight corners.
    CornerRange range_over(const ParameterBox& box, int k) const {
        CornerRange r{INFINITY, -INFINITY};
        const double u0 = box.low[1], u1 = u0 + box.width[1], v0 = box.low[2], v1 = v0 + box.width[2];
        for (const double t : {box.low[0], box.low[0] + box.width[0]}) {
            const auto at = [&](std::size_t i) { return (x_t1_[i][k] - x_t0_[i][k]) * t + x_t0_[i][k]; };
            const double x0 = at(0), x1 = at(1), x2 = at(2), x3 = at(3);
            if (type_ == PairType::point_triangle) {
                const double a = (x2 - x1) * u0, b = (x2 - x1) * u1, c = (x3 - x1) * v0, d = (x3 - x1) * v1;
                r.low = std::min(r.low, x0 - (std::max(a, b) + std::max(c, d) + x1));
                r.high = std::max(r.high, x0 - (std::min(a, b) + std::min(c, d) + x1));
            } else {
                const double a = (x1 - x0) * u0 + x0, b = (x1 - x0) * u1 + x0, c = (x3 - x2) * v0 + x2, d = (x3 - x2) * v1 + x2;
                r.low = std::min(r.low, std::min(a, b) - std::max(c, d));
                r.high = std::max(r.high, std::max(a, b) - std::min(c, d));
            }
        }
        return r;
    }

    enum class Verdict { clear, hit, halve };
    Verdict judge(const ParameterBox& box) const {
        bool small_image = true, inside = true;
        for (int k = 0; k < 3; ++k) {
            const CornerRange r = range_over(box, k);
            if (r.low > reach_ || r.high < -reach_) return Verdict::clear;
            small_image = small_image && r.high - r.low <= tolerance_;
            inside = inside && r.low >= -reach_ && r.high <= reach_;
        }
        bool narrow = true, least = true;
        for (std::size_t k = 0; k < 3; ++k) {
            narrow = narrow && box.width[k] <= dimension_tolerance_[k];
            least = least && box.width[k] <= least_width;
        }
        return small_image || inside || narrow || least ? Verdict::hit : Verdict::halve;
    }

    Vector3 difference(const PairVertices& x, double u, double v) const {
        if (type_ == PairType::point_triangle) return x[0] - ((x[2] - x[1]) * u + (x[3] - x[1]) * v + x[1]);
        return ((x[1] - x[0]) * u + x[0]) - ((x[3] - x[2]) * v + x[2]);
    }

    /// Width that keeps the box's image within the tolerance: a third of it per dimension, by the longest edge of the corner hexahedron.
    void set_dimension_tolerances() {
        std::array<double, 3> length{0, 0, 0};
        const auto lengthen = [&](int k, const Vector3& edge) { length[k] = std::max(length[k], edge.cwiseAbs().maxCoeff()); };
        for (const double a : {0.0, 1.0}) {
            for (const double b : {0.0, 1.0}) {
                lengthen(0, difference(x_t1_, a, b) - difference(x_t0_, a, b));
                const PairVertices& x = a == 0 ? x_t0_ : x_t1_;
                lengthen(1, difference(x, 1, b) - difference(x, 0, b));
                lengthen(2, difference(x, b, 1) - difference(x, b, 0));
            }
        }
        for (std::size_t k = 0; k < 3; ++k) dimension_tolerance_[k] = std::max(least_width, tolerance_ / (3 * std::max(length[k], 1e-300)));
    }

    /// Boxes that are clear never enter the queue.
    template <class Queue>
    void add(ParameterBox box, Queue& queue) const {
        const Verdict verdict = judge(box);
        box.small = verdict == Verdict::hit;
        if (verdict != Verdict::clear) queue.push(box);
    }

    template <class Queue>
    void halve(const ParameterBox& box, Queue& queue) const {
        std::size_t k = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            if (box.width[i] / dimension_tolerance_[i] > box.width[k] / dimension_tolerance_[k]) k = i;
        }
        ParameterBox half = box;
        half.width[k] = 0.5 * box.width[k];
        add(half, queue);
        half.low[k] += half.width[k];
        // Points of a triangle have u + v <= 1.
        if (type_ == PairType::point_triangle && half.low[1] + half.low[2] > 1) return;
        add(half, queue);
    }

    PairType type_;
    const LinearCcdOptions& options_;
    PairVertices x_t0_, x_t1_;
    bool finite_ = true;
    double reach_ = inclusion_rounding, tolerance_ = 0;
    std::array<double, 3> dimension_tolerance_{1, 1, 1};
};

/// Time before which primitives that start apart cannot have met: the first gap over the fastest relative speed of two vertices.
double first_possible_contact(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin) {
    const double gap = (core::ccd::distance_lower_bound(type, t0) - dmin) * (1 - 0x1p-50);
    if (!(gap > 0)) return 0;
    double speed = 0;
    const std::size_t first_count = type == PairType::point_triangle ? 1 : 2;
    for (std::size_t i = 0; i < first_count; ++i) {
        for (std::size_t j = first_count; j < 4; ++j) {
            const Vector3 d = t0[i] - t0[j], e = t1[i] - t1[j];
            const double way = (e - d).norm() + 0x1p-50 * (d.norm() + e.norm());
            if (!std::isfinite(way)) return 0;
            speed = std::max(speed, way);
        }
    }
    return speed > gap ? gap / speed * (1 - 0x1p-50) : 1;
}

}  // namespace

LinearCcdResult inclusion_ccd(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin, const LinearCcdOptions& options) {
    LinearCcdResult result = InclusionSearch(type, t0, t1, dmin, options).run();
    // The first box starts at 0 however late the contact within it is.
    if (result.hit && result.toi == 0) result.toi = std::min(1.0, first_possible_contact(type, t0, t1, dmin));
    return result;
}

}  // namespace fettle::tests::support
