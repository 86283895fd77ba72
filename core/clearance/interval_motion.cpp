// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/interval_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::clearance::checker {
namespace {

using Bernstein = std::array<double, 4>;

Interval3 exactly(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Interval3 operator+(const Interval3& a, const Interval3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Interval3 operator-(const Interval3& a, const Interval3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Interval3 operator*(const Interval& s, const Interval3& a) { return {s * a[0], s * a[1], s * a[2]}; }
Interval dot(const Interval3& a, const Interval3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Interval3 times(const IntervalMatrix& m, const Interval3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
Interval3 transposed_times(const IntervalMatrix& m, const Interval3& v) { return v[0] * m[0] + v[1] * m[1] + v[2] * m[2]; }

// (x - sin x)/x^3 where z = x^2: below 1/100 by its alternating series, whose terms fall.
Interval third_coefficient(const Interval& z, const Interval& sinc_x) {
    if (z.low > 0.01) return (Interval(1) - sinc_x) / z;
    const Interval cube = z * square(z) / Interval(362880);
    const Interval sum = Interval(1) / Interval(6) - z / Interval(120) + square(z) / Interval(5040) - Interval(0, std::max(0.0, cube.high));
    return z.high <= 1 ? sum : Interval(0, 1.0 / 5);  // 0 <= c <= 1/6 everywhere
}

// A functional's least value over a region.
double least(const Interval3& f, const Region& region) {
    if (region.points.empty()) {
        const Interval3 box{Interval(region.low.x(), region.high.x()), Interval(region.low.y(), region.high.y()),
                            Interval(region.low.z(), region.high.z())};
        return dot(f, box).low;
    }
    double value = std::numeric_limits<double>::infinity();
    for (const Vector3& x : region.points) value = std::min(value, dot(f, exactly(x)).low);
    return value;
}

// Coefficients k = 0 .. 3 of v^k on [-1, 1], in Bernstein form.
template <class Value>
std::array<Value, 4> bernstein(const std::array<Value, 4>& p) {
    const Interval third = Interval(1) / Interval(3);
    return {p[0] - p[1] + p[2] - p[3], p[0] - third * (p[1] + p[2]) + p[3], p[0] + third * (p[1] - p[2]) - p[3], p[0] + p[1] + p[2] + p[3]};
}

// A body's part of n.x over the interval: functionals in its frame, and offsets.
struct Part {
    std::array<Interval3, 4> functional;
    std::array<Interval, 4> offset;
};

Part part_of(const BodyPath& path, double middle, double half, const Interval3& n, const Interval3& n_step) {
    const IntervalPose pose = pose_at(path, middle);
    const Interval e(half), e2 = Interval(0.5) * square(e);
    const Interval3 n_omega = cross(n, pose.omega), n_step_omega = cross(n_step, pose.omega);
    std::array<Interval3, 4> g{n, n_step + e * n_omega, e * n_step_omega + e2 * cross(n_omega, pose.omega),
                               e2 * cross(n_step_omega, pose.omega)};
    for (Interval3& v : g) v = transposed_times(pose.rotation, v);
    const std::array<Interval, 4> r{dot(n, pose.place), dot(n_step, pose.place) + e * dot(n, path.drift), e * dot(n_step, path.drift),
                                    Interval(0)};
    return {bernstein(g), bernstein(r)};
}

double rest(const BodyPath& path, const Region& region, double half) {
    const Interval e(half), w(path.speed), k(path.twist_norm);
    return (Interval(region.radius) * Interval(path.base_norm) *
            (e * square(e) * w * square(w) / Interval(6) + square(e) * w * k / Interval(12)))
        .high;
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
    }
    // |B|^2 is at most the largest absolute row sum of B^T B.
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        Interval sum = 0;
        for (int j = 0; j < 3; ++j) sum = sum + Interval(dot(exactly(path.base.col(i)), exactly(path.base.col(j))).magnitude());
        largest = std::max(largest, sum.high);
    }
    path.base_norm = sqrt(Interval(largest)).high;
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
        for (int j = 0; j < 3; ++j) pose.rotation[i][static_cast<std::size_t>(j)] = dot(turn[i], exactly(path.base.col(j)));
    pose.place = path.place + Interval(s) * path.drift;
    pose.omega = path.step + b * path.twist + third_coefficient(z, a) * cross(t, path.twist);
    return pose;
}

bool prove_leaf(const BodyPath& a, const BodyPath& b, const Region& region_a, const Region& region_b, const Span& span,
                const LeafPlane& plane, double lower, int halvings) {
    const double middle = 0.5 * (span.start + span.end), half = middle - span.start;
    if (!(half > 0) || half != span.end - middle) return false;  // too short to be halved exactly
    const Interval3 n0 = exactly(plane.n0), n1 = exactly(plane.n1);
    const double length = std::max(norm_bound(n0), norm_bound(n1));
    if (!(length > 1e-6 && length < 1e6)) return false;  // no direction; and what follows cannot overflow
    const Interval3 n = Interval(0.5) * (n0 + n1), n_step = Interval(0.5) * (n1 - n0);
    const Part part_a = part_of(a, middle, half, n, n_step), part_b = part_of(b, middle, half, n, n_step);
    const Interval rests = Interval(length) * (Interval(rest(a, region_a, half)) + Interval(rest(b, region_b, half)));
    Bernstein c{};
    for (std::size_t i = 0; i < 4; ++i) {
        const Interval3 minus_b{-part_b.functional[i][0], -part_b.functional[i][1], -part_b.functional[i][2]};
        const Interval sum = Interval(least(part_a.functional[i], region_a)) + Interval(least(minus_b, region_b)) +
                             (part_a.offset[i] - part_b.offset[i]) - rests;
        c[i] = sum.low;
    }
    if (is_above(c, (Interval(lower) * Interval(length)).high, 12)) return true;
    if (halvings == 0) return false;
    const Vector3 between = 0.5 * plane.n0 + 0.5 * plane.n1;
    return prove_leaf(a, b, region_a, region_b, {span.start, middle}, {plane.n0, between}, lower, halvings - 1) &&
           prove_leaf(a, b, region_a, region_b, {middle, span.end}, {between, plane.n1}, lower, halvings - 1);
}

Interval distance_at(const BodyPath& a, const BodyPath& b, const Interval3& X_a, const Interval3& X_b, double s) {
    const IntervalPose pose_a = pose_at(a, s), pose_b = pose_at(b, s);
    const Interval3 d = times(pose_a.rotation, X_a) - times(pose_b.rotation, X_b) + (pose_a.place - pose_b.place);
    return sqrt(square(d[0]) + square(d[1]) + square(d[2]));
}

}  // namespace fettle::core::clearance::checker
