// SPDX-License-Identifier: MIT
// Oracle: dense sampling of curve and chord in 200-bit arithmetic (MPFR).
#include "core/ccd/chord_deviation.hpp"

#include <boost/multiprecision/mpfr.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/ccd/curved_ccd.hpp"

namespace fettle::core::ccd::chord_deviation_test {

using fettle::core::kinematics::PathSegment;

namespace {

using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>, boost::multiprecision::et_off>;
using RealVector = std::array<Real, 3>;

RealVector cross(const RealVector& a, const RealVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real norm(const RealVector& a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

/// exp([theta + s w]) Y.
RealVector turned(const Vector3& theta, const Vector3& w, const Real& s, const RealVector& Y) {
    RealVector t;
    for (int k = 0; k < 3; ++k) t[k] = Real(theta[k]) + s * Real(w[k]);
    const Real x = norm(t);
    if (x == 0) return Y;
    const RealVector once = cross(t, Y), twice = cross(t, once);
    const Real a = sin(x) / x, half = sin(x / 2), b = 2 * half * half / (x * x);
    RealVector r;
    for (int k = 0; k < 3; ++k) r[k] = Y[k] + a * once[k] + b * twice[k];
    return r;
}

RealVector based(const PathSegment& p, const Vector3& X) {
    RealVector Y;
    for (int i = 0; i < 3; ++i) {
        Y[i] = 0;
        for (int k = 0; k < 3; ++k) Y[i] += Real(p.base(i, k)) * Real(X[k]);
    }
    return Y;
}

/// Largest deviation over `samples` parameters: a lower bound of the truth.
Real sampled_deviation(const PathSegment& p, const Vector3& X, int samples) {
    const RealVector Y = based(p, X);
    const Vector3 &theta = p.rotation_vector_t0, &w = p.rotation_vector_step;
    const RealVector x0 = turned(theta, w, 0, Y), x1 = turned(theta, w, 1, Y);
    Real largest = 0;
    for (int i = 1; i < samples; ++i) {
        const Real s = Real(i) / samples;
        RealVector x = turned(theta, w, s, Y);
        for (int k = 0; k < 3; ++k) x[k] -= (1 - s) * x0[k] + s * x1[k];
        largest = std::max(largest, norm(x));
    }
    return largest;
}

struct Arc {
    PathSegment path;
    Vector3 X;
};

/// Start turned by up to beyond 4 pi, steps from 1e-8 to 60 rad, arms at every angle to the axis; some aligned exactly.
Arc random_arc(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
    Arc a;
    a.path.rotation_vector_step = vector().normalized() * std::pow(10.0, -8 + 9.78 * uniform(random));
    a.path.rotation_vector_t0 = uniform(random) < 0.3 ? Vector3::Zero() : Vector3(vector().normalized() * 14 * uniform(random));
    a.path.base = core::kinematics::rotation(vector());
    a.path.position_step = 10 * vector();
    a.X = vector() * std::pow(10.0, 6 * uniform(random) - 3);
    const int kind = static_cast<int>(6 * uniform(random));
    const Vector3 axis = a.path.base.transpose() * a.path.rotation_vector_step.normalized();
    if (kind == 0) a.path.rotation_vector_t0 = a.path.rotation_vector_step * uniform(random);
    if (kind == 1) a.X -= a.X.dot(axis) * axis;
    if (kind == 2) a.X = axis * a.X.norm() + 1e-6 * uniform(random) * a.X;
    return a;
}

using Bound = std::function<double(const Arc&)>;

/// How many of the arcs break each of the bounds.
std::vector<int> violations(const std::vector<Bound>& bounds, int arcs, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<int> broken(bounds.size(), 0);
    for (int i = 0; i < arcs; ++i) {
        const Arc a = random_arc(random);
        const Real deviation = sampled_deviation(a.path, a.X, 12);
        for (std::size_t k = 0; k < bounds.size(); ++k) broken[k] += deviation > Real(bounds[k](a));
    }
    return broken;
}

double closed_form(const Arc& a) { return chord_deviation(a.path, a.X, DeviationBound::closed_form); }
double interval(const Arc& a) { return chord_deviation(a.path, a.X, DeviationBound::interval); }
Vector3 arm(const Arc& a) { return a.path.base * a.X; }

}  // namespace

TEST_CASE("chord deviation bounds hold on dense samples") {
    // arc_deviation and its cubic take the computed arm as exact: its rounding is chord_deviation's.
    const Bound least = [](const Arc& a) {
        return arc_deviation(a.path.rotation_vector_t0, a.path.rotation_vector_step, arm(a)) * (1 + 1e-14);
    };
    const Bound cubic = [](const Arc& a) {
        return arc_deviation_cubic(a.path.rotation_vector_t0, a.path.rotation_vector_step, arm(a)) * (1 + 1e-14);
    };
    CHECK(violations({closed_form, interval, least, cubic}, 800, 1) == std::vector<int>{0, 0, 0, 0});
}

TEST_CASE("arc_deviation is the least of B0 and B1, and both hold") {
    std::mt19937_64 random(5);
    int broken = 0, below = 0, above = 0, second = 0;
    for (int i = 0; i < 800; ++i) {
        const Arc a = random_arc(random);
        const Vector3 &t = a.path.rotation_vector_t0, &w = a.path.rotation_vector_step, Y = arm(a);
        const RealVector theta{t[0], t[1], t[2]}, turn{w[0], w[1], w[2]}, exact_arm{Y[0], Y[1], Y[2]};
        const Real speed = norm(turn), length = norm(exact_arm);
        const Real b0 = speed * speed * length / 8;
        const Real b1 = speed * (norm(cross(turn, exact_arm)) + norm(cross(theta, turn)) * length / 3) / 8;
        PathSegment unbased = a.path;  // the computed arm counts as exact
        unbased.base.setIdentity();
        const Real deviation = sampled_deviation(unbased, Y, 12);
        broken += deviation > b0 || deviation > b1;
        second += b1 < b0;
        const Real least = std::min(b0, b1), computed = arc_deviation(t, w, Y);
        below += computed < least;
        above += computed > least * (1 + Real(1e-14)) + Real(1e-14) * speed * length * (speed + norm(theta) * speed);
    }
    CHECK(broken == 0);
    CHECK(second > 100);
    CHECK(below == 0);
    CHECK(above == 0);
}

TEST_CASE("closed form and interval bound hold each other: neither is below the other's truth, and short arcs favour the closed form") {
    std::mt19937_64 random(8);
    int above = 0, apart = 0;
    for (int i = 0; i < 3000; ++i) {
        const Arc a = random_arc(random);
        const double speed = a.path.rotation_vector_step.norm(), closed = closed_form(a), bound = interval(a);
        if (speed <= 0.5) above += closed > bound;
        // The interval bound is of first order: the box of the arc, no larger than the arc's length and its angle's error allow.
        const double angle = a.path.rotation_vector_t0.norm() + speed;
        apart += speed <= 0.5 && bound > 12 * (1 + angle) * (1 + angle) * speed * a.X.norm() + 1e-12 * a.X.norm();
    }
    CHECK(above == 0);
    CHECK(apart == 0);
}

TEST_CASE("over a part of an arc the deviation falls with the square of its length") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> uniform;
    int broken = 0;
    for (int i = 0; i < 800; ++i) {
        const Arc a = random_arc(random);
        const double s = uniform(random), h = (1 - s) * uniform(random);
        const Vector3 Y = arm(a);
        const RealVector exact_arm{Y[0], Y[1], Y[2]};
        const Vector3 &t = a.path.rotation_vector_t0, &w = a.path.rotation_vector_step;
        const RealVector x0 = turned(t, w, Real(s), exact_arm), x1 = turned(t, w, Real(s) + Real(h), exact_arm);
        Real largest = 0;
        for (int k = 1; k < 8; ++k) {
            const Real part_of = Real(k) / 8;
            RealVector x = turned(t, w, Real(s) + part_of * Real(h), exact_arm);
            for (int j = 0; j < 3; ++j) x[j] -= (1 - part_of) * x0[j] + part_of * x1[j];
            largest = std::max(largest, norm(x));
        }
        broken += largest > Real(arc_deviation(t, w, Y)) * Real(h) * Real(h);
    }
    CHECK(broken == 0);
}

TEST_CASE("chord deviation bounds hold on a hundred thousand dense samples", "[slow]") {
    CHECK(violations({closed_form, interval}, 100'000, 3) == std::vector<int>{0, 0});
}

TEST_CASE("the same samples reject bounds that are wrong") {
    const int arcs = 600;
    const Bound across_only = [](const Arc& a) {
        const Vector3& w = a.path.rotation_vector_step;
        return 0.125 * w.norm() * w.cross(arm(a)).norm();
    };
    // The sampling resolves rounding: a part in 1e12 too small is seen.
    const Bound short_of_b0 = [](const Arc& a) { return 0.125 * a.path.rotation_vector_step.squaredNorm() * arm(a).norm() * (1 - 1e-12); };
    const Bound middle_only = [](const Arc& a) {
        const Vector3 &t = a.path.rotation_vector_t0, &w = a.path.rotation_vector_step;
        return arc_deviation_cubic(t, w, arm(a)) - std::pow(w.norm(), 3) * arm(a).norm() / (72 * std::sqrt(3.0));
    };
    const std::vector<int> broken = violations({across_only, short_of_b0, middle_only}, arcs, 2);
    CHECK(broken[0] > arcs / 10);
    CHECK(broken[1] > 0);
    CHECK(broken[2] > 0);
}

TEST_CASE("the closed form is sharp and the interval bound is not") {
    PathSegment p;
    const Vector3 X(1, 0, 0);
    for (const double w : {1e-6, 1e-4, 0.1, 0.5}) {
        p.rotation_vector_step = Vector3(0, 0, w);
        const double truth = 2 * std::pow(std::sin(w / 4), 2);
        CHECK(chord_deviation(p, X) >= truth * (1 - 1e-9));
        CHECK(chord_deviation(p, X) <= w * w / 8 * (1 + 1e-12));
        CHECK(chord_deviation(p, X, DeviationBound::interval) >= truth * (1 - 1e-9));
    }
    p.rotation_vector_step = Vector3(0, 0, 1e-4);
    const double ratio = chord_deviation(p, X, DeviationBound::interval) / chord_deviation(p, X);
    CHECK(ratio > 1e4);
    // A point on the axis does not move; nor does translation deviate.
    CHECK(chord_deviation(p, Vector3(0, 0, 5)) < 1e-22);
    const double before = chord_deviation(p, X);
    p.position_step = Vector3(100, -3, 8);
    CHECK(chord_deviation(p, X) == before);
    p.rotation_vector_step.setZero();
    CHECK(chord_deviation(p, X) == 0);
}

TEST_CASE("B3 wins where the start rotation is skew") {
    std::mt19937_64 random(9);
    int won = 0;
    for (int i = 0; i < 300; ++i) {
        Arc a = random_arc(random);
        a.path.rotation_vector_step *= 0.05 / a.path.rotation_vector_step.norm();
        const double least = arc_deviation(a.path.rotation_vector_t0, a.path.rotation_vector_step, arm(a));
        won += closed_form(a) < 0.9 * least;
    }
    CHECK(won > 30);
}

TEST_CASE("rotated_rounding bounds what is computed") {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    double largest = 0;
    for (int i = 0; i < 3000; ++i) {
        Arc a = random_arc(random);
        if (i % 3 == 0) a.path.rotation_vector_step *= 4e5 * uniform(random) / a.path.rotation_vector_step.norm();
        const Vector3 &t = a.path.rotation_vector_t0, &w = a.path.rotation_vector_step;
        const double s = uniform(random), radius = std::max(a.X.norm(), arm(a).norm());
        const Vector3 x = core::kinematics::rotation(t + s * w) * arm(a);
        RealVector r = turned(t, w, Real(s), based(a.path, a.X));
        for (int k = 0; k < 3; ++k) r[k] -= Real(x[k]);
        largest = std::max(largest, static_cast<double>(norm(r)) / rotated_rounding(t.norm(), w.norm(), s, radius));
    }
    CAPTURE(largest);
    CHECK(largest <= 1);
    CHECK(largest > 0.005);  // a bound hundreds of times too large would hide a mistake in its derivation
}

}  // namespace fettle::core::ccd::chord_deviation_test
