// SPDX-License-Identifier: MIT
#include "design/optimisers/evaluator.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace fettle::design::optimisers::evaluator_test {

namespace {

// (x - 0.2)^2 for x in [0, 1], from 0.9, and how often it was asked for, with and without its derivative.
struct Parabola {
    Problem problem;
    int with = 0, without = 0;

    Parabola() {
        problem.start = VectorX::Constant(1, 0.9);
        problem.lower = VectorX::Zero(1);
        problem.upper = VectorX::Ones(1);
        problem.constraint_lower.resize(0);
        problem.constraint_upper.resize(0);
        problem.relation_lower.resize(0);
        problem.relation_upper.resize(0);
        problem.values = [this](const VectorX& x) {
            ++without;
            return value(x[0]);
        };
        problem.evaluate = [this](const VectorX& x) {
            ++with;
            Evaluation e = value(x[0]);
            e.has_derivatives = true;
            e.gradient = VectorX::Constant(1, 2 * (x[0] - 0.2));
            e.jacobian.resize(0, 1);
            return e;
        };
    }
    Parabola(const Parabola&) = delete;

private:
    static Evaluation value(double x) {
        Evaluation e;
        e.usable = true;
        e.has_derivatives = false;
        e.objective = (x - 0.2) * (x - 0.2);
        e.constraints.resize(0);
        return e;
    }
};

VectorX at(double x) { return VectorX::Constant(1, x); }

}  // namespace

TEST_CASE("values asked for again are not computed again, derivatives asked for later are") {
    Parabola parabola;
    Evaluator evaluator(parabola.problem, {20, {}, {}, {}});
    CHECK_FALSE(evaluator.values_at(at(0.4)).has_derivatives);
    CHECK_FALSE(evaluator.values_at(at(0.4)).has_derivatives);
    CHECK(parabola.without == 1);
    CHECK(evaluator.at(at(0.4)).has_derivatives);
    CHECK(evaluator.values_at(at(0.4)).has_derivatives);  // better than what was asked for
    CHECK(parabola.with == 2);                            // the start's, and this
    CHECK(evaluator.evaluations() == 3);
}

TEST_CASE("a look costs values alone and does not become the best point") {
    Parabola parabola;
    Evaluator evaluator(parabola.problem, {20, {}, {}, {}});
    evaluator.at(at(0.5));
    CHECK_FALSE(evaluator.look(at(0.2)).has_derivatives);
    CHECK(parabola.without == 1);
    CHECK(evaluator.best_point() == at(0.5));
    CHECK(evaluator.at(at(0.2)).has_derivatives);  // asked for as a candidate it is one
    CHECK(evaluator.best_point() == at(0.2));
}

TEST_CASE("a constraint that hardly changes at the start counts by its distance from its bound, not by its derivative") {
    const auto scale_of = [](double slope, double value, double lower) {
        Parabola parabola;
        parabola.problem.constraint_lower = VectorX::Constant(1, lower);
        parabola.problem.constraint_upper = VectorX::Constant(1, std::numeric_limits<double>::infinity());
        parabola.problem.evaluate = [slope, value, plain = parabola.problem.evaluate](const VectorX& x) {
            Evaluation e = plain(x);
            e.constraints = VectorX::Constant(1, value);
            e.jacobian = MatrixX::Constant(1, 1, slope);
            return e;
        };
        return Evaluator(parabola.problem, {20, {}, {}, {}}).constraint_scale()[0];
    };
    CHECK(scale_of(2, 0, 0.2) == Approx(1 / 2.0));
    CHECK(scale_of(1e-9, 0, 0.2) == Approx(1 / 0.02));      // missed by 0.2: 10, scaled
    CHECK(scale_of(1e-9, 0.4, 0.2) == Approx(1 / 0.02));    // met
    CHECK(scale_of(1e-9, 0.2, 0.2) == Approx(1 / 0.2e-3));  // on its bound: by its value
}

TEST_CASE("a periodic variable has no walls: points, steps and boxes go through its bounds") {
    Parabola parabola;
    parabola.problem.periodic = {true};
    Evaluator evaluator(parabola.problem, {});
    CHECK(evaluator.within(at(1.25))[0] == Approx(0.25));
    CHECK(evaluator.within(at(-0.25))[0] == Approx(0.75));
    CHECK(evaluator.within(at(1))[0] == 1);
    CHECK(evaluator.moved(at(0.9), at(0.3))[0] == Approx(0.2));
    CHECK(evaluator.step_between(at(0.9), at(0.2))[0] == Approx(0.3));
    CHECK(evaluator.step_between(at(0.2), at(0.9))[0] == Approx(-0.3));
    CHECK(evaluator.steps_from(at(0.9), 0.4).upper[0] == 0.4);
    CHECK(evaluator.unscaled(at(1.25))[0] == Approx(0.25));
    const int before = evaluator.known();
    evaluator.at(at(0.5));
    evaluator.at(at(1.5));  // the same place
    CHECK(evaluator.known() == before + 1);

    parabola.problem.periodic = {};
    Evaluator walls(parabola.problem, {});
    CHECK(walls.within(at(1.25))[0] == 1);
    CHECK(walls.step_between(at(0.9), at(0.2))[0] == Approx(-0.7));
    CHECK(walls.steps_from(at(0.9), 0.4).upper[0] == Approx(0.1));
    CHECK(walls.steps_from(at(0.9), 0.4).lower[0] == -0.4);
}

}  // namespace fettle::design::optimisers::evaluator_test
