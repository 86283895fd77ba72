// SPDX-License-Identifier: MIT
#include "core/scene/curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fettle::core::scene {
namespace {

// Distance as a share, of time as a share: thirds of even acceleration, even speed, even deceleration.
double trapezoid_share(double s) {
    constexpr double ramp = 1.0 / 3, top_speed = 1 / (1 - ramp);
    if (s < ramp) return 0.5 * top_speed / ramp * s * s;
    if (s > 1 - ramp) return 1 - 0.5 * top_speed / ramp * (1 - s) * (1 - s);
    return top_speed * (s - 0.5 * ramp);
}

// d(slope at entry k)/d(values): that of the parabola through three entries; 0 at the ends.
void add_slope(const std::vector<double>& t, std::size_t k, double weight, std::vector<double>& weights) {
    if (k == 0 || k + 1 == t.size()) return;
    const double before = t[k] - t[k - 1], after = t[k + 1] - t[k], all = before + after;
    weights[k - 1] -= weight * after / (before * all);
    weights[k + 1] += weight * before / (after * all);
    weights[k] += weight * (after - before) / (before * after);
}

// De Boor's recursion on the weights of the four control points that count.
void add_spline(const Curve& curve, double time, std::vector<double>& weights) {
    constexpr int degree = 3;
    const auto count = count_of(curve.values), spans = count - degree;
    const double begin = curve.times.front(), end = curve.times.back();
    const double x = std::clamp((time - begin) / (end - begin), 0.0, 1.0) * spans;
    const int span = std::min(static_cast<int>(x), spans - 1);
    const auto knot = [&](int i) { return static_cast<double>(std::clamp(i - degree, 0, spans)); };
    std::vector<std::vector<double>> point(degree + 1, std::vector<double>(degree + 1, 0.0));
    for (int j = 0; j <= degree; ++j) point[j][j] = 1;
    for (int level = 1; level <= degree; ++level)
        for (int j = degree; j >= level; --j) {
            const double low = knot(span + j), high = knot(span + j + 1 + degree - level);
            const double share = (x - low) / (high - low);
            for (int k = 0; k <= degree; ++k) point[j][k] = (1 - share) * point[j - 1][k] + share * point[j][k];
        }
    for (int k = 0; k <= degree; ++k) weights[span + k] += point[degree][k];
}

void add_stretch(const Curve& curve, double time, std::vector<double>& weights) {
    const std::vector<double>& t = curve.times;
    const auto after = std::upper_bound(t.begin(), t.end(), time);
    if (after == t.begin() || after == t.end()) {
        (after == t.begin() ? weights.front() : weights.back()) += 1;
        return;
    }
    const auto k = static_cast<std::size_t>(after - t.begin()) - 1;
    const double length = t[k + 1] - t[k], s = (time - t[k]) / length;
    double share = s;
    if (curve.kind == CurveKind::trapezoid) share = trapezoid_share(s);
    if (curve.kind == CurveKind::cubic) {
        share = s * s * (3 - 2 * s);
        add_slope(t, k, length * s * (1 - s) * (1 - s), weights);
        add_slope(t, k + 1, -length * s * s * (1 - s), weights);
    }
    weights[k] += 1 - share;
    weights[k + 1] += share;
}

}  // namespace

double curve_running_time(const Curve& curve, double time) { return curve.stop_time ? std::min(time, *curve.stop_time) : time; }

std::vector<double> curve_weights(const Curve& curve, double time) {
    std::vector<double> weights(curve.values.size(), 0.0);
    if (curve.values.empty()) return weights;
    if (curve.kind == CurveKind::control_points)
        add_spline(curve, curve_running_time(curve, time), weights);
    else
        add_stretch(curve, curve_running_time(curve, time), weights);
    return weights;
}

double curve_value(const Curve& curve, double time) {
    double sum = curve.rate * curve_running_time(curve, time);
    const std::vector<double> weights = curve_weights(curve, time);
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * curve.values[k];
    return sum;
}

}  // namespace fettle::core::scene
