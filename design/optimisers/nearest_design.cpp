// SPDX-License-Identifier: MIT
#include "design/optimisers/nearest_design.hpp"

#include <utility>

namespace fettle::design::optimisers {

namespace {

using Evaluate = std::function<Evaluation(const VectorX&)>;

Evaluate with_change_as_objective(Evaluate evaluate, const VectorX& origin, const VectorX& range) {
    if (!evaluate) return evaluate;
    return [evaluate = std::move(evaluate), origin, range](const VectorX& point) {
        Evaluation e = evaluate(point);
        if (!e.usable) return e;
        e.residuals = (point - origin).cwiseQuotient(range);
        e.objective = e.residuals.squaredNorm();
        e.objective_branches = {};  // of the objective that this one replaces
        if (!e.has_derivatives) {
            e.residuals = {};
            return e;
        }
        e.residual_jacobian = range.cwiseInverse().asDiagonal();
        e.gradient = 2 * e.residuals.cwiseQuotient(range);
        return e;
    };
}

}  // namespace

double squared_change(const Problem& problem, const VectorX& origin, const VectorX& point) {
    return (point - origin).cwiseQuotient(problem.upper - problem.lower).squaredNorm();
}

Problem nearest_to(const VectorX& origin, Problem problem) {
    const VectorX range = problem.upper - problem.lower;
    problem.objective_floor = 0;
    problem.evaluate = with_change_as_objective(std::move(problem.evaluate), origin, range);
    problem.values = with_change_as_objective(std::move(problem.values), origin, range);
    for (SmootherModel& model : problem.smoother) {
        model.evaluate = with_change_as_objective(std::move(model.evaluate), origin, range);
        model.values = with_change_as_objective(std::move(model.values), origin, range);
    }
    return problem;
}

}  // namespace fettle::design::optimisers
