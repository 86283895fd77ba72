// SPDX-License-Identifier: MIT
#include "design/optimisers/nearest_design.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace fettle::design::optimisers {

namespace {

using Evaluate = std::function<Evaluation(const VectorX&)>;

// r of a point; of a periodic variable the shorter way round.
struct Change {
    VectorX origin, range;
    std::vector<bool> periodic;

    Change(const Problem& problem, VectorX from)
        : origin(std::move(from)),
          range((problem.upper - problem.lower).unaryExpr([](double r) { return r > 0 ? r : 1.0; })),
          periodic(problem.periodic) {}

    VectorX operator()(const VectorX& point) const {
        VectorX r = (point - origin).cwiseQuotient(range);
        for (size_t k = 0; k < periodic.size(); ++k)
            if (periodic[k]) r[static_cast<Eigen::Index>(k)] -= std::round(r[static_cast<Eigen::Index>(k)]);
        return r;
    }
};

Evaluate with_change_as_objective(Evaluate evaluate, const Change& change) {
    if (!evaluate) return evaluate;
    return [evaluate = std::move(evaluate), change](const VectorX& point) {
        Evaluation e = evaluate(point);
        if (!e.usable) return e;
        e.residuals = change(point);
        e.objective = e.residuals.squaredNorm();
        e.objective_branches = {};  // of the objective that this one replaces
        if (!e.has_derivatives) {
            e.residuals = {};
            return e;
        }
        e.residual_jacobian = change.range.cwiseInverse().asDiagonal();
        e.gradient = 2 * e.residuals.cwiseQuotient(change.range);
        return e;
    };
}

}  // namespace

double squared_change(const Problem& problem, const VectorX& origin, const VectorX& point) {
    return Change(problem, origin)(point).squaredNorm();
}

Problem nearest_to(const VectorX& origin, Problem problem) {
    const Change change(problem, origin);
    problem.objective_floor = 0;
    problem.evaluate = with_change_as_objective(std::move(problem.evaluate), change);
    problem.values = with_change_as_objective(std::move(problem.values), change);
    for (SmootherModel& model : problem.smoother) {
        model.evaluate = with_change_as_objective(std::move(model.evaluate), change);
        model.values = with_change_as_objective(std::move(model.values), change);
    }
    return problem;
}

}  // namespace fettle::design::optimisers
