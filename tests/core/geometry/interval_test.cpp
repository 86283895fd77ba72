// SPDX-License-Identifier: MIT
// Oracle: the same operations at sampled points in 50-digit arithmetic (MPFR).
#include "core/geometry/interval.hpp"

#include <boost/multiprecision/mpfr.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace fettle::core::geometry::interval_test {

namespace {

using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<50>, boost::multiprecision::et_off>;

bool contains(const Interval& a, const Real& x) { return Real(a.low) <= x && x <= Real(a.high); }

class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed) {}
    double number() {
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random_), std::uniform_int_distribution<int>(-30, 12)(random_));
    }
    Interval interval() {
        const double a = number(), b = std::uniform_int_distribution<int>(0, 3)(random_) == 0 ? a : a + number();
        return {std::min(a, b), std::max(a, b)};
    }
    /// A point of the interval: an end, or inside.
    double point(const Interval& a) {
        const int k = std::uniform_int_distribution<int>(0, 3)(random_);
        if (k < 2) return k == 0 ? a.low : a.high;
        return std::clamp(a.low + std::uniform_real_distribution<double>(0, 1)(random_) * (a.high - a.low), a.low, a.high);
    }

private:
    std::mt19937_64 random_;
};

Real exact_sinc(double x) { return x == 0 ? Real(1) : Real(sin(Real(x)) / Real(x)); }

}  // namespace

TEST_CASE("lower and upper step over the next double") {
    for (const double x : {0.0, 1.0, -1.0, 1 - 0x1p-53, 1e300, -1e-300, 0x1p-1074, -0x1p-1074, 0x1p-1022, 0x1.fffffffffffffp-1022, 3.7}) {
        CHECK(lower(x) <= std::nextafter(x, -INFINITY));
        CHECK(upper(x) >= std::nextafter(x, INFINITY));
        CHECK(upper(x) <= x + std::abs(x) * 0x1p-51 + 0x1p-1073);
    }
}

TEST_CASE("interval operations contain the exact results") {
    Generator g(5);
    long outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Interval a = g.interval(), b = g.interval();
        const double x = g.point(a), y = g.point(b);
        const Real p = x, q = y;
        outside += !contains(a + b, p + q);
        outside += !contains(a - b, p - q);
        outside += !contains(a * b, p * q);
        outside += !contains(square(a), p * p);
        if (!b.contains(0)) outside += !contains(a / b, p / q);
        if (x >= 0) outside += !contains(core::geometry::sqrt(a), sqrt(p));
        outside += !contains(-a, -p);
        outside += !contains(hull(a, b), p) + !contains(hull(a, b), q);
    }
    CHECK(outside == 0);
    CHECK_THROWS(Interval(1) / Interval(-1, 1));
    CHECK_THROWS(core::geometry::sqrt(Interval(-2, -1)));
}

TEST_CASE("interval operations are tight") {
    Generator g(6);
    for (int i = 0; i < 1000; ++i) {
        const double x = g.number(), y = g.number();
        CHECK((Interval(x) * Interval(y)).width() <= 8e-16 * std::abs(x * y));
        CHECK((Interval(x) + Interval(y)).width() <= 8e-16 * std::abs(x + y) + 1e-320);
    }
    CHECK(sinc(Interval(0.5, 0.6)).width() < 1.01 * (std::sin(0.5) / 0.5 - std::sin(0.6) / 0.6));
    CHECK(sinc(Interval(-1e-9, 1e-9)).low > 1 - 1e-15);
    CHECK(sinc(Interval(-1e-9, 1e-9)).high == 1);
}

TEST_CASE("interval sin and sinc contain the exact results") {
    Generator g(7);
    long outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Interval a = g.interval();
        const double x = g.point(a);
        outside += !contains(core::geometry::sin(a), sin(Real(x)));
        outside += !contains(sinc(a), exact_sinc(x));
    }
    CHECK(outside == 0);
    // Extremes inside: the quarter turns of sin, the first minimum of sinc (-0.2172... at 4.4934...) and the maximum at 0.
    for (int k = -8; k <= 8; ++k) {
        const double at = (k + 0.5) * M_PI;
        const Interval s = core::geometry::sin(Interval(at - 1e-3, at + 1e-3));
        CHECK((k % 2 == 0 ? s.high : s.low) == (k % 2 == 0 ? 1 : -1));
        CHECK(s.width() < 1e-6);
    }
    CHECK(core::geometry::sin(Interval(0, 100)).low == -1);
    CHECK(sinc(Interval(4, 5)).low <= -0.21723362821122165);
    CHECK(sinc(Interval(4, 5)).high < 0);
    CHECK(sinc(Interval(-1, 3)).high == 1);
    for (const double x : {4.4934094578, 4.4934094579, 4.4934094580, 4.49340945790907, 1e3, 4e5}) {
        CHECK(contains(sinc(Interval(x)), exact_sinc(x)));
        CHECK(contains(sinc(Interval(-x)), exact_sinc(x)));
        CHECK(sinc(Interval(x)).width() < 1e-10);
    }
}

TEST_CASE("cross and norm_bound contain the exact results") {
    const Interval3 a{Interval(1, 2), Interval(-1, 1), Interval(0.5)}, b{Interval(3), Interval(-2, 4), Interval(1, 1.5)};
    const Interval3 c = cross(a, b);
    for (const double x : {1.0, 1.7, 2.0})
        for (const double y : {-2.0, 0.3, 4.0}) {
            const Vector3 v = Vector3(x, 0.25, 0.5).cross(Vector3(3, y, 1.25));
            for (int k = 0; k < 3; ++k) CHECK(c[k].contains(v[k]));
            CHECK(norm_bound(c) >= v.norm());
        }
    CHECK(norm_bound({Interval(3), Interval(-4), Interval(0)}) >= 5);
    CHECK(norm_bound({Interval(3), Interval(-4), Interval(0)}) < 5 + 1e-14);
}

}  // namespace fettle::core::geometry::interval_test
