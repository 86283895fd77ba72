// SPDX-License-Identifier: MIT
#include "core/certificate/taylor_model.hpp"

#include <algorithm>
#include <limits>

#include "core/parts/jet.hpp"

namespace fettle::core::certificate {
namespace {

using geometry::Interval;
using geometry::Range;
using Bent = parts::Jet<Range>;  // value, first and second derivative

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tiny = 1e-300;             // what products that underflow are off by
constexpr double rounded_up = 1 + 0x1p-47;  // of sums of some tens of numbers that are not negative
constexpr double of_sum = 0x1p-52;          // twice the rounding of one operation
constexpr double of_product = 0x1p-48;      // of sums of as many products as there are variables

double size_of(const std::array<double, most_variables>& slopes) {
    double sum = 0;
    for (const double s : slopes) sum += std::abs(s);
    return sum;
}

// With the rest that it has, and what is no number as unknown.
TaylorModel with_rest(TaylorModel x, double rest) {
    x.rest = rest * rounded_up + tiny;
    return x.rest < infinity && std::abs(x.center) < infinity ? x : TaylorModel::unknown();
}

// The middle of an interval and how far it reaches from there.
struct Middle {
    double at = 0, reach = 0;
};
Middle middle_of(const Range& r) {
    const double at = 0.5 * r.low + 0.5 * r.high;
    return {at, geometry::upper(std::max(r.high - at, at - r.low))};
}

// The Taylor model of f(a), from what is known of f over a's range.
template <class Function>
TaylorModel composed(const TaylorModel& a, const Function& f) {
    if (!a.is_bounded()) return TaylorModel::unknown();
    const Interval whole = a.interval();
    const Bent over = f(Bent::parameter(Range(whole)));
    if (!over.value.is_bounded() || over.value.has_gaps) return TaylorModel::unknown();
    const TaylorModel plain = TaylorModel::of(over.value.interval());
    const Bent at = f(Bent::parameter(Range(a.center)));
    if (over.value.switches || !over.second.is_bounded() || !at.first.is_bounded() || !at.value.is_bounded()) return plain;
    const double reach = a.radius();
    const Middle value = middle_of(at.value), slope = middle_of(at.first);
    const double half_square = 0.5 * reach * reach * rounded_up;
    const Middle bend = middle_of(Range(std::min(0.0, over.second.low * half_square), std::max(0.0, over.second.high * half_square)));
    TaylorModel out;
    out.center = value.at + bend.at;
    double size = 0;
    for (std::size_t k = 0; k < out.slopes.size(); ++k) {
        out.slopes[k] = slope.at * a.slopes[k];
        size += std::abs(out.slopes[k]);
    }
    const double rounding = of_sum * (std::abs(value.at) + std::abs(bend.at) + size + bend.reach);
    out = with_rest(out, std::abs(slope.at) * a.rest + slope.reach * reach + value.reach + bend.reach + rounding);
    return out.rest < plain.radius() ? out : plain;  // the interval is always the narrower, but knows of no slope
}

// b where the condition is negative, else c; all of both where that is open.
TaylorModel hull(const TaylorModel& b, const TaylorModel& c) {
    const TaylorModel middle = scaled(0.5, b + c), half = scaled(0.5, b - c);
    return with_rest(middle, middle.rest + half.magnitude());
}

}  // namespace

TaylorModel TaylorModel::of(const Interval& values) {
    TaylorModel out;
    const Middle middle = middle_of(Range(values));
    out.center = middle.at;
    if (middle.reach > 0) out = with_rest(out, middle.reach);
    return out;
}

TaylorModel TaylorModel::variable(int k, double low, double high) {
    TaylorModel out;
    out.center = 0.5 * (low + high);
    out.slopes[static_cast<std::size_t>(k)] =
        high > low ? geometry::upper(geometry::upper(std::max(high - out.center, out.center - low))) : 0;
    return out;
}

TaylorModel TaylorModel::unknown() {
    TaylorModel out;
    out.rest = infinity;
    return out;
}

double TaylorModel::radius() const { return (size_of(slopes) + rest) * rounded_up; }

Interval TaylorModel::interval() const {
    const double r = radius();
    return {geometry::lower(center - r), geometry::upper(center + r)};
}

double linear_value(const TaylorModel& x, const std::array<double, most_variables>& t) {
    double value = x.center;
    for (std::size_t k = 0; k < t.size(); ++k) value += x.slopes[k] * t[k];
    return value;
}

TaylorModel operator-(const TaylorModel& a) {
    TaylorModel out = a;
    out.center = -a.center;
    for (double& s : out.slopes) s = -s;
    return out;
}

TaylorModel operator+(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel out;
    out.center = a.center + b.center;
    double size = std::abs(out.center);
    for (std::size_t k = 0; k < out.slopes.size(); ++k) {
        out.slopes[k] = a.slopes[k] + b.slopes[k];
        size += std::abs(out.slopes[k]);
    }
    return with_rest(out, a.rest + b.rest + of_sum * size);
}

TaylorModel operator-(const TaylorModel& a, const TaylorModel& b) { return a + -b; }

TaylorModel scaled(double by, const TaylorModel& a) {
    TaylorModel out;
    out.center = by * a.center;
    double size = std::abs(out.center);
    for (std::size_t k = 0; k < out.slopes.size(); ++k) {
        out.slopes[k] = by * a.slopes[k];
        size += std::abs(out.slopes[k]);
    }
    return with_rest(out, std::abs(by) * a.rest + of_sum * size);
}

// sum_j p_j t_j^2, p_j = a_j b_j, is within half of sum |p_j| of half of sum p_j; the mixed terms are at most the rest of |a||b|.
TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel out;
    double size_a = 0, size_b = 0, squares = 0, sum = 0;
    for (std::size_t k = 0; k < out.slopes.size(); ++k) {
        const double p = a.slopes[k] * b.slopes[k];
        sum += p;
        squares += std::abs(p);
        size_a += std::abs(a.slopes[k]);
        size_b += std::abs(b.slopes[k]);
        out.slopes[k] = a.center * b.slopes[k] + b.center * a.slopes[k];
    }
    const double at_a = std::abs(a.center), at_b = std::abs(b.center);
    out.center = a.center * b.center + 0.5 * sum;
    const double mixed = size_a * size_b * rounded_up - 0.5 * squares;
    const double rests = a.rest * (at_b + size_b + b.rest) + b.rest * (at_a + size_a);
    const double rounding = of_product * (at_a * at_b + size_a * size_b + at_a * size_b + at_b * size_a);
    return with_rest(out, mixed + rests + rounding);
}

TaylorModel operator/(const TaylorModel& a, const TaylorModel& b) {
    return a * composed(b, [](const Bent& x) { return 1.0 / x; });
}

TaylorModel sqrt(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return sqrt(x); });
}
TaylorModel sin(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return sin(x); });
}
TaylorModel cos(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return cos(x); });
}
TaylorModel tan(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return tan(x); });
}
TaylorModel asin(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return asin(x); });
}
TaylorModel acos(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return acos(x); });
}
TaylorModel atan(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return atan(x); });
}
TaylorModel exp(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return exp(x); });
}
TaylorModel log(const TaylorModel& a) {
    return composed(a, [](const Bent& x) { return log(x); });
}

TaylorModel pow(const TaylorModel& a, const TaylorModel& b) {
    if (b.radius() == 0) {
        const Range exponent(b.center);
        return composed(a, [&](const Bent& x) { return pow(x, Bent(exponent, Range(0.0), Range(0.0))); });
    }
    return exp(b * log(a));
}

// By the quotient of the smaller by the larger, where that one keeps its sign.
TaylorModel atan2(const TaylorModel& y, const TaylorModel& x) {
    const Interval half_turn{0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1}, quarter{0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0};
    if (std::abs(x.center) >= std::abs(y.center)) {
        if (x.center > 0) return atan(y / x);
        const Interval ys = y.interval();
        if (ys.low < 0 && ys.high >= 0) return TaylorModel::unknown();  // it jumps there
        return atan(y / x) + TaylorModel::of(y.center >= 0 ? half_turn : -half_turn);
    }
    return TaylorModel::of(y.center > 0 ? quarter : -quarter) - atan(x / y);
}

TaylorModel hypot(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel sum = a * a + b * b;
    if (!sum.is_bounded()) return sum;
    const Interval over = sum.interval();
    // Next to the origin it has no slope: from 0 to the largest.
    if (over.low <= 0) return TaylorModel::of({0, geometry::upper(std::sqrt(std::max(over.high, 0.0)))});
    return sqrt(sum);
}

TaylorModel choose(const TaylorModel& a, const TaylorModel& b, const TaylorModel& c) {
    if (!a.is_bounded()) return TaylorModel::unknown();
    const Interval sign = a.interval();
    if (sign.high < 0) return b;
    return sign.low >= 0 ? c : hull(b, c);
}

TaylorModel abs(const TaylorModel& a) {
    if (!a.is_bounded()) return TaylorModel::unknown();
    const Interval over = a.interval();
    if (over.low >= 0) return a;
    return over.high <= 0 ? -a : TaylorModel::of({0, over.magnitude()});
}

// (a + b)/2 -+ |a - b|/2.
TaylorModel minimum(const TaylorModel& a, const TaylorModel& b) { return scaled(0.5, a + b) - scaled(0.5, abs(a - b)); }
TaylorModel maximum(const TaylorModel& a, const TaylorModel& b) { return scaled(0.5, a + b) + scaled(0.5, abs(a - b)); }

Model3 operator+(const Model3& a, const Model3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Model3 operator-(const Model3& a, const Model3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
TaylorModel dot(const Model3& a, const Model3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Model3 times(const ModelMatrix& m, const Model3& x) { return {dot(m[0], x), dot(m[1], x), dot(m[2], x)}; }

ModelMatrix transposed(const ModelMatrix& m) {
    return {Model3{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}};
}

Model3 transposed_times(const ModelMatrix& m, const Model3& x) { return times(transposed(m), x); }

ModelMatrix product(const ModelMatrix& a, const ModelMatrix& b) {
    const ModelMatrix columns = transposed(b);
    ModelMatrix out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = dot(a[i], columns[j]);
    return out;
}

ModelMatrix turned_about(const Model3& z, const TaylorModel& angle) {
    const TaylorModel s = sin(angle), c = TaylorModel(1) - cos(angle);
    const ModelMatrix k{Model3{TaylorModel(0), -z[2], z[1]}, {z[2], TaylorModel(0), -z[0]}, {-z[1], z[0], TaylorModel(0)}};
    const ModelMatrix squared = product(k, k);
    ModelMatrix out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = TaylorModel(i == j ? 1 : 0) + s * k[i][j] + c * squared[i][j];
    return out;
}

}  // namespace fettle::core::certificate
