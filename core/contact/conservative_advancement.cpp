// SPDX-License-Identifier: MIT
#include "fettle/core/contact/conservative_advancement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fettle/core/geometry/distance.hpp"

namespace fettle::core::contact {

namespace {

constexpr double u = 0x1p-53;

/// Share of the first gap at which an approach counts as a hit.
constexpr double gap_share = 0.1;

/// Steps along fixed planes before planes that turn are tried as well.
constexpr int patience = 2;

struct VertexPair {
    std::size_t first, second;
};
constexpr std::array<VertexPair, 4> point_triangle_pairs{{{0, 1}, {0, 2}, {0, 3}, {0, 3}}};
constexpr std::array<VertexPair, 4> edge_edge_pairs{{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};

/// x_i - x_j of the pair's vertices at both times; entry 3 of a point and a triangle repeats entry 2.
struct RelativeMotion {
    PairType type;
    std::array<Vector3, 4> d, e;
    Vector3 largest;  ///< D_k of the header
    bool finite;
};

RelativeMotion relative_motion(PairType type, const PairVertices& t0, const PairVertices& t1) {
    const auto& pairs = type == PairType::point_triangle ? point_triangle_pairs : edge_edge_pairs;
    RelativeMotion m;
    m.type = type;
    m.largest.setZero();
    Vector3 zero = Vector3::Zero();  // not a number as soon as anything is not finite, which comparisons would pass over
    for (std::size_t i = 0; i < 4; ++i) {
        m.d[i] = t0[pairs[i].first] - t0[pairs[i].second];
        m.e[i] = t1[pairs[i].first] - t1[pairs[i].second];
        m.largest = m.largest.cwiseMax(m.d[i].cwiseAbs()).cwiseMax(m.e[i].cwiseAbs());
        zero += 0.0 * m.d[i] + 0.0 * m.e[i];
    }
    m.finite = zero.sum() == 0;
    return m;
}

/// One axis separates the pair at both ends of the motion, and on the same side: the commonest way for candidates to miss.
bool separated_along_axis(const RelativeMotion& m, double dmin) {
    const double limit = dmin * (1 + 16 * u);
    for (int k = 0; k < 3; ++k) {
        double low = m.d[0][k], high = low;
        for (std::size_t i = 0; i < 4; ++i) {
            low = std::min({low, m.d[i][k], m.e[i][k]});
            high = std::max({high, m.d[i][k], m.e[i][k]});
        }
        if (low > limit || high < -limit) return true;
    }
    return false;
}

/// The pair's vertices at time t, relative to one of them.
PairVertices vertices_at(const RelativeMotion& m, double t) {
    std::array<Vector3, 4> r;
    for (std::size_t i = 0; i < 4; ++i) r[i] = (1 - t) * m.d[i] + t * m.e[i];
    if (m.type == PairType::point_triangle) return {Vector3::Zero(), -r[0], -r[1], -r[2]};
    return {r[0], r[2], Vector3::Zero(), r[0] - r[1]};
}

Vector3 combination(const std::array<double, 4>& weight, const PairVertices& x) {
    return weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2] + weight[3] * x[3];
}

struct Closest {
    Vector3 direction;
    double distance;  ///< computed: neither bound is proven
};

/// Direction of the closest points' difference. Where it is normal to an edge or a face it is computed as such: the difference itself
/// is off by u times the size of the pair, which tilts it by much more than u when the distance is small.
Closest closest(PairType type, const PairVertices& x) {
    const geometry::ClosestPoints c = type == PairType::point_triangle ? geometry::point_triangle_closest(x[0], x[1], x[2], x[3])
                                                                       : geometry::edge_edge_closest(x[0], x[1], x[2], x[3]);
    const double distance = std::sqrt(c.distance_squared);
    if (c.free_count == 0) return {c.difference, distance};
    const Vector3 e = combination(c.free_weight[0], x);
    if (c.free_count == 2) return {e.cross(combination(c.free_weight[1], x)), distance};
    Vector3 r = c.difference;
    const double ee = e.squaredNorm();
    if (ee > 0) {
        r -= (r.dot(e) / ee) * e;
        r -= (r.dot(e) / ee) * e;
    }
    return {r, distance};
}

/// Along one unit direction: the header's p and q, and the value that certifies.
struct Separation {
    Vector3 n;
    std::array<double, 4> p, q;
    double limit;     ///< dmin (1 + 16 u) + 1.01 E
    double gap = -1;  ///< min_ij L_ij(t) - limit; stays negative if anything is not a number

    double at(std::size_t i, double t) const { return (1 - t) * p[i] + t * q[i]; }
    double least(double t) const { return std::min({at(0, t), at(1, t), at(2, t), at(3, t)}); }
};

/// `direction` of any length, either sign.
Separation separation(const RelativeMotion& m, const Vector3& direction, double dmin, double t) {
    Separation s;
    const double size = direction.cwiseAbs().maxCoeff();
    if (!(size > 0) || !std::isfinite(size)) return s;
    Vector3 n = direction / size;
    n /= n.norm();
    double highest = -INFINITY, lowest = INFINITY;
    for (std::size_t i = 0; i < 4; ++i) {
        s.p[i] = n.dot(m.d[i]);
        s.q[i] = n.dot(m.e[i]);
        const double value = s.at(i, t);
        if (std::isnan(value)) return s;
        highest = std::max(highest, value);
        lowest = std::min(lowest, value);
    }
    s.n = n;
    if (-highest > lowest) {
        s.n = -n;
        for (std::size_t i = 0; i < 4; ++i) {
            s.p[i] = -s.p[i];
            s.q[i] = -s.q[i];
        }
        lowest = -highest;
    }
    const double error = 8 * u * n.cwiseAbs().dot(m.largest) + 1e-290;
    s.limit = dmin * (1 + 16 * u) + 1.01 * error;
    const double gap = lowest - s.limit;
    if (gap > 0) s.gap = gap;
    return s;
}

/// For slivers and nearly parallel edges, where the closest points are unreliable: the best of all directions that could separate.
Separation best_separation(const RelativeMotion& m, const PairVertices& x, double dmin, double t) {
    Separation best;
    const auto consider = [&](const Vector3& direction) {
        const Separation s = separation(m, direction, dmin, t);
        if (s.gap > best.gap) best = s;
    };
    const auto consider_point_edge = [&](std::size_t p, std::size_t a, std::size_t b) {
        const Vector3 e = x[b] - x[a], w = x[p] - x[a];
        const double ee = e.squaredNorm();
        const double at = ee > 0 ? std::clamp(w.dot(e) / ee, 0.0, 1.0) : 0.0;
        consider(w - at * e);
        consider(e.cross(w).cross(e));
        consider(w);
    };
    if (m.type == PairType::point_triangle) {
        consider((x[2] - x[1]).cross(x[3] - x[1]));
        consider((x[3] - x[2]).cross(x[1] - x[2]));
        consider((x[1] - x[3]).cross(x[2] - x[3]));
        consider_point_edge(0, 1, 2);
        consider_point_edge(0, 2, 3);
        consider_point_edge(0, 3, 1);
    } else {
        consider((x[1] - x[0]).cross(x[3] - x[2]));
        consider_point_edge(0, 2, 3);
        consider_point_edge(1, 2, 3);
        consider_point_edge(2, 0, 1);
        consider_point_edge(3, 0, 1);
    }
    for (int k = 0; k < 3; ++k) consider(Vector3::Unit(k));
    return best;
}

/// First time after t at which a vertex pair falls to `level` (below every value at t), or infinity.
double first_crossing(const Separation& s, double level, double t) {
    double first = INFINITY;
    for (std::size_t i = 0; i < 4; ++i) {
        const double value = s.at(i, t);
        if (s.q[i] >= level) continue;
        first = std::min(first, t + (1 - t) * ((value - level) / (value - s.q[i])));
    }
    return first;
}

/// Does the plane that turns linearly from a's at time ta to b's at tb separate the pair all along? L_ij is then quadratic, and its
/// coefficients in Bernstein's basis are bounds.
bool separated_by_turning(const Separation& a, double ta, const Separation& b, double tb) {
    const double limit = std::max(a.limit, b.limit);
    for (std::size_t i = 0; i < 4; ++i) {
        if (!(a.at(i, ta) > limit && b.at(i, tb) > limit && 0.5 * a.at(i, tb) + 0.5 * b.at(i, ta) > limit)) return false;
    }
    return true;
}

class Advancement {
public:
    Advancement(const RelativeMotion& motion, double dmin, const LinearCcdOptions& options)
        : motion_(motion), dmin_(dmin), options_(options) {}

    LinearCcdResult run() {
        Separation s = direction_at(0);
        if (!(s.gap > 0)) return {true, 0};
        threshold_ = std::min(options_.tolerance, gap_share * s.gap);
        for (int i = 0; i < options_.max_iterations; ++i) {
            if (i > 0) s = better(direction_at(time_), s);
            if (!(s.gap > threshold_)) break;
            if (!advance(s)) break;
            if (time_ >= 1) return {};
        }
        return {true, time_};
    }

private:
    Separation direction_at(double t) const {
        const PairVertices x = vertices_at(motion_, t);
        const Closest c = closest(motion_.type, x);
        const Separation s = separation(motion_, c.direction, dmin_, t);
        const bool unreliable = !(s.gap > threshold_) && !(c.distance <= dmin_ + threshold_);
        return unreliable ? best_separation(motion_, x, dmin_, t) : s;
    }

    Separation better(const Separation& a, const Separation& b) const { return a.gap >= b.gap ? a : b; }

    /// From time_, where s separates, as far as s or a plane that turns does. False if there is no progress.
    bool advance(Separation& s) {
        const double from = time_;
        const double next = first_crossing(s, s.limit + 0.5 * threshold_, from);
        for (const double end : {std::min(next, 1.0), from + 0.5 * (next - from)}) {
            if (end > time_ && s.least(end) > s.limit) {
                time_ = end;
                break;
            }
        }
        if (!(time_ > from)) return false;
        s.gap = s.least(time_) - s.limit;
        if (time_ >= 1 || ++steps_ < patience) return true;
        const double ahead = std::min(1.0, from + reach_ * (time_ - from));
        const Separation turned = separation(motion_, closest(motion_.type, vertices_at(motion_, ahead)).direction, dmin_, ahead);
        if (turned.gap > threshold_ && separated_by_turning(s, from, turned, ahead)) {
            time_ = ahead;
            s = turned;
            reach_ = std::min(4 * reach_, 1e6);
        } else {
            reach_ = std::max(0.5 * reach_, 2.0);
        }
        return true;
    }

    const RelativeMotion& motion_;
    double dmin_;
    const LinearCcdOptions& options_;
    double time_ = 0, threshold_ = 0;
    int steps_ = 0;
    double reach_ = 4;  ///< how far ahead, in steps along a fixed plane, the turning plane is tried
};

}  // namespace

LinearCcdResult conservative_advancement(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin,
                                         const LinearCcdOptions& options) {
    const RelativeMotion m = relative_motion(type, t0, t1);
    if (!m.finite) return {true, 0};
    if (separated_along_axis(m, dmin)) return {};
    return Advancement(m, dmin, options).run();
}

double distance_lower_bound(PairType type, const PairVertices& x) {
    const RelativeMotion m = relative_motion(type, x, x);
    if (!m.finite) return 0;
    const PairVertices at_rest = vertices_at(m, 0);
    const Separation s = separation(m, closest(type, at_rest).direction, 0, 0);
    return s.gap > 0 ? s.gap : std::max(0.0, best_separation(m, at_rest, 0, 0).gap);
}

}  // namespace fettle::core::contact
