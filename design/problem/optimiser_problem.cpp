// SPDX-License-Identifier: MIT
#include "design/problem/optimiser_problem.hpp"

#include <cmath>

#include "design/optimisers/projection.hpp"
#include "design/problem/periodic_parameters.hpp"

namespace fettle::design::problem {

namespace {

// Onto the constraints that a simulation changes nothing of.
std::function<VectorX(const VectorX&)> prepared(const DesignProblem& design_problem, const optimisers::Problem& problem) {
    const std::vector<int> rest = design_problem.rest_constraints();
    optimisers::CheapConstraints cheap;
    cheap.lower = problem.lower;
    cheap.upper = problem.upper;
    cheap.row_lower = problem.constraint_lower(rest);
    cheap.row_upper = problem.constraint_upper(rest);
    cheap.rows = [&design_problem](const VectorX& p) { return design_problem.rest_rows(p); };
    return [cheap](const VectorX& start) { return optimisers::project(start, cheap); };
}

}  // namespace

EvaluateOptions without_gradients(EvaluateOptions options) {
    options.gradients = false;
    return options;
}

optimisers::Problem optimiser_problem(const DesignProblem& design_problem, const EvaluateOptions& options) {
    const description::Design& design = design_problem.design();
    const auto n = static_cast<Eigen::Index>(design.parameters.size()), m = static_cast<Eigen::Index>(design.constraints.size());
    optimisers::Problem problem;
    problem.start = description::values_of(design.parameters);
    problem.lower.resize(n);
    problem.upper.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        problem.lower[k] = design.parameters[k].lower;
        problem.upper[k] = design.parameters[k].upper;
    }
    problem.periodic = periodic_parameters(design);
    problem.representable = [&design](const VectorX& p) {
        VectorX q = p;
        for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = description::representable(p[k], design.parameters[k].unit);
        return q;
    };
    problem.constraint_lower.resize(m);
    problem.constraint_upper.resize(m);
    problem.constraint_margin.resize(m);
    for (Eigen::Index i = 0; i < m; ++i) {
        problem.constraint_lower[i] = description::target_lower(design.constraints[i].bounds);
        problem.constraint_upper[i] = description::target_upper(design.constraints[i].bounds);
        problem.constraint_margin[i] = design.constraints[i].bounds.margin;
        problem.is_greatest.push_back(design.constraints[i].quantity->is_greatest_branch());
    }
    if (!design_problem.rest_constraints().empty()) problem.prepared = prepared(design_problem, problem);
    const auto k = static_cast<Eigen::Index>(design.relations.size());
    problem.relation_lower.resize(k);
    problem.relation_upper.resize(k);
    problem.relation_margin.resize(k);
    for (Eigen::Index i = 0; i < k; ++i) {
        problem.relation_lower[i] = description::target_lower(design.relations[i].bounds);
        problem.relation_upper[i] = description::target_upper(design.relations[i].bounds);
        problem.relation_margin[i] = design.relations[i].bounds.margin;
    }
    if (k > 0) problem.relations = [&design_problem](const VectorX& p) { return design_problem.relations(p); };
    problem.refusal = [&design_problem](const VectorX& p) { return design_problem.refusal(p); };
    problem.evaluate = [&design_problem, options](const VectorX& p) { return optimiser_evaluation(design_problem.evaluate(p, options)); };
    problem.values = [&design_problem, values = without_gradients(options)](const VectorX& p) {
        return optimiser_evaluation(design_problem.evaluate(p, values));
    };
    return problem;
}

optimisers::Evaluation optimiser_evaluation(const DesignEvaluation& evaluation) {
    if (evaluation.interrupted) throw optimisers::Interrupted();
    optimisers::Evaluation e;
    e.usable = evaluation.usable;
    e.reason = evaluation.reason;
    if (!e.usable) return e;
    e.objective = evaluation.objective;
    e.has_derivatives = evaluation.gradient.size() > 0;
    e.constraints = search_values(evaluation);
    if (!evaluation.continued.empty()) {
        e.measured.resize(evaluation.constraints.size());
        for (size_t i = 0; i < evaluation.constraints.size(); ++i) e.measured[i] = evaluation.constraints[i].value;
    }
    e.violation = evaluation.violation;
    if (e.has_derivatives) {
        e.gradient = evaluation.gradient;
        e.jacobian = search_jacobian(evaluation);
        e.residuals = evaluation.residuals;
        e.residual_jacobian = evaluation.residual_jacobian;
        e.constraint_branches = evaluation.constraint_branches;
        e.objective_branches = evaluation.objective_branches;
    }
    if (std::isfinite(e.objective) && e.gradient.allFinite() && e.constraints.allFinite() && e.jacobian.allFinite() &&
        e.constraint_branches.jacobian.allFinite() && e.objective_branches.jacobian.allFinite() && std::isfinite(e.violation))
        return e;
    optimisers::Evaluation failed;
    failed.reason = "a value or derivative is not finite";
    return failed;
}

}  // namespace fettle::design::problem
