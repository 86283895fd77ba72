// SPDX-License-Identifier: MIT
#include "design/quantities/interpolant.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "core/base/contract.hpp"
#include "core/base/types.hpp"

namespace fettle::design::quantities {

namespace {

// With its derivative in the four numbers.
using Number = Eigen::AutoDiffScalar<Eigen::Matrix<double, 4, 1>>;

// At a number between two others.
Number slope_between(const Number& before, const Number& after) {
    if (!(before.value() > 0 && after.value() > 0) && !(before.value() < 0 && after.value() < 0)) return Number(0.0);
    return 2.0 * before * after / (before + after);
}

// At the first or last number, from the slope beside it and the next one.
Number slope_at_end(const Number& beside, const Number& next) {
    const Number out = (3.0 * beside - next) / 2.0;
    const double of_beside = beside.value() == 0 ? 0 : out.value() / beside.value();
    if (of_beside <= 0) return Number(0.0);
    return of_beside > 3 ? Number(3.0 * beside) : out;
}

// The root between the numbers `begin` and `begin + 1`, one of which is positive and the other is not.
double root_after(const std::vector<double>& y, int begin) {
    const bool starts_positive = y[begin] > 0;
    double low = 0, high = 1, at = y[begin] / (y[begin] - y[begin + 1]);
    for (int k = 0; k < 100 && low < high; ++k) {
        const Interpolated here = interpolated(y, begin + at);
        if (here.value == 0) break;
        ((here.value > 0) == starts_positive ? low : high) = at;
        double next = at - here.value / here.slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == at) break;
        at = next;
    }
    return begin + at;
}

}  // namespace

Interpolated interpolated(const std::vector<double>& y, double place) {
    FETTLE_ASSERT(!y.empty() && place >= 0 && place <= static_cast<double>(y.size()) - 1, "a place is among the numbers");
    const int last = count_of(y) - 1;
    if (last == 0) return {y[0], 0, -1, {0, 1, 0, 0}};
    const int k = std::min(static_cast<int>(place), last - 1);
    const auto number = [&](int i) { return Number(y[k + i], 4, i + 1); };
    const Number slope = number(1) - number(0);
    const bool has_before = k > 0, has_after = k + 2 <= last;
    const Number before = has_before ? Number(number(0) - number(-1)) : slope, after = has_after ? Number(number(2) - number(1)) : slope;
    const Number at_begin = has_before ? slope_between(before, slope) : slope_at_end(slope, after);
    const Number at_end = has_after ? slope_between(slope, after) : slope_at_end(slope, before);
    const double s = place - k;
    const Number bend = 3.0 * slope - 2.0 * at_begin - at_end, twist = at_begin + at_end - 2.0 * slope;
    const Number value = number(0) + s * (at_begin + s * (bend + s * twist));
    Interpolated out{value.value(), at_begin.value() + s * (2 * bend.value() + 3 * s * twist.value()), k - 1, {}};
    for (int i = 0; i < 4; ++i) out.weights[i] = value.derivatives()[i];
    return out;
}

double room_on_zero(const std::vector<double>& y) {
    constexpr double rounding = 1e-9;
    const auto [least, largest] = std::minmax_element(y.begin(), y.end());
    return rounding * (*largest - *least);
}

std::vector<Crossing> crossings_of_zero(const std::vector<double>& y) {
    std::vector<Crossing> out;
    if (y.empty()) return out;
    const double on_zero = room_on_zero(y);
    int from = -1;  // the last number that is on a side
    for (int k = 0; k < count_of(y); ++k) {
        if (std::abs(y[k]) <= on_zero) continue;
        if (from >= 0 && (y[from] > 0) != (y[k] > 0)) {
            int begin = from;
            while ((y[begin + 1] > 0) == (y[from] > 0)) ++begin;
            out.push_back({root_after(y, begin), y[k] > 0, k - from > 2});
        }
        from = k;
    }
    return out;
}

}  // namespace fettle::design::quantities
