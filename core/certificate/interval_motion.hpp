// SPDX-License-Identifier: MIT
/// The certificate checker's own mathematics of a path: rigid motion and the bound of a leaf in interval arithmetic. Ranges of joints have
/// theirs in range_prover.hpp. The checker uses it, and so does the code that checker and search share (disjoint_solids.hpp); the search
/// for distances uses nothing of it.
///
/// Motion. R(s) = exp([theta]) B, theta = theta0 + s w, B the stored base as it is. R' = [omega] R with, x = |theta|,
///   omega = w + b k + c theta x k,   k = theta x w = theta0 x w (constant),   b = (1 - cos x)/x^2,   c = (x - sin x)/x^3,
///   omega' = c w x k + (theta.w) (b_g k + c_g theta x k),   f_g = (df/dx)/x.
/// R''' is the mean of e^{p theta} [w] e^{q theta} [w] e^{r theta} [w] e^{t theta} B over p + q + r + t = 1, p, q, r, t >= 0 (Duhamel). As
/// |e^{p theta} w - w| <= p |k|, the outer two factors are at most |n x w| + |n||k| and |w x Y| + |Y||k|, Y = B X:
///   |n.x'''| <= M(n) = |w| (|n x w| + |n||k|) (|w x Y| + |Y||k|),   and   |n.x'''| <= |n||w|^3 |Y|.
///
/// A leaf. Let the interval's middle be m, its half length e, v = (s - m)/e in [-1, 1], N = (n0 + n1)/2, N' = (n1 - n0)/2. By Taylor at m,
///   n.x = sum of v^k (g_k.y + r_k) + rest,   y = R(m) X,   S(n) = (n x omega) x omega + n x omega' (so that S(n).y = n.y''),
///   g_0 = N,  g_1 = N' + e N x omega,  g_2 = e N' x omega + e^2/2 S(N),  g_3 = e^2/2 S(N'),
///   r_0 = N.q(m),  r_1 = N'.q(m) + e N.q',  r_2 = e N'.q',  r_3 = 0,   |rest| <= e^3/6 max(M(n0), M(n1)), M being convex.
/// In Bernstein form over v each coefficient is linear in X; the least value over a piece of A and the largest over one of B (over all
/// corners, or over a box if that is enough) give a polynomial below n.(x_a - x_b) for all their points. If that, less the rests, is
/// nowhere below lower L, L >= |n0|, |n1|, L > 0, the leaf's claim is proven: dist >= n.(x_a - x_b)/|n| >= lower. With n0 = n1 the values
/// at m less what points can move until the ends may do. If all that fails, the interval is halved. Why that ends in a proof wherever
/// there is some room above the claim: certificate_checker.hpp.
#pragma once

#include <array>
#include <map>
#include <span>

#include "core/base/types.hpp"
#include "core/certificate/certificate.hpp"
#include "core/geometry/interval.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::certificate {

using geometry::Interval;
using geometry::Interval3;
using IntervalMatrix = std::array<Interval3, 3>;  ///< rows

inline Vector3 middle(const Interval3& x) {
    return {0.5 * (x[0].low + x[0].high), 0.5 * (x[1].low + x[1].high), 0.5 * (x[2].low + x[2].high)};
}
inline Matrix3 middle(const IntervalMatrix& m) {
    Matrix3 out;
    for (int i = 0; i < 3; ++i) out.row(i) = middle(m[i]);
    return out;
}
inline Interval3 exactly(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
inline Interval3 operator+(const Interval3& a, const Interval3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Interval3 operator-(const Interval3& a, const Interval3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Interval3 operator*(const Interval& s, const Interval3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Interval dot(const Interval3& a, const Interval3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Interval3 times(const IntervalMatrix& m, const Interval3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
inline Interval3 transposed_times(const IntervalMatrix& m, const Interval3& v) { return v[0] * m[0] + v[1] * m[1] + v[2] * m[2]; }

/// One body on one path segment, the stored numbers as they are.
struct BodyPath {
    Matrix3 base = Matrix3::Identity();
    Interval3 theta, step;                            ///< theta0, w
    Interval3 place, drift;                           ///< q at 0, q'
    Interval3 twist;                                  ///< k
    IntervalMatrix sweep;                             ///< [w] B
    double speed = 0, twist_norm = 0, base_norm = 1;  ///< upper bounds of |w|, |k|, |B|
    double magnitude = 0;                             ///< of all numbers: what is larger than 1e30 proves nothing, so nothing overflows
};

/// Step -1: the start pose, held.
BodyPath body_path(const stepper::Trajectory& trajectory, int step, int segment, int body);

struct IntervalPose {
    IntervalMatrix rotation;      ///< with the base
    Interval3 omega, omega_rate;  ///< omega'
};
IntervalPose pose_at(const BodyPath& path, double s);

/// What is bounded, in the body's frame: some points, the box that they span, and `radius` >= |X| of each.
struct Region {
    std::span<const Vector3> points;
    Vector3 low = Vector3::Zero(), high = Vector3::Zero();
    double radius = 0;
    std::span<const int> vertices{};  ///< of the body's mesh: those that the points are
};

struct Span {
    double start = 0, end = 1;
};

/// Two bodies on one segment: a box of one coordinate, s in [0, 1]. Keeps poses: leaves share few intervals of time.
class PathProver {
public:
    PathProver(const BodyPath& a, const BodyPath& b) : a_(a), b_(b) {}

    static constexpr int coordinates() { return 1; }
    static CoordinateBox box() { return {{0}, {1}}; }

    /// In how many parts of a part of the box is n(u).(x_a - x_b) >= lower max|n| > 0 proven, for all of it and of the regions? 0: it is
    /// not.
    /// @param normals   one, or one for each end
    /// @param halvings  how often parts may be halved, `part` itself first
    long prove(const Region& a, const Region& b, const CoordinateBox& part, std::span<const Vector3> normals, double lower, int halvings);

    /// Distance of two points of the bodies, at a place of the box.
    Interval distance_at(const Interval3& X_a, const Interval3& X_b, const Coordinates& at) const;
    /// How far a bound that these two points attain may be above their distance, for rounding.
    double witness_room(const Interval3& X_a, const Interval3& X_b) const;

private:
    struct Instant {
        IntervalPose a, b;
        Interval3 place;  // q_a - q_b
    };
    struct Claim;
    const Instant& at(double s);
    bool is_proven(const Claim& claim, const Region& a, const Region& b, bool by_boxes);
    long prove_span(const Region& a, const Region& b, const Span& span, const LeafPlane& plane, double lower, int halvings);

    BodyPath a_, b_;
    std::map<double, Instant> instants_;
};

}  // namespace fettle::core::certificate
