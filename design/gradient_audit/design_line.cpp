// SPDX-License-Identifier: MIT
#include "design/gradient_audit/design_line.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"

namespace fettle::design::gradient_audit {

VectorX quantities_of(const problem::DesignEvaluation& evaluation) {
    VectorX q(static_cast<Eigen::Index>(evaluation.constraints.size()) + 1);
    q << evaluation.objective, problem::search_values(evaluation);
    return q;
}

std::vector<std::string> quantity_names(const description::Design& design) {
    std::vector<std::string> names{"objective"};
    for (const description::Constraint& constraint : design.constraints) names.push_back(constraint.name);
    return names;
}

MatrixX quantity_gradients(const problem::DesignEvaluation& evaluation) {
    MatrixX gradients(evaluation.jacobian.rows() + 1, evaluation.gradient.size());
    gradients << evaluation.gradient.transpose(), problem::search_jacobian(evaluation);
    return gradients;
}

VectorX parameter_ranges(const description::Design& design) {
    VectorX ranges(design.parameters.size());
    for (Eigen::Index k = 0; k < ranges.size(); ++k) {
        const description::Parameter& parameter = design.parameters[k];
        ranges[k] = parameter.upper > parameter.lower ? parameter.upper - parameter.lower : std::max(std::abs(parameter.value), 1e-6);
    }
    return ranges;
}

DesignLine::DesignLine(const problem::DesignProblem& problem, const VectorX& p, const VectorX& direction)
    : problem_(problem), p_(p), least_(-core::base::infinity), most_(core::base::infinity) {
    FETTLE_ASSERT(direction.size() == problem.parameter_count() && direction.allFinite() && !direction.isZero(0), "a direction");
    step_ = direction.cwiseProduct(parameter_ranges(problem.design()));
    for (Eigen::Index k = 0; k < step_.size(); ++k) {
        if (step_[k] == 0) continue;
        const description::Parameter& parameter = problem.design().parameters[k];
        const double a = (parameter.lower - p[k]) / step_[k], b = (parameter.upper - p[k]) / step_[k];
        least_ = std::max(least_, std::min({a, b, 0.0}));
        most_ = std::min(most_, std::max({a, b, 0.0}));
    }
}

std::vector<LinePoint> DesignLine::evaluate(const std::vector<double>& ts, const std::function<bool()>& should_stop,
                                            const std::function<void()>& on_simulation) const {
    std::vector<LinePoint> points(ts.size());
    std::mutex progress;
    core::base::parallel_for(count_of(ts), 1, [&](int i) {
        LinePoint& point = points[i];
        point.t = ts[i];
        problem::EvaluateOptions options;
        options.gradients = false;
        options.should_stop = should_stop;
        const problem::DesignEvaluation evaluation = problem_.evaluate(p_ + point.t * step_, options);
        point.usable = evaluation.usable;
        point.reason = evaluation.reason;
        point.interrupted = evaluation.interrupted;
        if (point.usable) point.values = quantities_of(evaluation);
        if (point.usable && !point.values.allFinite()) {
            point.usable = false;
            point.reason = "a quantity is not a finite number";
        }
        const std::lock_guard<std::mutex> lock(progress);
        if (on_simulation) on_simulation();
    });
    return points;
}

}  // namespace fettle::design::gradient_audit
