// SPDX-License-Identifier: MIT
#include "design/studies/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "design/optimisers/optimisation.hpp"
#include "design/tolerances/propagation.hpp"

namespace fettle::design::studies {

namespace {

constexpr int most_simulations = 30;  // of one search
constexpr double gain = 1e-3;         // of the linear half width: less is not worth a simulation

double change(const LocalModel& model, const VectorX& d) {
    return model.gradient.dot(d) + (model.curvature.size() == 0 ? 0 : 0.5 * d.dot(model.curvature * d));
}

// Uphill in side * change, to the best place along one coordinate after the other.
VectorX climbed(const LocalModel& model, double side, VectorX d, const VectorX& lower, const VectorX& upper) {
    const auto n = d.size();
    for (int round = 0; round < 100; ++round) {
        bool moved = false;
        for (Eigen::Index k = 0; k < n; ++k) {
            const double slope = side * (model.gradient[k] + model.curvature.row(k).dot(d) - model.curvature(k, k) * d[k]);
            const double bend = side * model.curvature(k, k);
            const auto along = [&](double x) { return slope * x + 0.5 * bend * x * x; };
            double best = along(lower[k]) > along(upper[k]) ? lower[k] : upper[k];
            if (bend < 0) best = std::clamp(-slope / bend, lower[k], upper[k]);
            if (along(best) > along(d[k])) {
                d[k] = best;
                moved = true;
            }
        }
        if (!moved) break;
    }
    return d;
}

}  // namespace

VectorX quadratic_corner(const LocalModel& model, double side, const VectorX& lower, const VectorX& upper) {
    constexpr int few = 10;
    const auto n = static_cast<int>(lower.size());
    std::vector<VectorX> starts{0.5 * (lower + upper)};
    for (int sign = -1; sign <= 1; sign += 2)
        starts.emplace_back((sign * side * model.gradient.array() > 0).select(upper.array(), lower.array()).matrix());
    for (int corner = 0; n <= few && corner < 1 << n; ++corner) {
        VectorX d(n);
        for (int k = 0; k < n; ++k) d[k] = (corner >> k & 1) != 0 ? upper[k] : lower[k];
        starts.push_back(std::move(d));
    }
    VectorX best;
    for (const VectorX& start : starts) {
        VectorX end = climbed(model, side, start, lower, upper);
        if (best.size() == 0 || side * change(model, end) > side * change(model, best)) best = std::move(end);
    }
    return best;
}

WorstCaseSearch::WorstCaseSearch(const MadeResponses& design) : design_(design) {
    const int n = count_of(design.tolerances());
    lower_.resize(n);
    upper_.resize(n);
    for (int k = 0; k < n; ++k) {
        lower_[k] = design.tolerances()[k].deviation.lower;
        upper_[k] = design.tolerances()[k].deviation.upper;
    }
}

// Two threads may simulate the same: the results are the same.
MadeEvaluation WorstCaseSearch::evaluated(const VectorX& deviations) {
    const std::vector<double> key(deviations.begin(), deviations.end());
    {
        const std::lock_guard lock(mutex_);
        const auto known = known_.find(key);
        if (known != known_.end()) return known->second;
    }
    MadeEvaluation evaluation = design_.evaluate(deviations, true);
    if (evaluation.interrupted) throw optimisers::Interrupted();
    const std::lock_guard lock(mutex_);
    return known_.emplace(key, std::move(evaluation)).first->second;
}

FoundExtreme WorstCaseSearch::extreme(int number, double side, const LocalModel& model) {
    FoundExtreme out;
    out.value = std::numeric_limits<double>::quiet_NaN();
    const tolerances::LinearWorstCase linear = tolerances::linear_worst_case(model.nominal, model.gradient, lower_, upper_);
    const VectorX named = side > 0 ? linear.at_most : linear.at_least;
    const double scale = 0.5 * (linear.most - linear.least);
    if (!(scale > 0)) return {model.nominal, named, true, {}, {}, 0};
    std::vector<Eigen::Index> free;
    for (Eigen::Index k = 0; k < lower_.size(); ++k)
        if (lower_[k] < upper_[k]) free.push_back(k);
    const auto whole = [&](const VectorX& x) {
        VectorX d = named;
        d(free) = x;
        return d;
    };
    const auto evaluate = [&](const VectorX& x) {
        const VectorX d = whole(x);
        const MadeEvaluation made = evaluated(d);
        ++out.simulations;
        optimisers::Evaluation evaluation;
        evaluation.usable = made.usable;
        evaluation.reason = made.reason;
        if (!made.usable) {
            if (out.failure.empty()) {
                out.failure = made.reason;
                out.failed_at = d;
            }
            return evaluation;
        }
        evaluation.objective = -side * (made.values[number] - model.nominal) / scale;
        evaluation.gradient = -side / scale * VectorX(made.jacobian.row(number).transpose())(free);
        evaluation.jacobian.resize(0, count_of(free));
        return evaluation;
    };
    std::vector<VectorX> starts{named(free)};
    if (model.curvature.size() > 0) {
        const VectorX other = quadratic_corner(model, side, lower_, upper_)(free);
        if (other != starts.front()) starts.push_back(other);
    }
    const auto objective_at = [&](const VectorX& x) {
        const optimisers::Evaluation evaluation = evaluate(x);
        return evaluation.usable ? evaluation.objective : std::numeric_limits<double>::infinity();
    };
    if (starts.size() == 2 && objective_at(starts[1]) < objective_at(starts[0])) std::swap(starts[0], starts[1]);
    optimisers::Problem problem;
    problem.start = starts.front();
    problem.lower = lower_(free);
    problem.upper = upper_(free);
    problem.evaluate = evaluate;
    optimisers::OptimiserOptions options;
    options.max_evaluations = most_simulations;
    options.tolerance = gain;
    options.should_stop = [this] { return design_.should_stop(); };
    const auto optimiser = optimisers::make_optimiser(optimisers::optimiser_names().front()).value();
    const optimisers::OptimiserReport report = optimisers::optimise(problem, *optimiser, options);
    if (report.status == optimisers::OptimiserStatus::interrupted) throw optimisers::Interrupted();
    if (!std::isfinite(report.objective)) return out;
    out.value = model.nominal - side * scale * report.objective;
    out.deviations = whole(report.point);
    out.settled = report.status == optimisers::OptimiserStatus::optimal;
    return out;
}

}  // namespace fettle::design::studies
