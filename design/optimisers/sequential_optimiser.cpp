// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/sequential_optimiser.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/design/optimisers/local_model.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double accepted_share = 0.1;  // of the predicted decrease
constexpr double good_share = 0.75, bad_share = 0.25;
constexpr double shrink = 0.35, after_failure = 0.3, largest_radius = 0.5;
constexpr double most_penalty = 1e8;

class SequentialRun {
public:
    SequentialRun(Evaluator& evaluator, const OptimiserOptions& options, Curvature curvature)
        : evaluator_(evaluator),
          options_(options),
          curvature_(curvature),
          rest_(evaluator.variables()),
          point_(evaluator.best_scaled_point()),
          at_(&evaluator.at(point_)),
          telling_(*at_),
          radius_(options.radius) {}

    NativeOutcome minimise() {
        if (!at_->usable) return {0, "the start cannot be evaluated"};
        for (;; ++iterations_) {
            telling_ = with_telling_derivatives(evaluator_, point_, *at_);
            const QuadraticSolution step = steered_step();
            if (!step.solved) return end("no next design could be computed");
            if (restores(step)) {
                take(step);
                if (radius_ < least_radius()) return end(too_rough);
                continue;
            }
            const double worth = least_gain(evaluator_, options_, at_->objective);
            if (step.decrease <= worth) return end("no change near by promises a gain above the tolerance");
            if (step.step.lpNorm<Eigen::Infinity>() < least_radius())
                return end("steps became so short that they change nothing that matters");
            take(step);
            if (radius_ < least_radius()) return end(too_rough);
        }
    }

private:
    static constexpr const char* too_rough =
        "predicted gains do not come true, however small the change: the simulated values are rough here";

    // Does the step meet, or nearly, what is missed? Such a one is worth an evaluation however short it is: the tolerance is the
    // objective's.
    bool restores(const QuadraticSolution& step) const {
        constexpr double nearly = 0.1, rounding = 1e-9;
        return options_.meets_requirements && at_->violation > 0 && step.step.lpNorm<Eigen::Infinity>() > rounding &&
               step.violation <= nearly * target_violation(evaluator_, *at_);
    }

    double least_radius() const { return 0.03 * std::sqrt(options_.tolerance); }
    NativeOutcome end(const char* words) const { return {iterations_, words}; }

    bool is_sum_of_squares() const { return std::abs(at_->residuals.squaredNorm() - at_->objective) <= 1e-9 * std::abs(at_->objective); }

    // Steps are solved to 1e-9 of the numbers in them: where f is nearly nothing, it and the penalty are counted in larger units.
    QuadraticSolution step_at_penalty() {
        if (curvature_ == Curvature::estimated || !is_sum_of_squares())
            return best_step(evaluator_, point_, telling_, &rest_.matrix(), radius_, penalty_);
        Evaluation large = telling_;
        const double size = radius_ * large.gradient.lpNorm<Eigen::Infinity>(), factor = size > 0 ? std::max(1.0, 1 / size) : 1.0;
        large.gradient *= factor;
        large.residual_jacobian *= std::sqrt(factor);
        QuadraticSolution step = best_step(evaluator_, point_, large, nullptr, radius_, factor * penalty_);
        step.decrease /= factor;
        step.multipliers /= factor;
        return step;
    }

    // Raises the penalty until a tenth of what could be gained in feasibility is.
    QuadraticSolution steered_step() {
        const double now = target_violation(evaluator_, *at_);
        QuadraticSolution step = step_at_penalty();
        if (!step.solved || step.violation <= 1e-9) return step;
        Evaluation feasibility = telling_;
        feasibility.gradient.setZero();
        feasibility.residual_jacobian.resize(0, point_.size());
        feasibility.objective_branches = {};
        const QuadraticSolution least = best_step(evaluator_, point_, feasibility, nullptr, radius_, 1);
        if (!least.solved) return step;
        while (now - step.violation < accepted_share * (now - least.violation) - 1e-9 && penalty_ < most_penalty) {
            penalty_ *= 10;
            const QuadraticSolution steered = step_at_penalty();
            if (!steered.solved) return step;
            step = steered;
        }
        return step;
    }

    void take(const QuadraticSolution& step) {
        const VectorX trial_point = (point_ + step.step).cwiseMax(0).cwiseMin(1);
        const double length = step.step.lpNorm<Eigen::Infinity>();
        if (!evaluator_.refusal(trial_point).empty()) {
            radius_ = after_failure * std::min(radius_, length);
            return;
        }
        const Evaluation& trial = evaluator_.at(trial_point);
        if (!trial.usable) {
            radius_ = after_failure * std::min(radius_, length);
            return;
        }
        const double share = (merit(evaluator_, *at_, penalty_) - merit(evaluator_, trial, penalty_)) / step.decrease;
        const VectorX old_point = point_;
        const Evaluation* old = at_;
        if (share > accepted_share) {
            point_ = trial_point;
            at_ = &trial;
            rest_.learn(old_point, *old, point_, *at_, smooth_multipliers(step));
        } else {
            rest_.learn(trial_point, trial, point_, *at_, smooth_multipliers(step));
        }
        if (share > good_share) radius_ = std::min(largest_radius, std::max(radius_, 2 * length));
        if (share < bad_share) radius_ = shrink * std::min(radius_, length);
    }

    Evaluator& evaluator_;
    const OptimiserOptions& options_;
    Curvature curvature_;
    RestCurvature rest_;
    VectorX point_;
    const Evaluation* at_;  // in the evaluator's records, which stay
    Evaluation telling_;    // the same with the derivatives that are gone by
    double radius_;
    double penalty_ = 10;
    int iterations_ = 0;
};

}  // namespace

NativeOutcome SequentialOptimiser::minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
    if (evaluator.variables() == 0) return {0, "no variables"};
    return SequentialRun(evaluator, options, curvature_).minimise();
}

}  // namespace fettle::design::optimisers
