// SPDX-License-Identifier: MIT
#include "core/certificate/interval_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

using Bernstein = std::array<double, 4>;
// With more points, the box is tried first.
constexpr std::size_t few_points = 192;

// Coefficients of omega and omega', of z = x^2.
struct Coefficients {
    Interval b, c, b_g, c_g;
};

// An alternating series whose terms fall: the sum lies between its partial sums of three and of four terms.
Interval series(const Interval& z, const std::array<double, 4>& divisor) {
    const double next = (square(z) * z / Interval(std::abs(divisor[3]))).high;
    return Interval(1) / Interval(divisor[0]) + z / Interval(divisor[1]) + square(z) / Interval(divisor[2]) +
           (divisor[3] > 0 ? Interval(0, next) : Interval(-next, 0));
}

// Above 1/100 by quotients: the digits that they lose come back with the powers of theta that they are multiplied with.
Coefficients coefficients(const Interval& z, const Interval& sinc_x, const Interval& b) {
    if (z.low > 0.01) {
        const Interval cosine = Interval(1) - z * b, c = (Interval(1) - sinc_x) / z, sinc_g = (cosine - sinc_x) / z;
        return {b, c, (sinc_x - Interval(2) * b) / z, -((sinc_g + Interval(2) * c) / z)};
    }
    // Theta is so large that the rounding of theta0 + s w leaves nothing of it: c is the mean of (1 - p)^2/2 cos(p x) over 0 <= p <= 1, b_g
    // and c_g are those of -(1 - p) p^2 sinc(p x) and -(1 - p)^2 p^2/2 sinc(p x).
    if (z.high > 0.02) return {b, {-1.0 / 5, 1.0 / 5}, {-1.0 / 11, 1.0 / 11}, {-1.0 / 59, 1.0 / 59}};
    return {b, series(z, {6, -120, 5040, -362880}), series(z, {-12, 180, -6720, 453600}), series(z, {-60, 1260, -60480, 4989600})};
}

// The functionals' least values over a region: over its box, or in doubles over its points, whose rounding and whose share of the
// functionals' widths |X| bounds: 3 products and 2 sums are off by less than 4u |f||X| if nothing underflows.
template <std::size_t n>
std::array<double, n> least(const std::array<Interval3, n>& f, const Region& region, bool by_box) {
    std::array<double, n> values{};
    if (by_box) {
        const Interval3 box{Interval(region.low.x(), region.high.x()), Interval(region.low.y(), region.high.y()),
                            Interval(region.low.z(), region.high.z())};
        for (std::size_t i = 0; i < n; ++i) values[i] = dot(f[i], box).low;
        return values;
    }
    Eigen::Array<double, static_cast<int>(n), 3> middle;
    std::array<Interval3, n> width;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double m = 0.5 * (f[i][k].low + f[i][k].high);
            middle(static_cast<int>(i), static_cast<int>(k)) = m;
            width[i][k] = Interval((f[i][k] - Interval(m)).magnitude());
        }
    }
    Eigen::Array<double, static_cast<int>(n), 1> low;
    low.setConstant(std::numeric_limits<double>::infinity());
    for (const Vector3& x : region.points) low = low.min(middle.col(0) * x[0] + middle.col(1) * x[1] + middle.col(2) * x[2]);
    for (std::size_t i = 0; i < n; ++i) {
        const Interval rounding = Interval(0x1p-51) * Interval(norm_bound(f[i])) + Interval(norm_bound(width[i]));
        values[i] = (Interval(low(static_cast<int>(i))) - Interval(region.radius) * rounding - Interval(1e-300)).low;
    }
    return values;
}

// Coefficients k = 0 .. 3 of v^k on [-1, 1], in Bernstein form.
template <class Value>
std::array<Value, 4> bernstein(const std::array<Value, 4>& p) {
    const Interval third = Interval(1) / Interval(3);
    return {p[0] - p[1] + p[2] - p[3], p[0] - third * (p[1] + p[2]) + p[3], p[0] + third * (p[1] - p[2]) - p[3], p[0] + p[1] + p[2] + p[3]};
}

// The direction over an interval of half length `half`.
struct Plane {
    Interval3 middle, step;  // N, N'
    double half = 0;
};

// A body's part of n.y over the interval, in its frame.
std::array<Interval3, 4> functionals(const IntervalPose& pose, const Plane& n) {
    const Interval e(n.half), e2 = Interval(0.5) * square(e);
    const Interval3 n_omega = cross(n.middle, pose.omega), step_omega = cross(n.step, pose.omega);
    const Interval3 second = cross(n_omega, pose.omega) + cross(n.middle, pose.omega_rate);
    const Interval3 step_second = cross(step_omega, pose.omega) + cross(n.step, pose.omega_rate);
    std::array<Interval3, 4> g{n.middle, n.step + e * n_omega, e * step_omega + e2 * second, e2 * step_second};
    for (Interval3& v : g) v = transposed_times(pose.rotation, v);
    return bernstein(g);
}

std::array<Interval, 4> offsets(const Interval3& place, const Interval3& drift, const Plane& n) {
    const Interval e(n.half);
    return bernstein<Interval>({dot(n.middle, place), dot(n.step, place) + e * dot(n.middle, drift), e * dot(n.step, drift), Interval(0)});
}

Interval3 negative(const Interval3& f) { return {-f[0], -f[1], -f[2]}; }

// Upper bound of |w x Y| over a region: of an element by its corners.
double swept(const BodyPath& path, const Region& region) {
    const Interval3 box{Interval(region.low.x(), region.high.x()), Interval(region.low.y(), region.high.y()),
                        Interval(region.low.z(), region.high.z())};
    if (region.points.size() > 3) return norm_bound(times(path.sweep, box));
    double most = 0;
    for (const Vector3& x : region.points) most = std::max(most, norm_bound(times(path.sweep, exactly(x))));
    return most;
}

// Upper bound of |rest| for |n0|, |n1| <= length: of the same order always, along n much less where the body turns about it.
double rest(const BodyPath& path, const Region& region, double half, double length) {
    const Interval turn = Interval(half) * Interval(path.speed), reach = Interval(region.radius) * Interval(path.base_norm);
    return (Interval(length) * reach * turn * square(turn) / Interval(6)).high;
}

double rest_along(const BodyPath& path, const Region& region, double half, double length, const Interval3& n0, const Interval3& n1) {
    const Interval e(half), reach = Interval(region.radius) * Interval(path.base_norm), twist(path.twist_norm);
    const double crossed = std::max(norm_bound(cross(n0, path.step)), norm_bound(cross(n1, path.step)));
    const Interval outer = Interval(crossed) + Interval(length) * twist, inner = Interval(swept(path, region)) + reach * twist;
    return (e * square(e) * Interval(path.speed) * outer * inner / Interval(6)).high;
}

// Is the polynomial nowhere below the claim? Coefficients bound it from below; halves have averages of them, rounded down.
bool is_above(const Bernstein& c, double claim, int halvings) {
    if (std::min({c[0], c[1], c[2], c[3]}) >= claim) return true;
    if (!(c[0] >= claim && c[3] >= claim) || halvings == 0) return false;
    const auto mean = [](double x, double y) { return geometry::lower(0.5 * (x + y)); };
    const double a0 = mean(c[0], c[1]), a1 = mean(c[1], c[2]), a2 = mean(c[2], c[3]), b0 = mean(a0, a1), b1 = mean(a1, a2);
    const double m = mean(b0, b1);
    return is_above({c[0], a0, b0, m}, claim, halvings - 1) && is_above({m, b1, a2, c[3]}, claim, halvings - 1);
}

}  // namespace

BodyPath body_path(const stepper::Trajectory& trajectory, int step, int segment, int body) {
    BodyPath path;
    if (step < 0) {
        path.base = trajectory.poses.front()[body].rotation;
        path.place = exactly(trajectory.poses.front()[body].position);
    } else {
        const auto& nodes = trajectory.steps[step].nodes;
        const auto &first = nodes[segment][body], &last = nodes[segment + 1][body];
        path.base = trajectory.poses[step][body].rotation;
        path.theta = exactly(first.rotation_vector);
        path.step = exactly(last.rotation_vector) - path.theta;
        path.place = exactly(first.position);
        path.drift = exactly(last.position) - path.place;
        path.twist = cross(path.theta, path.step);
        path.speed = norm_bound(path.step);
        path.twist_norm = norm_bound(path.twist);
        for (int j = 0; j < 3; ++j) {
            const Interval3 column = cross(path.step, exactly(path.base.col(j)));
            for (std::size_t i = 0; i < 3; ++i) path.sweep[i][j] = column[i];
        }
    }
    // |B|^2 is at most the largest absolute row sum of B^T B.
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
        Interval sum = 0;
        for (int j = 0; j < 3; ++j) sum = sum + Interval(dot(exactly(path.base.col(i)), exactly(path.base.col(j))).magnitude());
        squared = std::max(squared, sum.high);
    }
    path.base_norm = sqrt(Interval(squared)).high;
    path.magnitude = norm_bound(path.theta) + path.speed + norm_bound(path.place) + norm_bound(path.drift) + path.base_norm;
    return path;
}

IntervalPose pose_at(const BodyPath& path, double s) {
    const Interval3 t = path.theta + Interval(s) * path.step;
    const Interval z = square(t[0]) + square(t[1]) + square(t[2]), x = sqrt(z);
    const Interval a = sinc(x), b = Interval(0.5) * square(sinc(Interval(0.5) * x)), cosine = Interval(1) - z * b;
    const Interval3 at = a * t, bt = b * t;
    const IntervalMatrix turn{Interval3{cosine + bt[0] * t[0], bt[0] * t[1] - at[2], bt[0] * t[2] + at[1]},
                              Interval3{bt[0] * t[1] + at[2], cosine + bt[1] * t[1], bt[1] * t[2] - at[0]},
                              Interval3{bt[0] * t[2] - at[1], bt[1] * t[2] + at[0], cosine + bt[2] * t[2]}};
    IntervalPose pose;
    for (std::size_t i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) pose.rotation[i][j] = dot(turn[i], exactly(path.base.col(j)));
    const Coefficients k = coefficients(z, a, b);
    const Interval3 t_twist = cross(t, path.twist);
    pose.omega = path.step + k.b * path.twist + k.c * t_twist;
    pose.omega_rate = k.c * cross(path.step, path.twist) + dot(t, path.step) * (k.b_g * path.twist + k.c_g * t_twist);
    return pose;
}

struct PathProver::Claim {
    double middle = 0;
    Plane n;
    Interval3 n0, n1;
    double length = 0;  // >= |n0|, |n1|
    double value = 0;   // >= lower length
    bool is_steady = false;
};

const PathProver::Instant& PathProver::at(double s) {
    const auto known = instants_.find(s);
    if (known != instants_.end()) return known->second;
    if (instants_.size() > 4096) instants_.clear();
    const Interval3 place = (a_.place - b_.place) + Interval(s) * (a_.drift - b_.drift);
    return instants_.emplace(s, Instant{pose_at(a_, s), pose_at(b_, s), place}).first->second;
}

bool PathProver::is_proven(const Claim& claim, const Region& a, const Region& b, bool by_boxes) {
    const bool box_a = by_boxes && a.points.size() > few_points, box_b = by_boxes && b.points.size() > few_points;
    const Instant& instant = at(claim.middle);
    const Interval3 drift = a_.drift - b_.drift;
    const Plane& n = claim.n;
    const Interval e(n.half);
    if (claim.is_steady) {
        const Interval3 of_a = transposed_times(instant.a.rotation, n.middle), of_b = transposed_times(instant.b.rotation, n.middle);
        const Interval turned = Interval(claim.length) * (Interval(a_.speed) * Interval(a_.base_norm) * Interval(a.radius) +
                                                          Interval(b_.speed) * Interval(b_.base_norm) * Interval(b.radius));
        const Interval apart = Interval(least<1>({of_a}, a, box_a)[0]) + Interval(least<1>({negative(of_b)}, b, box_b)[0]);
        const Interval value = apart + dot(n.middle, instant.place) - e * (turned + Interval(dot(n.middle, drift).magnitude()));
        if (value.low >= claim.value) return true;
    }
    std::array<Interval3, 4> of_a = functionals(instant.a, n), of_b = functionals(instant.b, n);
    for (Interval3& f : of_b) f = negative(f);
    const std::array<double, 4> least_a = least(of_a, a, box_a), least_b = least(of_b, b, box_b);
    std::array<Interval, 4> c = offsets(instant.place, drift, n);
    for (std::size_t i = 0; i < 4; ++i) c[i] = c[i] + Interval(least_a[i]) + Interval(least_b[i]);
    const auto is_enough = [&](double rest_a, double rest_b) {
        const Interval rests = Interval(rest_a) + Interval(rest_b);
        return is_above({(c[0] - rests).low, (c[1] - rests).low, (c[2] - rests).low, (c[3] - rests).low}, claim.value, 12);
    };
    if (!is_enough(0, 0)) return false;
    const double rest_a = rest(a_, a, n.half, claim.length), rest_b = rest(b_, b, n.half, claim.length);
    return is_enough(rest_a, rest_b) || is_enough(std::min(rest_a, rest_along(a_, a, n.half, claim.length, claim.n0, claim.n1)),
                                                  std::min(rest_b, rest_along(b_, b, n.half, claim.length, claim.n0, claim.n1)));
}

long PathProver::prove(const Region& a, const Region& b, const CoordinateBox& part, std::span<const Vector3> normals, double lower,
                       int halvings) {
    if (normals.size() != 1 && normals.size() != 2) return 0;
    return prove_span(a, b, {part.low[0], part.high[0]}, {normals.front(), normals.back()}, lower, halvings);
}

long PathProver::prove_span(const Region& a, const Region& b, const Span& span, const LeafPlane& plane, double lower, int halvings) {
    Claim claim;
    claim.middle = 0.5 * (span.start + span.end);
    const double half = claim.middle - span.start;
    if (!(half > 0) || half != span.end - claim.middle) return 0;  // too short to be halved exactly
    if (!plane.n0.allFinite() || !plane.n1.allFinite()) return 0;
    if (!(a_.magnitude < largest_magnitude && b_.magnitude < largest_magnitude && a.radius < largest_magnitude &&
          b.radius < largest_magnitude))
        return 0;
    claim.n0 = exactly(plane.n0);
    claim.n1 = exactly(plane.n1);
    claim.is_steady = plane.n0 == plane.n1;
    claim.length = std::max(norm_bound(claim.n0), norm_bound(claim.n1));
    if (!(claim.length > 1e-6 && claim.length < 1e6)) return 0;  // no direction; and what follows cannot overflow
    claim.n = {Interval(0.5) * (claim.n0 + claim.n1), Interval(0.5) * (claim.n1 - claim.n0), half};
    claim.value = (Interval(lower) * Interval(claim.length)).high;
    const bool many = a.points.size() > few_points || b.points.size() > few_points;
    if ((many && is_proven(claim, a, b, true)) || is_proven(claim, a, b, false)) return 1;
    if (halvings == 0) return 0;
    const Vector3 between = 0.5 * plane.n0 + 0.5 * plane.n1;
    const long first = prove_span(a, b, {span.start, claim.middle}, {plane.n0, between}, lower, halvings - 1);
    if (first == 0) return 0;
    const long second = prove_span(a, b, {claim.middle, span.end}, {between, plane.n1}, lower, halvings - 1);
    return second == 0 ? 0 : first + second;
}

Interval PathProver::distance_at(const Interval3& X_a, const Interval3& X_b, const Coordinates& at) const {
    const double s = at[0];
    const IntervalPose pose_a = pose_at(a_, s), pose_b = pose_at(b_, s);
    const Interval3 between = (a_.place - b_.place) + Interval(s) * (a_.drift - b_.drift);
    const Interval3 d = times(pose_a.rotation, X_a) - times(pose_b.rotation, X_b) + between;
    return sqrt(square(d[0]) + square(d[1]) + square(d[2]));
}

double PathProver::witness_room(const Interval3& X_a, const Interval3& X_b) const {
    double size = norm_bound(X_a) + norm_bound(X_b), turned = 1;
    for (const BodyPath* path : {&a_, &b_}) {
        size += norm_bound(path->place) + norm_bound(path->drift);
        turned += norm_bound(path->theta) + path->speed;
    }
    return 1e-11 * size * turned + 1e-300;
}

}  // namespace fettle::core::certificate
