// SPDX-License-Identifier: MIT
#include "design/optimisers/quadratic_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "design/optimisers/projection.hpp"

namespace fettle::design::optimisers::quadratic_program_test {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

QuadraticProgram random_program(std::mt19937& random, int n, int m) {
    std::normal_distribution<double> normal;
    const auto number = [&](auto) { return normal(random); };
    QuadraticProgram p;
    p.gradient = VectorX::NullaryExpr(n, number);
    const MatrixX root = MatrixX::NullaryExpr(n, n, number);
    p.hessian = (random() % 3 == 0) ? MatrixX(MatrixX::Zero(n, n)) : MatrixX(root.transpose() * root);
    p.rows = MatrixX::NullaryExpr(m, n, number);
    p.lower = VectorX::NullaryExpr(m, number);
    p.upper = p.lower.array() + 0.5;
    for (int i = 0; i < m; ++i) (random() % 2 == 0 ? p.upper[i] : p.lower[i]) = random() % 2 == 0 ? infinite : -infinite;
    for (int i = 0; i < m; ++i) {
        if (p.lower[i] == infinite) p.lower[i] = -infinite;
        if (p.upper[i] == -infinite) p.upper[i] = infinite;
    }
    p.box_lower = VectorX::Constant(n, -0.7);
    p.box_upper = VectorX::Constant(n, 0.6);
    p.penalty = 5;
    return p;
}

}  // namespace

TEST_CASE("a quadratic programme's solution satisfies the conditions of its optimum, violated rows at the price asked") {
    std::mt19937 random(4);
    for (int k = 0; k < 60; ++k) {
        const int n = 1 + static_cast<int>(random() % 6), m = static_cast<int>(random() % 5);
        const QuadraticProgram p = random_program(random, n, m);
        const QuadraticSolution s = solve(p);
        INFO("programme " << k << ", n = " << n << ", m = " << m);
        REQUIRE(s.solved);
        const double eps = 1e-5;
        for (int i = 0; i < n; ++i) {
            const bool at_lower = s.step[i]<p.box_lower[i] + eps, at_upper = s.step[i]> p.box_upper[i] - eps;
            CHECK(s.step[i] >= p.box_lower[i]);
            CHECK(s.step[i] <= p.box_upper[i]);
            CHECK((at_lower || s.box_multipliers[i] < eps));
            CHECK((at_upper || s.box_multipliers[i] > -eps));
        }
        const VectorX values = p.rows * s.step;
        for (int i = 0; i < m; ++i) {
            const double y = s.multipliers[i];
            CHECK(std::abs(y) <= p.penalty + eps);
            if (values[i] > p.lower[i] + eps) CHECK(y < eps);
            if (values[i] < p.upper[i] - eps) CHECK(y > -eps);
            if (values[i] < p.lower[i] - eps) CHECK(y == Approx(p.penalty).margin(eps));
            if (values[i] > p.upper[i] + eps) CHECK(y == Approx(-p.penalty).margin(eps));
        }
        CHECK(s.violation == Approx(row_violation(values, p.lower, p.upper)).margin(1e-12));
        CHECK(s.decrease >= 0);
    }
}

namespace {

// What the header says is minimised, written down once more.
double price(const QuadraticProgram& p, const VectorX& d) {
    double sum = p.gradient.dot(d) + 0.5 * d.dot(p.hessian * d);
    for (Eigen::Index i = 0; i < p.rows.rows(); ++i) {
        const double value = p.rows.row(i).dot(d);
        double below = std::max(0.0, p.lower[i] - value);
        for (size_t j = 0; j < p.cuts.of.size(); ++j) {
            const auto row = static_cast<Eigen::Index>(j);
            if (p.cuts.of[j] == i) below = std::max(below, p.cuts.lower[row] - p.cuts.rows.row(row).dot(d));
        }
        sum += p.penalty * (below + std::max(0.0, value - p.upper[i]));
    }
    for (int t = 0; t < 2; ++t) {
        double kink = 0;
        for (size_t j = 0; j < p.cuts.of.size(); ++j) {
            const auto row = static_cast<Eigen::Index>(j);
            if (p.cuts.of[j] == -1 - t) kink = std::max(kink, p.cuts.lower[row] - p.cuts.rows.row(row).dot(d));
        }
        sum += kink;
    }
    return sum;
}

}  // namespace

TEST_CASE("cuts share their row's violation, kinks have a price of their own") {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share;
    int held = 0, kinked = 0;
    for (int k = 0; k < 60; ++k) {
        const int n = 1 + static_cast<int>(random() % 4), m = 1 + static_cast<int>(random() % 3);
        QuadraticProgram p = random_program(random, n, m);
        const int count = 1 + static_cast<int>(random() % 6);
        for (int j = 0; j < count; ++j) {
            const int of = static_cast<int>(random() % (static_cast<unsigned>(m) + 2)) - 2;
            if (of < 0 || std::isfinite(p.lower[of])) p.cuts.of.push_back(of);
        }
        std::sort(p.cuts.of.begin(), p.cuts.of.end());
        const auto cuts = static_cast<Eigen::Index>(p.cuts.of.size());
        p.cuts.rows = MatrixX::NullaryExpr(cuts, n, [&](auto, auto) { return normal(random); });
        p.cuts.lower = VectorX::NullaryExpr(cuts, [&](auto) { return 0.5 * normal(random); });
        const QuadraticSolution s = solve(p);
        INFO("programme " << k << ", n = " << n << ", m = " << m << ", " << cuts << " cuts");
        REQUIRE(s.solved);
        const double at = price(p, s.step), start = price(p, VectorX::Zero(n));
        CHECK(s.decrease == Approx(start - at).margin(1e-9));
        // It is convex: no other point is better, far or near.
        for (int i = 0; i < 400; ++i) {
            const double reach = std::pow(10.0, -4.0 * share(random));
            VectorX d = s.step + reach * VectorX::NullaryExpr(n, [&](auto) { return normal(random); });
            d = d.cwiseMax(p.box_lower).cwiseMin(p.box_upper);
            CHECK(price(p, d) >= at - 1e-6);
        }
        for (Eigen::Index j = 0; j < cuts; ++j) {
            CHECK(s.cut_multipliers[j] > -1e-6);
            (p.cuts.of[j] < 0 ? kinked : held) += s.cut_multipliers[j] > 1e-3 ? 1 : 0;
        }
        const VectorX balance = p.gradient + p.hessian * s.step - p.rows.transpose() * s.multipliers -
                                p.cuts.rows.transpose() * s.cut_multipliers - s.box_multipliers;
        CHECK(balance.norm() < 1e-9);
    }
    CHECK(held > 10);  // else nothing was tried
    CHECK(kinked > 10);
}

TEST_CASE("what cannot be solved is not called solved") {
    std::mt19937 random(1);
    QuadraticProgram p = random_program(random, 3, 2);
    p.gradient[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(solve(p).solved);
    p.gradient[1] = 1;
    p.box_lower.setZero();
    p.box_upper.setZero();
    CHECK_FALSE(solve(p).solved);
}

TEST_CASE("a start is moved to the nearest point of constraints that cost nothing") {
    CheapConstraints disc;
    disc.lower = VectorX::Constant(2, -4);
    disc.upper = VectorX::Constant(2, 4);
    disc.row_lower = VectorX::Constant(1, -infinite);
    disc.row_upper = VectorX::Constant(1, 1);
    disc.rows = [](const VectorX& x) { return Rows{VectorX::Constant(1, x.squaredNorm()), 2 * x.transpose()}; };
    const VectorX from = Vector2(3, 4) / 2.0;
    CHECK((project(from, disc) - Vector2(0.6, 0.8)).norm() < 1e-6);
    const VectorX inside = Vector2(0.1, 0.2);
    CHECK((project(inside, disc) - inside).norm() < 1e-6);
    disc.rows = [](const VectorX&) { return std::optional<Rows>(); };
    CHECK(project(from, disc) == from);
}

}  // namespace fettle::design::optimisers::quadratic_program_test
