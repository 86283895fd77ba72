// SPDX-License-Identifier: MIT
#include "design/optimisers/optimality.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/design/optimisers/known_problems.hpp"

namespace fettle::design::optimisers::optimality_test {

namespace {

using namespace fettle::tests::design_support;

// Stays where it is put.
class Idle : public Optimiser {
public:
    std::string name() const override { return "idle"; }
    NativeOutcome minimise(Evaluator&, const OptimiserOptions&) const override { return {}; }
};

// Values that scatter by `noise`, the same at the same point.
Problem rough_bowl(double noise) {
    Problem p;
    p.start = VectorX::Constant(2, 0.9);
    p.lower = VectorX::Constant(2, -1);
    p.upper = VectorX::Constant(2, 1);
    p.evaluate = [noise](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        const double scatter = noise * std::sin(1e9 * x[0] + 3e9 * x[1]);
        e.objective = 1 + x.squaredNorm() + scatter;
        e.gradient = 2 * x;
        e.constraints.resize(0);
        e.jacobian.resize(0, 2);
        return e;
    };
    return p;
}

}  // namespace

TEST_CASE("a design that can be improved is not called optimal, and the variables that could move are named") {
    Problem p = disc_with_cliff(infinity);
    p.start = Vector2(-0.9, 0.1);
    const OptimiserReport report = optimise(p, Idle(), tight(20));
    CHECK(report.status == OptimiserStatus::feasible);
    CHECK(report.best.objective < 0.8 - 0.1);  // the probes' gains are kept
    REQUIRE(report.optimality.improvable.size() >= 1);
    CHECK(report.optimality.predicted_gain > report.optimality.worth);
}

TEST_CASE("where the noise cannot be measured, nothing is called optimal") {
    Problem p = rough_bowl(0);
    p.start.setZero();
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.usable = x.norm() < 1e-4;  // nothing beside the optimum can be evaluated
        return e;
    };
    const OptimiserReport report = optimise(p, Idle(), tight(40));
    CHECK(report.status == OptimiserStatus::feasible);
    CHECK_FALSE(report.optimality.judged);
}

TEST_CASE("where what promises a gain cannot be evaluated, nothing is called optimal, and the reason is told") {
    Problem p = rough_bowl(0);
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.usable = x[0] >= 0.3;
        if (!e.usable) e.reason = "too thin";
        return e;
    };
    for (const std::string& name : {"sqp", "ipopt", "slsqp", "mma", "cobyla"}) {
        INFO(name);
        const OptimiserReport report = run(p, name, tight(80));
        CHECK(report.status == OptimiserStatus::feasible);
        CHECK(report.best.objective < 1.3);
        CHECK(report.optimality.predicted_gain > report.optimality.worth);
        const std::vector<int>& improvable = report.optimality.improvable;
        CHECK(std::find(improvable.begin(), improvable.end(), 0) != improvable.end());
        for (const int k : improvable) CHECK(report.optimality.held[k] == Held::free);
        CHECK(report.message.find("no change near by promises") == std::string::npos);
        if (name == "mma" || name == "cobyla") continue;  // may still gain when their rounds end
        CHECK(report.point[0] == Approx(0.3).margin(0.02));
        CHECK(report.optimality.refused == "too thin");
        CHECK(report.optimality.held[0] == Held::free);
    }
}

TEST_CASE("noise above the tolerance makes no optimum; below it, it does no harm") {
    OptimiserOptions options;
    options.tolerance = 1e-4;
    options.max_evaluations = 80;
    const OptimiserReport rough = run(rough_bowl(1e-3), "sqp", options);
    CHECK(rough.status == OptimiserStatus::feasible);
    CHECK(rough.optimality.roughest == 0);
    CHECK(rough.optimality.noise_in_objective == Approx(1e-3 * std::sqrt(0.5)).epsilon(0.7));
    const OptimiserReport smooth = run(rough_bowl(1e-6), "sqp", options);
    CHECK(smooth.status == OptimiserStatus::optimal);
    CHECK(smooth.best.objective == Approx(1).margin(2e-4));
}

namespace {

// Room of a point among planes n_i.x <= 1 all round: the least of 1 - n_i.x.
struct Room {
    std::vector<Vector2> normals;
    explicit Room(int planes) {
        for (int i = 0; i < planes; ++i) {
            const double angle = 2 * M_PI * i / planes + 0.1;
            normals.emplace_back(std::cos(angle), std::sin(angle));
        }
    }
    // As rows, the least first.
    Branches at(const Vector2& x) const {
        Branches rows;
        rows.values.resize(normals.size());
        rows.jacobian.resize(rows.values.size(), 2);
        std::vector<Vector2> order = normals;
        std::stable_sort(order.begin(), order.end(), [&](const Vector2& a, const Vector2& b) { return a.dot(x) > b.dot(x); });
        for (const Vector2& n : order) {
            const auto k = static_cast<Eigen::Index>(rows.of.size());
            rows.of.push_back(0);
            rows.values[k] = 1 - n.dot(x);
            rows.jacobian.row(k) = -n.transpose();
        }
        return rows;
    }
};

Problem among_planes() {
    Problem p;
    p.start = Vector2(0.31, -0.47);
    p.lower = Vector2(-0.9, -0.9);
    p.upper = Vector2(0.9, 0.9);
    return p;
}

// Minimises 3 - room + 0.01 |x|^2: its only minimum is the kink at 0.
Problem largest_room(bool with_branches) {
    Problem p = among_planes();
    p.evaluate = [with_branches, room = Room(16)](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        Branches rows = room.at(x);
        rows.values *= -1;
        rows.jacobian *= -1;
        e.objective = 3 + rows.values[0] + 0.01 * x.squaredNorm();
        e.gradient = rows.jacobian.row(0).transpose() + 0.02 * x;
        e.constraints.resize(0);
        e.jacobian.resize(0, 2);
        if (with_branches) e.objective_branches = rows;
        return e;
    };
    return p;
}

// Minimises x0 where the room is at least `least`: at `least` = 1 only 0 is left.
Problem least_room(bool with_branches, double least) {
    Problem p = among_planes();
    p.constraint_lower = VectorX::Constant(1, least);
    p.constraint_upper = VectorX::Constant(1, infinity);
    p.evaluate = [with_branches, least, room = Room(16)](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = 2 + x[0];
        e.gradient = Vector2(1, 0);
        Branches rows = room.at(x);
        e.constraints = rows.values.head(1);
        e.jacobian = rows.jacobian.topRows(1);
        e.violation = std::max(0.0, least - 1e-6 - rows.values[0]);
        if (!with_branches) return e;
        e.constraint_branches.of.assign(rows.of.begin() + 1, rows.of.end());
        e.constraint_branches.values = rows.values.tail(rows.values.size() - 1);
        e.constraint_branches.jacobian = rows.jacobian.bottomRows(rows.values.size() - 1);
        return e;
    };
    return p;
}

OptimiserOptions usual(int evaluations) {
    OptimiserOptions options;
    options.max_evaluations = evaluations;
    return options;
}

}  // namespace

namespace {

// Minimises 1 + x0 + 0.01 x1^2 where x0 >= 0 is required, and 0.02 more is aimed at: values below `reached` turn out to violate it.
Problem beside_a_bound(double reached) {
    Problem p;
    p.start = Vector2(0.6, 0.5);
    p.lower = Vector2(-1, -1);
    p.upper = Vector2(1, 1);
    p.constraint_lower = VectorX::Constant(1, 0.02);
    p.constraint_upper = VectorX::Constant(1, infinity);
    p.constraint_margin = VectorX::Constant(1, 0.02);
    p.evaluate = [reached](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = 1 + x[0] + 0.01 * x[1] * x[1];
        e.gradient = Vector2(1, 0.02 * x[1]);
        e.constraints = x.head(1);
        e.jacobian = Vector2(1, 0).transpose();
        e.violation = std::max(0.0, reached - x[0]);
        return e;
    };
    return p;
}

}  // namespace

TEST_CASE("the margin to a bound is given up at the end, but for a twentieth") {
    for (const std::string& name : {"sqp", "ipopt", "slsqp"}) {
        const OptimiserReport report = run(beside_a_bound(0), name, usual(60));
        INFO(name << ": " << report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK(report.point[0] >= 0);
        CHECK(report.point[0] <= 0.0012);
    }
}

TEST_CASE("a design inside the margin is not called optimal while anything else gains") {
    // Going back to what is aimed at would cost more than the other variable gains.
    Problem p = beside_a_bound(0);
    p.start = Vector2(0.001, 0.9);
    const OptimiserReport report = optimise(p, Idle(), usual(40));
    INFO(report.message << ", at " << report.point.transpose());
    CHECK(report.best.objective < 1.002);
}

TEST_CASE("where the last of the margin is needed, the verdict keeps a quarter of it") {
    const OptimiserReport report = run(beside_a_bound(0.003), "sqp", usual(80));
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.point[0] >= 0.003);
    CHECK(report.point[0] <= 0.0052);
}

namespace {

// Minimises 1 + x1 - x0 / 10 where x1 >= curvature x0^2 + slope x0 is required, and `margin` more is aimed at.
struct Parabola {
    double curvature, slope, margin;

    double height(double x0) const { return curvature * x0 * x0 + slope * x0; }
    double least_objective() const { return 1 - std::pow(slope - 0.1, 2) / (4 * curvature); }
    Problem from(double x0) const {
        Problem p;
        p.start = Vector2(x0, height(x0) + 2 * margin);
        p.lower = Vector2(-1, -3);
        p.upper = Vector2(1, 5);
        p.constraint_lower = p.constraint_margin = VectorX::Constant(1, margin);
        p.constraint_upper = VectorX::Constant(1, infinity);
        p.evaluate = [*this](const VectorX& x) {
            Evaluation e;
            e.usable = true;
            e.objective = 1 + x[1] - 0.1 * x[0];
            e.gradient = Vector2(-0.1, 1);
            e.constraints = VectorX::Constant(1, x[1] - height(x[0]));
            e.jacobian = Vector2(-2 * curvature * x[0] - slope, 1).transpose();
            e.violation = std::max(0.0, -e.constraints[0]);
            return e;
        };
        return p;
    }
};

}  // namespace

TEST_CASE("where a requirement curves, a design with gain in its margin is not called optimal, and most of the margin is given up") {
    OptimiserOptions options = usual(60);
    options.tolerance = 1e-3;
    for (const Parabola& wall : {Parabola{1, 0, 0.005}, Parabola{10, 0, 0.0005}, Parabola{10, -1, 0.0005}}) {
        for (const double x0 : {-0.2, -0.05, -0.01, 0.01, 0.1, 0.3}) {
            for (const bool idle : {true, false}) {
                const Problem p = wall.from(x0);
                const OptimiserReport report = idle ? optimise(p, Idle(), options) : run(p, "sqp", options);
                INFO((idle ? "idle" : "sqp") << ", curvature " << wall.curvature << ", from " << x0 << ": " << report.message << ", "
                                             << report.evaluations << " evaluations, objective " << report.objective << " for "
                                             << wall.least_objective());
                CHECK((idle || report.status == OptimiserStatus::optimal));
                if (report.status != OptimiserStatus::optimal) continue;
                CHECK(report.objective <= wall.least_objective() + 0.25 * wall.margin + 5 * options.tolerance);
            }
        }
    }
}

TEST_CASE("a variable at its bound, but for rounding, is held by it") {
    // x0 moves the requirement that holds x1, too.
    Problem p;
    p.start = Vector2(1 - 5e-9, 0.5);
    p.lower = Vector2(0, 0);
    p.upper = Vector2(1, 1);
    p.constraint_lower = VectorX::Constant(1, 0.49);
    p.constraint_upper = VectorX::Constant(1, infinity);
    p.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = 1 + x[1] - 0.02 * x[0];
        e.gradient = Vector2(-0.02, 1);
        e.constraints = VectorX::Constant(1, x[1] - 0.01 * x[0]);
        e.jacobian = Vector2(-0.01, 1).transpose();
        e.violation = std::max(0.0, 0.49 - 1e-7 - e.constraints[0]);
        return e;
    };
    const OptimiserReport report = optimise(p, Idle(), usual(40));
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.optimality.held[0] == Held::upper_bound);
    CHECK(report.optimality.held[1] == Held::constraints);
    CHECK(report.optimality.residual[0] == 0);
    // On its way there it could still move, and nothing holds it.
    p.start[0] = 0.95;
    const OptimiserReport before = optimise(p, Idle(), usual(1));
    REQUIRE(before.optimality.improvable == std::vector<int>{0});
    CHECK(before.optimality.held[0] == Held::free);
}

TEST_CASE("a saddle is left: what is symmetric is not yet optimal") {
    // A plank in a corridor that is as wide as its middle is high: -length, which may be 1 / cos of how far it leans, up to 0.5.
    Problem p;
    p.start = Vector2(0.6, 0);
    p.lower = Vector2(0, -0.5);
    p.upper = Vector2(2, 0.5);
    p.constraint_lower = VectorX::Constant(1, -infinity);
    p.constraint_upper = VectorX::Constant(1, 1);
    p.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = -x[0];
        e.gradient = Vector2(-1, 0);
        e.constraints = VectorX::Constant(1, x[0] * std::cos(x[1]));
        e.jacobian = Vector2(std::cos(x[1]), -x[0] * std::sin(x[1])).transpose();
        e.violation = std::max(0.0, e.constraints[0] - 1 - 1e-6);
        return e;
    };
    const OptimiserReport report = run(p, "sqp", usual(60));
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.objective == Approx(-1 / std::cos(0.5)).epsilon(2e-4));
    // Where it may not lean, the same look aside finds nothing, and costs little.
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.constraints[0] = x[0] / std::cos(x[1]);
        e.jacobian = Vector2(1 / std::cos(x[1]), x[0] * std::sin(x[1]) / std::pow(std::cos(x[1]), 2)).transpose();
        e.violation = std::max(0.0, e.constraints[0] - 1 - 1e-6);
        return e;
    };
    const OptimiserReport upright = run(p, "sqp", usual(60));
    INFO(upright.message << ", " << upright.evaluations << " evaluations, at " << upright.point.transpose());
    CHECK(upright.status == OptimiserStatus::optimal);
    CHECK(upright.objective == Approx(-1).epsilon(2e-4));
    CHECK(upright.evaluations <= 20);
}

TEST_CASE("an objective's kink is found, and called optimal, where its branches are known") {
    const OptimiserReport report = run(largest_room(true), "sqp", usual(40));
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.point.norm() < 1e-3);
    CHECK(report.optimality.predicted_gain <= report.optimality.worth);
    const OptimiserReport blind = run(largest_room(false), "sqp", usual(40));
    INFO("blind: " << blind.message << ", " << blind.evaluations << " evaluations, at " << blind.point.transpose());
    CHECK((blind.status != OptimiserStatus::optimal || blind.evaluations > report.evaluations));
}

TEST_CASE("branches of a constraint hold a step that one of them would let go") {
    const OptimiserReport report = run(least_room(true, 0.4), "sqp", usual(40));
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == OptimiserStatus::optimal);
    // The vertex of the planes next to -x: a linear programme, found at once.
    CHECK(report.best.objective == Approx(2 - 0.6 / std::cos(M_PI / 16) * std::cos(0.1 + M_PI / 16 - M_PI / 8)).margin(3e-3));
    CHECK(report.optimality.multipliers[0] > 0.9);  // both planes' together

    const OptimiserReport centred = run(least_room(true, 1), "sqp", usual(40));
    INFO("centred: " << centred.message << ", " << centred.evaluations << " evaluations, at " << centred.point.transpose());
    CHECK(centred.status == OptimiserStatus::optimal);
    CHECK(centred.point.norm() < 1e-4);
    CHECK(centred.optimality.held[0] == Held::constraints);
}

TEST_CASE("what bends is not called noise, what scatters is") {
    // The steeper the bowl, the more the differences of its values look like scatter over a wide spacing.
    Problem smooth = rough_bowl(0);
    smooth.start = Vector2(0.02, -0.01);
    smooth.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        const Vector2 steep(400 * x[0] + 30 * x[1], 300 * x[1]);
        e.objective = 1 - std::cos(steep[0]) * std::cos(steep[1]);
        e.gradient = Vector2(400 * std::sin(steep[0]) * std::cos(steep[1]),
                             30 * std::sin(steep[0]) * std::cos(steep[1]) + 300 * std::cos(steep[0]) * std::sin(steep[1]));
        e.constraints.resize(0);
        e.jacobian.resize(0, 2);
        return e;
    };
    const OptimiserReport bent = run(smooth, "sqp", tight(300));
    CHECK(bent.optimality.judged);
    CHECK(bent.optimality.roughest == -1);

    Problem rough = rough_bowl(1e-3);
    rough.start.setZero();
    const OptimiserReport scattered = optimise(rough, Idle(), tight(100));
    CHECK(scattered.optimality.roughest == 0);
    CHECK(scattered.status == OptimiserStatus::feasible);
}

TEST_CASE("a curvature that residuals only seem to have hides no gain") {
    // Two residuals a variable, 10 x and 10 sqrt(1 - 0.99 x^2 + 0.004 x): Gauss-Newton sees a curvature of 200 where there is one of 2.
    constexpr int n = 6;
    Problem p;
    p.start = VectorX::Zero(n);
    p.lower = VectorX::Constant(n, -0.9);
    p.upper = VectorX::Constant(n, 0.9);
    p.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.residuals.resize(2 * n);
        e.residual_jacobian = MatrixX::Zero(2 * n, n);
        for (Eigen::Index k = 0; k < n; ++k) {
            const double root = std::sqrt(1 - 0.99 * x[k] * x[k] + 0.004 * x[k]);
            e.residuals[2 * k] = 10 * x[k];
            e.residuals[2 * k + 1] = 10 * root;
            e.residual_jacobian(2 * k, k) = 10;
            e.residual_jacobian(2 * k + 1, k) = 5 * (0.004 - 1.98 * x[k]) / root;
        }
        e.objective = e.residuals.squaredNorm();
        e.gradient = 2 * e.residual_jacobian.transpose() * e.residuals;
        e.constraints.resize(0);
        e.jacobian.resize(0, n);
        return e;
    };
    // sum (100 + x^2 + 0.4 x): the least, 0.04 below the start for each, at x = -0.2.
    OptimiserOptions options;
    options.tolerance = 2e-5;  // 0.012 of 600
    const OptimiserReport report = optimise(p, Idle(), options);
    CHECK(report.best.objective < 100 * n - 0.04 * n + 0.02);
}

}  // namespace fettle::design::optimisers::optimality_test
