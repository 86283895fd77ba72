// SPDX-License-Identifier: MIT
#include "design/optimisers/sequential_optimiser.hpp"

#include <algorithm>
#include <cmath>

#include "design/optimisers/least_squares.hpp"
#include "design/optimisers/local_model.hpp"

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
            if (step.decrease <= worth) {
                if (!misses_what_it_could_meet(step)) return end("no change near by promises a gain above the tolerance");
                penalty_ *= 10;
                continue;
            }
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

    // The gain in the objective that the step trades for what is missed is below the tolerance, too: nothing speaks for it.
    bool misses_what_it_could_meet(const QuadraticSolution& step) const {
        if (!options_.meets_requirements || !(at_->violation > 0) || !(penalty_ < most_penalty)) return false;
        const QuadraticSolution least = most_feasible_step();
        return least.solved && restores(least) && least.violation < step.violation - 1e-9;
    }

    // The step by which the least is missed, whatever becomes of the objective.
    QuadraticSolution most_feasible_step() const {
        Evaluation feasibility = telling_;
        feasibility.gradient.setZero();
        feasibility.residual_jacobian.resize(0, point_.size());
        feasibility.objective_branches = {};
        return best_step(evaluator_, point_, feasibility, nullptr, radius_, 1);
    }

    double least_radius() const { return 0.03 * std::sqrt(options_.tolerance); }
    NativeOutcome end(const char* words) const { return {iterations_, words}; }

    // Steps are solved to 1e-9 of the numbers in them: where f is nearly nothing, it and the penalty are counted in larger units.
    QuadraticSolution step_at_penalty(const Evaluation& at) const {
        if (curvature_ == Curvature::estimated || !is_sum_of_squares(*at_))
            return best_step(evaluator_, point_, at, &rest_.matrix(), radius_, penalty_);
        Evaluation large = at;
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
        QuadraticSolution step = step_at_penalty(telling_);
        if (!step.solved || step.violation <= 1e-9) return step;
        const QuadraticSolution least = most_feasible_step();
        if (!least.solved) return step;
        while (now - step.violation < accepted_share * (now - least.violation) - 1e-9 && penalty_ < most_penalty) {
            penalty_ *= 10;
            const QuadraticSolution steered = step_at_penalty(telling_);
            if (!steered.solved) return step;
            step = steered;
        }
        return step;
    }

    // Null: the point cannot be evaluated.
    const Evaluation* evaluated(const VectorX& point) {
        if (!evaluator_.refusal(point).empty()) return nullptr;
        const Evaluation& trial = evaluator_.at(point);
        return trial.usable ? &trial : nullptr;
    }

    // What came true of a predicted decrease.
    double share_of(double decrease, const Evaluation& trial) const {
        return (merit(evaluator_, *at_, penalty_) - merit(evaluator_, trial, penalty_)) / decrease;
    }

    // The step by constraints that have the values seen at its end, and the derivatives as before.
    QuadraticSolution corrected_step(const QuadraticSolution& step, const Evaluation& trial) const {
        VectorX predicted = telling_.constraints + telling_.jacobian * step.step;
        const Branches& branches = telling_.constraint_branches;
        for (int k = 0; k < count_of(branches.of); ++k) {
            double& whole = predicted[branches.of[k]];
            const double branch = branches.values[k] + branches.jacobian.row(k).dot(step.step);
            whole = evaluator_.is_greatest(branches.of[k]) ? std::max(whole, branch) : std::min(whole, branch);
        }
        const VectorX miss = trial.constraints - predicted;
        Evaluation shifted = telling_;
        shifted.constraints += miss;
        for (int k = 0; k < count_of(branches.of); ++k) shifted.constraint_branches.values[k] += miss[branches.of[k]];
        return step_at_penalty(shifted);
    }

    // Along constraints that are curved every step misses them by the square of its length, however good it is: the second-order
    // correction of the step misses them by the cube. Tried where the derivatives promise that it is taken.
    bool take_corrected(const QuadraticSolution& step, const Evaluation& trial) {
        if (target_violation(evaluator_, trial) <= step.violation + 1e-9) return false;
        const QuadraticSolution corrected = corrected_step(step, trial);
        if (!corrected.solved || (corrected.step - step.step).norm() > step.step.norm()) return false;
        const double objective = trial.objective + telling_.gradient.dot(corrected.step - step.step);
        const double promised = merit(evaluator_, *at_, penalty_) - (objective + penalty_ * corrected.violation);
        if (promised <= accepted_share * step.decrease) return false;
        const VectorX point = evaluator_.moved(point_, corrected.step);
        const Evaluation* there = evaluated(point);
        if (there == nullptr) return false;
        const double share = share_of(step.decrease, *there);
        if (share <= accepted_share) return false;
        move_to(point, *there, step);
        fit_radius(share, step.step.lpNorm<Eigen::Infinity>());
        return true;
    }

    void fit_radius(double share, double length) {
        if (share > good_share) radius_ = std::min(largest_radius, std::max(radius_, 2 * length));
        if (share < bad_share) radius_ = shrink * std::min(radius_, length);
    }

    void move_to(const VectorX& point, const Evaluation& there, const QuadraticSolution& step) {
        rest_.learn(*at_, evaluator_.step_between(point_, point), there, smooth_multipliers(step));
        point_ = point;
        at_ = &there;
    }

    void take(const QuadraticSolution& step) {
        const VectorX point = evaluator_.moved(point_, step.step);
        const double length = step.step.lpNorm<Eigen::Infinity>();
        const Evaluation* trial = evaluated(point);
        if (trial == nullptr) {
            radius_ = after_failure * std::min(radius_, length);
            return;
        }
        const double share = share_of(step.decrease, *trial);
        if (share > accepted_share) {
            move_to(point, *trial, step);
        } else {
            if (take_corrected(step, *trial)) return;
            rest_.learn(*trial, evaluator_.step_between(point, point_), *at_, smooth_multipliers(step));
        }
        fit_radius(share, length);
    }

    Evaluator& evaluator_;
    const OptimiserOptions& options_;
    Curvature curvature_;
    RestCurvature rest_;
    VectorX point_;
    const Evaluation* at_;  // in the evaluator's records, which stay
    Evaluation telling_;    // the same with the derivatives that are gone by
    double radius_;
    double penalty_ = 2;
    int iterations_ = 0;
};

}  // namespace

NativeOutcome SequentialOptimiser::minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
    if (evaluator.variables() == 0) return {0, "no variables"};
    NativeOutcome squares;
    if (is_least_squares(evaluator)) {
        if (curvature_ == Curvature::gauss_newton) return minimise_squares(evaluator, options, options.tolerance);
        constexpr double roughly = 1e-3;  // from there on the other curvature counts
        squares = minimise_squares(evaluator, options, std::max(options.tolerance, roughly));
    }
    NativeOutcome outcome = SequentialRun(evaluator, options, curvature_).minimise();
    outcome.iterations += squares.iterations;
    return outcome;
}

}  // namespace fettle::design::optimisers
