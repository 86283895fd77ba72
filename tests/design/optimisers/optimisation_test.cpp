// SPDX-License-Identifier: MIT
#include "design/optimisers/optimisation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

#include "tests/design/optimisers/known_problems.hpp"

namespace fettle::design::optimisers::optimisation_test {

namespace {

using namespace fettle::tests::design_support;

double violation_of(const Problem& problem, const VectorX& c) {
    double v = 0;
    for (int i = 0; i < c.size(); ++i) {
        v = std::max({v, problem.constraint_lower[i] - c[i] - 1e-6, c[i] - problem.constraint_upper[i] - 1e-6});
    }
    return v;
}

bool takes_equalities(const std::string& name) { return name == "sqp" || name == "ipopt" || name == "slsqp"; }

// Hock and Schittkowski 71: f = 17.0140173 at (1, 4.7429994, 3.8211503, 1.3794082). |x|^2 = 40 holds there as <= 40 too: the minimum
// over >= 40 lies lower, at the start.
Problem hock_schittkowski_71(bool equality) {
    Problem p;
    p.start = VectorX(4);
    p.start << 1, 5, 5, 1;
    p.lower = VectorX::Constant(4, 1);
    p.upper = VectorX::Constant(4, 5);
    p.constraint_lower = VectorX(2);
    p.constraint_lower << 25, equality ? 40 : -infinity;
    p.constraint_upper = VectorX(2);
    p.constraint_upper << infinity, 40;
    p.evaluate = [lower = p.constraint_lower, upper = p.constraint_upper](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
        e.gradient = VectorX(4);
        e.gradient << x[3] * (2 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1, x[0] * (x[0] + x[1] + x[2]);
        e.constraints = VectorX(2);
        e.constraints << x.prod(), x.squaredNorm();
        e.jacobian = MatrixX(2, 4);
        for (int i = 0; i < 4; ++i) e.jacobian(0, i) = x.prod() / x[i];
        e.jacobian.row(1) = 2 * x.transpose();
        Problem bounds;
        bounds.constraint_lower = lower;
        bounds.constraint_upper = upper;
        e.violation = violation_of(bounds, e.constraints);
        return e;
    };
    return p;
}

}  // namespace

TEST_CASE("each optimiser reaches Hock and Schittkowski 71's published optimum") {
    for (const std::string& name : optimiser_names()) {
        const bool derivative_free = name == "cobyla";
        const bool equality = takes_equalities(name);
        const OptimiserReport report = run(hock_schittkowski_71(equality), name, tight(derivative_free ? 2000 : 300));
        INFO(name << ": " << to_string(report.status) << ", " << report.message << ", " << report.evaluations << " evaluations, optimality "
                  << report.optimality.predicted_gain);
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK(report.best.objective == Approx(17.0140173).epsilon(1e-5));
        CHECK(report.best.violation <= 0);
        CHECK(report.optimality.predicted_gain <= report.optimality.worth);
    }
}

TEST_CASE("each optimiser keeps relations between the variables, as it does constraints") {
    for (const std::string& name : optimiser_names()) {
        // Hock and Schittkowski 71 with its product as a relation.
        const bool equality = takes_equalities(name);
        Problem p = hock_schittkowski_71(equality);
        p.relation_lower = p.constraint_lower.head(1).eval();
        p.relation_upper = p.constraint_upper.head(1).eval();
        p.constraint_lower = p.constraint_lower.tail(1).eval();
        p.constraint_upper = p.constraint_upper.tail(1).eval();
        const auto both = p.evaluate;
        p.evaluate = [both](const VectorX& x) {
            Evaluation e = both(x);
            e.constraints = e.constraints.tail(1).eval();
            e.jacobian = e.jacobian.bottomRows(1).eval();
            return e;
        };
        p.relations = [both](const VectorX& x) {
            const Evaluation e = both(x);
            return Rows{e.constraints.head(1), e.jacobian.topRows(1)};
        };
        const OptimiserReport report = run(p, name, tight(name == "cobyla" ? 2000 : 300));
        INFO(name << ": " << to_string(report.status) << ", " << report.message);
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK(report.best.objective == Approx(17.0140173).epsilon(1e-5));
        CHECK(report.best.constraints.size() == 1);
        CHECK(report.optimality.predicted_gain <= report.optimality.worth);
    }
}

TEST_CASE("a point at which a relation is no number is a failure") {
    Problem p = disc_with_cliff(infinity);
    p.relation_lower = VectorX::Constant(1, -infinity);
    p.relation_upper = VectorX::Constant(1, 10);
    p.relations = [](const VectorX& x) {  // a relation that ends at x0 = 0.6, short of the optimum
        return Rows{VectorX::Constant(1, std::sqrt(0.6 - x[0])), MatrixX::Zero(1, 2)};
    };
    const OptimiserReport report = run(p, "sqp", tight(100));
    CHECK(report.best.usable);
    CHECK(report.failures > 0);
    CHECK(report.point[0] <= 0.6);
}

TEST_CASE("a failing evaluation is overcome, not believed") {
    for (const std::string& name : optimiser_names()) {
        // The optimum has x + y = 1.4142; the first steps of every optimiser go beyond 1.6.
        const OptimiserReport report = run(disc_with_cliff(1.6), name, tight(name == "cobyla" ? 2000 : 300));
        INFO(name << ": " << to_string(report.status) << ", " << report.message << ", " << report.evaluations << " evaluations, "
                  << report.failures << " failures");
        CHECK(report.feasible);
        CHECK(report.best.objective == Approx(-std::sqrt(2.0)).epsilon(1e-4));
    }
}

TEST_CASE("a start that cannot be evaluated ends the run with its reason") {
    const OptimiserReport report = run(disc_with_cliff(-5), "sqp");
    CHECK(report.status == OptimiserStatus::start_failed);
    CHECK(report.message.find("beyond the cliff") != std::string::npos);
    CHECK(report.evaluations == 6);  // and five points on the way to the middle of the bounds
}

TEST_CASE("an unreachable requirement ends as infeasible, with the design that violates it least") {
    for (const std::string& name : optimiser_names()) {
        Problem p = disc_with_cliff(infinity);
        p.constraint_upper[0] = -0.5;  // x^2 + y^2 <= -0.5: the best violation is at 0
        const auto inner = p.evaluate;
        p.evaluate = [inner](const VectorX& x) {
            Evaluation e = inner(x);
            e.violation = x.squaredNorm() + 0.5;
            return e;
        };
        const OptimiserReport report = run(p, name);
        INFO(name << ": " << to_string(report.status) << ", " << report.message << ", violation " << report.best.violation);
        CHECK_FALSE(report.feasible);
        CHECK(report.status == OptimiserStatus::infeasible);
        CHECK(report.best.violation < 0.75);  // the start has 1
    }
}

TEST_CASE("budget, interruption and exceptions end a run, with the best design kept") {
    for (const std::string& name : optimiser_names()) {
        OptimiserOptions options = tight(5);
        int seen = 0;
        options.on_evaluation = [&](int number, const VectorX&, const Evaluation&, bool) { CHECK(number == ++seen); };
        const OptimiserReport budget = run(hock_schittkowski_71(false), name, options);
        INFO(name);
        CHECK(budget.evaluations == 5);
        CHECK(seen == 5);
        CHECK(budget.budget_spent);
        CHECK(budget.status != OptimiserStatus::optimal);

        int asked = 0;
        OptimiserOptions interrupted = tight(100);
        interrupted.should_stop = [&] { return ++asked > 4; };
        const OptimiserReport stopped = run(hock_schittkowski_71(false), name, interrupted);
        CHECK(stopped.status == OptimiserStatus::interrupted);
        CHECK(stopped.evaluations == 4);

        Problem throwing = hock_schittkowski_71(false);
        int calls = 0;
        throwing.evaluate = [&calls, inner = throwing.evaluate](const VectorX& x) {
            if (++calls == 4) throw std::runtime_error("the evaluation broke");
            return inner(x);
        };
        CHECK_THROWS_WITH(run(throwing, name, tight(100)), "the evaluation broke");
    }
}

TEST_CASE("a budget that is spent is told with as many evaluations as were made") {
    struct Spendthrift : Optimiser {
        std::string name() const override { return "spendthrift"; }
        NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions&) const override {
            for (int k = 1;; ++k) evaluator.at(VectorX::Constant(2, 0.5 + 1e-3 * k));  // until it throws
        }
    };
    Problem p = disc_with_cliff(infinity);
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.violation = 1;
        return e;
    };
    const OptimiserReport kept = optimise(p, Spendthrift(), tight(40)), whole = optimise(p, Spendthrift(), tight(10));
    CHECK(kept.evaluations == 28);
    CHECK(kept.message.find("stopped after 28 evaluations; of the 40 that the design allows") == 0);
    CHECK(whole.evaluations == 10);
    CHECK(whole.message.find("stopped after 10 evaluations, the most that the design allows") == 0);
}

TEST_CASE("each point is evaluated once, and a run repeated has the same bits") {
    for (const std::string& name : optimiser_names()) {
        const auto sequence = [&] {
            std::vector<VectorX> points;
            OptimiserOptions options = tight(60);
            options.on_evaluation = [&](int, const VectorX& x, const Evaluation&, bool) { points.push_back(x); };
            const OptimiserReport report = run(hock_schittkowski_71(false), name, options);
            CHECK(report.evaluations == count_of(points));
            return points;
        };
        const auto first = sequence(), second = sequence();
        REQUIRE(first.size() == second.size());
        for (size_t k = 0; k < first.size(); ++k) {
            CHECK(first[k] == second[k]);
            for (size_t j = 0; j < k; ++j) CHECK(first[j] != first[k]);
        }
    }
}

TEST_CASE("the first point evaluated is the start, exactly") {
    Problem p = hock_schittkowski_71(false);
    p.lower.setConstant(0.1);
    p.upper.setConstant(7.7);
    p.start << 1.1, 3.3, 4.7, 1.3;
    VectorX first;
    OptimiserOptions options = tight(1);
    options.on_evaluation = [&](int, const VectorX& x, const Evaluation&, bool) { first = x; };
    run(p, "sqp", options);
    CHECK(first == p.start);
}

TEST_CASE("smoother models are gone through first, and only the problem itself is reported") {
    Problem p = hock_schittkowski_71(true);
    std::vector<int> calls(2, 0);
    for (int k = 0; k < 2; ++k) {
        p.smoother.push_back({k == 0 ? "smoothest" : "smoother", [&calls, k, inner = p.evaluate](const VectorX& x) {
                                  ++calls[k];
                                  Evaluation e = inner(x);
                                  e.objective += 5 - k;  // that of another model
                                  return e;
                              }});
    }
    int last = 0;
    OptimiserOptions options = tight(100);
    options.on_evaluation = [&](int number, const VectorX&, const Evaluation&, bool) { last = number; };
    const OptimiserReport report = run(p, "sqp", options);
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.best.objective == Approx(17.0140173).epsilon(1e-6));
    CHECK(report.start.objective == Approx(16.0));
    REQUIRE(report.stages.size() == 3);
    CHECK(report.stages[0].model == "smoothest");
    CHECK(report.stages[0].evaluations == calls[0]);
    CHECK(report.stages[1].evaluations == calls[1]);
    CHECK(report.stages[2].evaluations < report.stages[0].evaluations + 20);
    CHECK(last == report.evaluations);

    // Stopped among the smoother models, the start is what is known of the problem itself.
    int asked = 0;
    options.should_stop = [&] { return ++asked > 3; };
    const OptimiserReport stopped = run(p, "sqp", options);
    CHECK(stopped.status == OptimiserStatus::interrupted);
    CHECK(stopped.point == p.start);
    CHECK(stopped.best.objective == Approx(16.0));
    CHECK(stopped.message.find("after 3 evaluations") != std::string::npos);
    // What they had led to by then is told, and is taken once it is known to be better.
    REQUIRE(stopped.untried.size() == p.start.size());
    OptimiserReport taken = stopped;
    take_if_better(taken, stopped.untried, p.evaluate(stopped.untried));
    const bool better = is_better(p.evaluate(stopped.untried), stopped.best);
    CHECK(taken.point == (better ? stopped.untried : p.start));
    Evaluation best = p.evaluate(report.point);
    take_if_better(taken, report.point, best);
    CHECK(taken.point == report.point);
    CHECK(taken.feasible);
    CHECK(taken.objective == best.objective);
    CHECK(taken.status == OptimiserStatus::interrupted);
    best.violation = 1;
    take_if_better(taken, p.start, best);
    CHECK(taken.point == report.point);
    CHECK(report.untried.size() == 0);
    options.should_stop = {};

    // A model that cannot be evaluated is left out.
    p.smoother[0].evaluate = [](const VectorX&) { return Evaluation{}; };
    const OptimiserReport without = run(p, "sqp", options);
    CHECK(without.status == OptimiserStatus::optimal);
}

TEST_CASE("a run never ends worse than it began, wherever the smoother models lead") {
    // x + y for x y >= 1: the least is 2. The smoother model knows no requirement and leads into the corner, where the problem itself is
    // blind or cannot be evaluated.
    const auto problem = [](const std::function<void(Evaluation&)>& corner) {
        Problem p;
        p.start = VectorX::Constant(2, 2.0);
        p.lower = VectorX::Constant(2, 0.1);
        p.upper = VectorX::Constant(2, 3.0);
        p.constraint_lower = VectorX::Constant(1, 1.0);
        p.constraint_upper = VectorX::Constant(1, std::numeric_limits<double>::infinity());
        const auto evaluate = [](const VectorX& x) {
            Evaluation e;
            e.usable = e.has_derivatives = true;
            e.objective = x.sum();
            e.gradient = VectorX::Ones(2);
            e.constraints = VectorX::Constant(1, x[0] * x[1]);
            e.jacobian = Eigen::RowVector2d(x[1], x[0]);
            e.residual_jacobian.resize(0, 2);
            e.violation = std::max(0.0, 1 - x[0] * x[1]);
            return e;
        };
        p.evaluate = [evaluate, corner](const VectorX& x) {
            Evaluation e = evaluate(x);
            if (x[0] * x[1] < 0.9) corner(e);
            return e;
        };
        p.smoother.push_back({"smooth", [evaluate](const VectorX& x) {
                                  Evaluation e = evaluate(x);
                                  e.constraints[0] += 9;
                                  e.violation = 0;
                                  return e;
                              }});
        return p;
    };
    for (const auto& corner : {std::function<void(Evaluation&)>([](Evaluation& e) { e.jacobian.setZero(); }),
                               std::function<void(Evaluation&)>([](Evaluation& e) { e = {}; })}) {
        const OptimiserReport report = run(problem(corner), "sqp", tight(60));
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK(report.best.objective == Approx(2).epsilon(1e-4));
        CHECK(report.stages.back().model.empty());
        // However few evaluations there are, half of them are the problem's own.
        for (int few = 1; few < 12; ++few) {
            const OptimiserReport cut = run(problem(corner), "sqp", tight(few));
            CHECK(cut.feasible);
            CHECK(cut.evaluations <= few);
            CHECK(cut.best.objective <= 4);
            CHECK(cut.stages.front().evaluations <= std::max(1, few / 2));
        }
    }
}

TEST_CASE("unknown optimisers are refused by name") {
    const auto made = make_optimiser("newton", "a.design.json#/optimiser/name");
    REQUIRE_FALSE(made);
    CHECK(made.errors()[0].code == ErrorCode::out_of_range);
    CHECK(made.errors()[0].message.find("slsqp") != std::string::npos);
}

TEST_CASE("an optimiser without derivatives is not charged for any, but for the scales at its start and the verdict at its end") {
    Problem problem = hock_schittkowski_71(false);
    int with = 0, without = 0;
    problem.values = [&, evaluate = problem.evaluate](const VectorX& x) {
        ++without;
        Evaluation e = evaluate(x);
        e.has_derivatives = false;
        e.gradient = {};
        e.jacobian = {};
        return e;
    };
    problem.evaluate = [&, evaluate = problem.evaluate](const VectorX& x) {
        ++with;
        return evaluate(x);
    };
    OptimiserOptions options;
    options.max_evaluations = 400;
    const OptimiserReport report = optimise(problem, **make_optimiser("cobyla"), options);
    CHECK(report.feasible);
    CHECK(report.best.objective == Approx(17.014).epsilon(1e-2));
    CHECK(report.evaluations == with + without);
    CHECK(without > 3 * with);
    CHECK(report.best.has_derivatives);  // what the verdict is of
    CHECK(report.optimality.step.size() == 4);
}

}  // namespace fettle::design::optimisers::optimisation_test
