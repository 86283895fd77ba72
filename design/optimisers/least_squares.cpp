// SPDX-License-Identifier: MIT
#include "design/optimisers/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace fettle::design::optimisers {

namespace {

constexpr double bold = 1e-6, careful = 1e-3;  // first dampings
constexpr double least_damping = 1e-15, most_damping = 1e14;
constexpr double taken_share = 1e-3;  // of the predicted decrease
constexpr int slow_steps = 2;

class SquaresRun {
public:
    SquaresRun(Evaluator& evaluator, const OptimiserOptions& options)
        : evaluator_(evaluator),
          options_(options),
          point_(evaluator.best_scaled_point()),
          at_(&evaluator.at(point_)),
          column_norms_(VectorX::Constant(point_.size(), 1e-12)),
          damping_(options.radius < OptimiserOptions().radius ? careful : bold) {}

    NativeOutcome minimise() {
        for (int iterations = 0, slow = 0;; ++iterations) {
            const double worth = least_gain(evaluator_, options_, at_->objective), before = at_->objective;
            const double promised = step();
            if (promised == 0) return {iterations, "no change near by promises a gain above the tolerance"};
            if (promised < 0) return {iterations, "predicted gains do not come true, however small the change"};
            slow = promised <= worth && before - at_->objective <= worth ? slow + 1 : 0;
            if (slow >= slow_steps) return {iterations, "no change near by promises a gain above the tolerance"};
        }
    }

private:
    // The variables that may move down the gradient.
    std::vector<Eigen::Index> free_variables(const VectorX& gradient) const {
        std::vector<Eigen::Index> free;
        for (Eigen::Index k = 0; k < point_.size(); ++k) {
            const bool is_held = !evaluator_.is_periodic(k) && (gradient[k] > 0 ? point_[k] <= 0 : point_[k] >= 1);
            if (!is_held && gradient[k] != 0) free.push_back(k);
        }
        return free;
    }

    // Not quite all of the way to a bound, unless it is next to it: at the bounds themselves mechanisms are often at the end of what can be
    // evaluated (a link without length), and a search that is thrown there by one long step does not come back.
    VectorX short_of_bounds(VectorX step) const {
        constexpr double most = 0.999, next_to_it = 1e-5;
        for (Eigen::Index k = 0; k < step.size(); ++k) {
            if (evaluator_.is_periodic(k)) continue;
            const double room = step[k] < 0 ? point_[k] : 1 - point_[k];
            if (std::abs(step[k]) > most * room && room > next_to_it) step[k] = std::copysign(most * room, step[k]);
        }
        return step;
    }

    // @return the decrease that the step that was taken promised; 0: there is none to take; negative: none could be taken.
    double step() {
        const MatrixX& jacobian = at_->residual_jacobian;
        column_norms_ = column_norms_.cwiseMax(jacobian.colwise().norm().transpose());
        const VectorX half_gradient = jacobian.transpose() * at_->residuals;
        const std::vector<Eigen::Index> free = free_variables(half_gradient);
        if (free.empty()) return 0;
        const MatrixX columns = jacobian(Eigen::all, free), normal = columns.transpose() * columns;
        const VectorX scale = column_norms_(free).cwiseAbs2(), slope = half_gradient(free);
        for (; damping_ <= most_damping; damping_ *= growth_, growth_ *= 2) {
            const Eigen::LDLT<MatrixX> factor(MatrixX(normal + MatrixX((damping_ * scale).asDiagonal())));
            VectorX direction = VectorX::Zero(point_.size());
            direction(free) = -factor.solve(slope);
            if (factor.info() != Eigen::Success || !direction.allFinite()) continue;
            const VectorX there = evaluator_.moved(point_, short_of_bounds(direction));
            const double promised = at_->objective - (at_->residuals + jacobian * evaluator_.step_between(point_, there)).squaredNorm();
            if (there == point_) return 0;
            if (promised > 0 && take(there, promised)) return promised;
        }
        return -1;
    }

    bool take(const VectorX& there, double promised) {
        if (!evaluator_.refusal(there).empty()) return false;
        const Evaluation& trial = evaluator_.at(there);
        if (!trial.usable) return false;
        const double share = (at_->objective - trial.objective) / promised;
        if (!(share > taken_share)) return false;
        damping_ = std::max(least_damping, damping_ * std::max(1.0 / 3, 1 - std::pow(2 * share - 1, 3)));
        growth_ = 2;
        point_ = there;
        at_ = &trial;
        return true;
    }

    Evaluator& evaluator_;
    const OptimiserOptions options_;
    VectorX point_;
    const Evaluation* at_;  // in the evaluator's records, which stay
    VectorX column_norms_;
    double damping_, growth_ = 2;
};

}  // namespace

bool is_sum_of_squares(const Evaluation& e) {
    return tells(e) && e.residuals.size() > 0 && std::abs(e.residuals.squaredNorm() - e.objective) <= 1e-9 * std::abs(e.objective);
}

bool is_least_squares(const Evaluator& evaluator) {
    return evaluator.constraints() == 0 && evaluator.has_best() && is_sum_of_squares(evaluator.best_scaled_evaluation());
}

NativeOutcome minimise_squares(Evaluator& evaluator, const OptimiserOptions& options, double tolerance) {
    OptimiserOptions own = options;
    own.tolerance = tolerance;
    return SquaresRun(evaluator, own).minimise();
}

}  // namespace fettle::design::optimisers
