// SPDX-License-Identifier: MIT
#include "core/ccd/linear_ccd.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/ccd/separating_plane.hpp"

namespace fettle::core::ccd {

namespace {

/// However many are allowed: advancement that needs more creeps within rounding, where more of it proves next to nothing.
constexpr int most_directions = 5000;

/// Steps along fixed planes before planes that turn are tried as well.
constexpr int patience = 2;

/// First time after t at which a vertex pair falls to `level` (below every value at t), or infinity.
double first_crossing(const SeparatingPlane& s, double level, double t) {
    const Lanes values = s.values(t);
    double first = INFINITY;
    for (int i = 0; i < 4; ++i) {
        if (s.q[i] >= level) continue;
        first = std::min(first, t + (1 - t) * ((values[i] - level) / (values[i] - s.q[i])));
    }
    return first;
}

/// Does the plane that turns linearly from a's at time ta to b's at time tb separate the pair all along? L_ij is then quadratic, and its
/// coefficients in Bernstein's basis are bounds.
bool separated_by_turning(const SeparatingPlane& a, double ta, const SeparatingPlane& b, double tb) {
    const double limit = std::max(a.limit, b.limit);
    return a.least(ta) > limit && b.least(tb) > limit && (0.5 * a.values(tb) + 0.5 * b.values(ta)).minCoeff() > limit;
}

class Advancement {
public:
    Advancement(const RelativeMotion& motion, double dmin, const LinearCcdOptions& options)
        : motion_(motion), dmin_(dmin), options_(options) {}

    LinearCcdResult run() {
        SeparatingPlane s = plane_at(0);
        if (!(s.gap > 0)) return {true, 0};
        threshold_ = std::min(options_.tolerance, hit_share * s.gap);
        for (int i = 0; i < std::min(options_.max_iterations, most_directions); ++i) {
            if (i > 0) s = better(plane_at(time_), s);
            if (!(s.gap > threshold_)) break;
            if (!advance(s)) break;
            if (time_ >= 1) return {};
        }
        return {true, time_};
    }

private:
    SeparatingPlane plane_at(double t) const {
        const Differences r = motion_.at(t);
        const ClosestDirection c = closest_direction(motion_.type, r);
        SeparatingPlane best = separating_plane(motion_, c.direction, dmin_, t);
        if (best.gap > threshold_ ? c.is_attained_by(best.gap + dmin_) : c.distance_squared <= square(dmin_ + threshold_)) return best;
        const CandidateDirections all = candidate_directions(motion_.type, r);
        for (int i = 0; i < all.count; ++i) best = better(best, separating_plane(motion_, all.direction[i], dmin_, t));
        return best;
    }

    static double square(double x) { return x * x; }
    static const SeparatingPlane& better(const SeparatingPlane& a, const SeparatingPlane& b) { return a.gap >= b.gap ? a : b; }

    /// From time_, where s separates, as far as s or a plane that turns does. False if there is no progress.
    bool advance(SeparatingPlane& s) {
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
        const SeparatingPlane turned =
            separating_plane(motion_, closest_direction(motion_.type, motion_.at(ahead)).direction, dmin_, ahead);
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

LinearCcdResult linear_ccd(geometry::PairType type, const geometry::PairVertices& t0, const geometry::PairVertices& t1, double dmin,
                           const LinearCcdOptions& options) {
    FETTLE_ASSERT(dmin >= 0, "a minimum separation is not negative");
    const RelativeMotion m = relative_motion(type, t0, t1);
    if (!m.usable) return {true, 0};
    if (separated_along_axis(m, dmin)) return {};
    return Advancement(m, dmin, options).run();
}

double distance_lower_bound(geometry::PairType type, const geometry::PairVertices& x) {
    const Differences r = differences(type, x);
    const Vector3 largest = r.abs().colwise().maxCoeff().matrix().transpose();
    if (!((0 * r).sum() == 0 && largest.maxCoeff() < 1e150)) return 0;
    const ClosestDirection closest = closest_direction(type, r);
    double best = std::max(0.0, separating_plane_at_rest(r, largest, closest.direction, 0).gap);
    if (best > 0 && closest.is_attained_by(best)) return best;
    const CandidateDirections all = candidate_directions(type, r);
    for (int i = 0; i < all.count; ++i) best = std::max(best, separating_plane_at_rest(r, largest, all.direction[i], 0).gap);
    return best;
}

}  // namespace fettle::core::ccd
