// SPDX-License-Identifier: MIT
// Oracle: the same interval expressions in MPFI at 200 bits, rounded outward there by the library. Interval arithmetic is inclusion
// isotonic: evaluated in doubles with honest outward rounding each result contains that of 200 bits.
#include <boost/multiprecision/mpfi.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/ccd/chord_deviation.hpp"
#include "core/geometry/interval.hpp"

namespace fettle::core::ccd::arc_deviation_interval_test {

using core::geometry::Interval;

namespace {

using Wide = boost::multiprecision::number<boost::multiprecision::mpfi_float_backend<60>, boost::multiprecision::et_off>;
using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>, boost::multiprecision::et_off>;
using WideVector = std::array<Wide, 3>;

Wide wide(double low, double high) { return Wide(Real(low), Real(high)); }
Wide wide(const Interval& x) { return wide(x.low, x.high); }
Wide joined(const Wide& a, const Wide& b) {
    return Wide(std::min(Real(lower(a)), Real(lower(b))), std::max(Real(upper(a)), Real(upper(b))));
}
Wide squared(const Wide& x) {
    const Wide y = abs(x);
    return y * y;
}

/// sin(x)/x at the two ends of [a, b] where it falls, the quotient of intervals beyond.
Wide sinc(const Wide& x) {
    const Real falls_until(4.4934094579), a = Real(lower(Wide(abs(x)))), b = Real(upper(Wide(abs(x))));
    const auto at = [](const Real& p) { return p == 0 ? Wide(1) : Wide(sin(Wide(p)) / Wide(p)); };
    const auto beyond = [](const Real& p, const Real& q) { return Wide(sin(Wide(p, q)) / Wide(p, q)); };
    if (b <= falls_until) return Wide(Real(lower(at(b))), Real(upper(at(a))));
    if (a >= falls_until) return beyond(a, b);
    return joined(Wide(Real(lower(at(falls_until))), Real(upper(at(a)))), beyond(falls_until, b));
}

WideVector cross(const WideVector& a, const WideVector& b) {
    return {Wide(a[1] * b[2] - a[2] * b[1]), Wide(a[2] * b[0] - a[0] * b[2]), Wide(a[0] * b[1] - a[1] * b[0])};
}

WideVector rotated(const WideVector& theta, const WideVector& Y) {
    const Wide x = sqrt(Wide(squared(theta[0]) + squared(theta[1]) + squared(theta[2])));
    const Wide a = sinc(x), b = Wide(squared(sinc(Wide(x / 2))) / 2);
    const WideVector once = cross(theta, Y), twice = cross(theta, once);
    WideVector r;
    for (std::size_t k = 0; k < 3; ++k) r[k] = Y[k] + a * once[k] + b * twice[k];
    return r;
}

/// The paper's bound, at 200 bits.
Wide deviation(const Vector3& theta, const Vector3& w, const Vector3& Y) {
    WideVector arm, start, end, during;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        arm[k] = Wide(Y[i]);
        start[k] = Wide(theta[i]);
        end[k] = start[k] + Wide(w[i]);
        during[k] = joined(start[k], end[k]);
    }
    const WideVector arc = rotated(during, arm), at_start = rotated(start, arm), at_end = rotated(end, arm);
    Wide sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += squared(Wide(arc[k] - joined(at_start[k], at_end[k])));
    return sqrt(sum);
}

bool contains(const Interval& x, const Wide& y) { return Real(x.low) <= Real(lower(y)) && Real(upper(y)) <= Real(x.high); }

class Generator {
public:
    double uniform() { return std::uniform_real_distribution<double>()(random_); }
    Vector3 vector() {
        std::normal_distribution<double> n;
        return {n(random_), n(random_), n(random_)};
    }
    Interval interval() {
        const double a = std::ldexp(2 * uniform() - 1, static_cast<int>(40 * uniform()) - 28);
        const double b = uniform() < 0.2 ? a : a + (2 * uniform() - 1) * std::ldexp(1.0, static_cast<int>(36 * uniform()) - 30);
        return {std::min(a, b), std::max(a, b)};
    }

private:
    std::mt19937_64 random_{17};
};

}  // namespace

TEST_CASE("interval operations contain what MPFI says") {
    Generator g;
    int outside = 0, wider = 0;
    // Width beyond MPFI's, in units of the largest number that came up.
    const auto check = [&](const Interval& ours, const Wide& theirs, double slack) {
        outside += !contains(ours, theirs);
        const Real excess = (Real(ours.high) - Real(ours.low)) - (Real(upper(theirs)) - Real(lower(theirs)));
        wider += excess > Real(slack) * std::max(1e-290, ours.magnitude());
    };
    for (int i = 0; i < 20'000; ++i) {
        const Interval a = g.interval(), b = g.interval();
        check(a + b, wide(a) + wide(b), 1e-15);
        check(a - b, wide(a) - wide(b), 1e-15);
        check(a * b, wide(a) * wide(b), 1e-15);
        if (!b.contains(0)) check(a / b, wide(a) / wide(b), 1e-15);
        check(square(a), squared(wide(a)), 1e-15);
        if (a.low >= 0) check(core::geometry::sqrt(a), sqrt(wide(a)), 1e-15);
        check(core::geometry::sin(a), sin(wide(a)), 4e-15);
        // Where the quotient is taken, a split elsewhere or a division that loses a bit makes the difference.
        check(core::geometry::sinc(a), sinc(wide(a)), 1e-14);
    }
    CHECK(outside == 0);
    CHECK(wider == 0);
}

TEST_CASE("the interval bound of a deviation contains MPFI's, and is no wider than rounding") {
    Generator g;
    int below = 0, above = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vector3 theta = i % 4 == 0 ? Vector3::Zero() : Vector3(4 * g.uniform() * g.vector());
        const Vector3 w = g.vector() * std::pow(10.0, 10 * g.uniform() - 8), Y = g.vector() * std::pow(10.0, 6 * g.uniform() - 3);
        const double ours = core::ccd::arc_deviation_interval(theta, w, Y);
        const Wide theirs = deviation(theta, w, Y);
        below += Real(ours) < Real(upper(theirs));
        // Products of the angle's square: rounding is relative to |theta|^2 |Y|.
        const double size = Y.norm() * (1 + std::pow(theta.norm() + w.norm(), 2));
        above += Real(ours) > Real(upper(theirs)) * (1 + 1e-13) + 2e-14 * size;
    }
    CHECK(below == 0);
    CHECK(above == 0);
}

TEST_CASE("the MPFI comparison sees rounding that is not outward") {
    Generator g;
    int outside = 0;
    for (int i = 0; i < 1000; ++i) {
        const Interval a = g.interval(), b = g.interval();
        outside += !contains({a.low + b.low, a.high + b.high}, wide(a) + wide(b));
    }
    CHECK(outside > 300);
}

}  // namespace fettle::core::ccd::arc_deviation_interval_test
