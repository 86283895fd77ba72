// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/geometry/rounded_sides.hpp"

namespace fettle::core::geometry {
namespace {

// With d = t2 - t1 and s = t1 + t2 the formulas keep their digits at small turns:
//   1 - c = d.d/2,  1 + c = s.s/2,  tan(phi/2) = |d|/|s|,  tan(phi/4) = |d|/(2 + |s|).
struct Corner {
    Vector3 t1, t2, d, s;
    double length1, length2, tau;
    double share1, share2;  // of tau in the two lengths
    double D, S;            // |d|, |s|

    explicit Corner(const std::array<Vector3, 3>& p) : t1(p[1] - p[0]), t2(p[2] - p[1]), length1(t1.norm()), length2(t2.norm()) {
        t1 /= length1;
        t2 /= length2;
        d = t2 - t1;
        s = t1 + t2;
        D = d.norm();
        S = s.norm();
        tau = std::min(length1, length2) / 2;
        // The derivative of the minimum of equal lengths is taken as the mean of both: symmetric, as a circle's.
        const bool equal = std::abs(length1 - length2) <= 1e-12 * std::max(length1, length2);
        share1 = equal ? 0.25 : length1 < length2 ? 0.5 : 0;
        share2 = 0.5 - share1;
    }
};

}  // namespace

RoundedCorner rounded_corner(const Vector3& p0, const Vector3& p1, const Vector3& p2) {
    const Corner k({p0, p1, p2});
    return {p1 + 2 * k.tau / (k.D * k.D) * k.d, k.tau * k.S / k.D, k.tau * k.D / (2 + k.S)};
}

RoundedCorner rounded_corner_tangent(const std::array<Vector3, 3>& p, const std::array<Vector3, 3>& p_dot) {
    const Corner k(p);
    const Vector3 e1_dot = p_dot[1] - p_dot[0], e2_dot = p_dot[2] - p_dot[1];
    const double length1_dot = k.t1.dot(e1_dot), length2_dot = k.t2.dot(e2_dot);
    const Vector3 t1_dot = (e1_dot - length1_dot * k.t1) / k.length1, t2_dot = (e2_dot - length2_dot * k.t2) / k.length2;
    const double tau_dot = k.share1 * length1_dot + k.share2 * length2_dot;
    const Vector3 d_dot = t2_dot - t1_dot;
    const double D_dot = k.d.dot(d_dot) / k.D, S_dot = k.s.dot(t1_dot + t2_dot) / k.S;
    RoundedCorner out;
    out.centre = p_dot[1] + 2 / (k.D * k.D) * ((tau_dot - 2 * k.tau * D_dot / k.D) * k.d + k.tau * d_dot);
    out.radius = (tau_dot * k.S + k.tau * S_dot - k.tau * k.S * D_dot / k.D) / k.D;
    out.height = (tau_dot * k.D + k.tau * D_dot - k.tau * k.D * S_dot / (2 + k.S)) / (2 + k.S);
    return out;
}

std::array<Vector3, 3> rounded_corner_adjoint(const std::array<Vector3, 3>& p, const RoundedCorner& bar) {
    const Corner k(p);
    const double along = k.d.dot(bar.centre), square = k.D * k.D, sum = 2 + k.S;
    const double tau_bar = 2 * along / square + bar.radius * k.S / k.D + bar.height * k.D / sum;
    const double D_bar = k.tau * (-4 * along / (square * k.D) - bar.radius * k.S / square + bar.height / sum);
    const double S_bar = k.tau * (bar.radius / k.D - bar.height * k.D / (sum * sum));
    const Vector3 d_bar = 2 * k.tau / square * bar.centre + D_bar / k.D * k.d, s_bar = S_bar / k.S * k.s;
    const Vector3 t1_bar = s_bar - d_bar, t2_bar = s_bar + d_bar;
    const Vector3 e1_bar = (t1_bar - k.t1.dot(t1_bar) * k.t1) / k.length1 + k.share1 * tau_bar * k.t1;
    const Vector3 e2_bar = (t2_bar - k.t2.dot(t2_bar) * k.t2) / k.length2 + k.share2 * tau_bar * k.t2;
    return {-e1_bar, bar.centre + e1_bar - e2_bar, e2_bar};
}

}  // namespace fettle::core::geometry
