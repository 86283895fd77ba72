// SPDX-License-Identifier: MIT
#include "design/optimisers/optimality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/linear/factorisations.hpp"
#include "design/optimisers/least_squares.hpp"
#include "design/optimisers/local_model.hpp"
#include "design/optimisers/noise.hpp"
#include "design/optimisers/unexplored.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double first_radius = 0.1, step_shrink = 0.35;
constexpr double smallest_radius = 3e-4;  // below it a gain is one of microns: whether it is there does not matter to a design
constexpr int most_probes = 5;
constexpr double near = 0.3;  // evaluations within this distance tell of the curvature
constexpr double exact_penalty = 1e3;
constexpr std::size_t most_measured = 8;
constexpr int most_measured_probes = 3;
constexpr int most_looks_aside = 2, most_steps_aside = 3, most_restorations = 2;
constexpr double least_margin = 0.05, most_margin = 0.25;  // shares that the verdict keeps to; the second where the first was missed
constexpr int noise_values = 7;
constexpr double noise_spacing = 1e-3;
constexpr double near_bound = 1e-6;    // of a range: an optimiser's steps end so near to a bound at which they end
constexpr double telling_share = 0.1;  // of a gain, below which a variable is not named; of a gradient, below which a constraint is not

// From the evaluations next to the best one, the farthest first.
RestCurvature curvature_near(const Evaluator& evaluator, const VectorX& best, const Evaluation& at, const VectorX& multipliers) {
    std::vector<std::pair<double, int>> order;
    for (int k = 0; k < evaluator.known(); ++k) {
        const double distance = evaluator.step_between(best, evaluator.scaled_point(k)).norm();
        if (distance > 0 && distance < near && tells(evaluator.scaled_evaluation(k))) order.emplace_back(distance, k);
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), static_cast<size_t>(2 * best.size() + 2)));
    RestCurvature rest(count_of(best));
    for (auto it = order.rbegin(); it != order.rend(); ++it)
        rest.learn(evaluator.scaled_evaluation(it->second), evaluator.step_between(evaluator.scaled_point(it->second), best), at,
                   multipliers);
    return rest;
}

// Branches included: at a kink, what one promises another may take.
double predicted_gain(const Evaluation& at, const MatrixX& rest, const QuadraticSolution& solution) {
    const VectorX& step = solution.step;
    const MatrixX curvature = residual_curvature(at) + rest;
    return std::max(0.0, -(at.gradient.dot(step) + 0.5 * std::max(0.0, step.dot(curvature * step)) + solution.kinks));
}

// Inward from the nearest bounds, all variables alike, so that no value is left out of the noise.
VectorX inward(const VectorX& point) {
    VectorX direction(point.size());
    for (Eigen::Index k = 0; k < point.size(); ++k) direction[k] = point[k] > 0.5 ? -1 : 1;
    return direction / std::max(1.0, direction.norm());
}

class Judgement {
public:
    Judgement(Evaluator& evaluator, const OptimiserOptions& options)
        : evaluator_(evaluator),
          options_(options),
          point_(evaluator.best_scaled_point()),
          at_(evaluator.best_scaled_evaluation()),
          margin_(evaluator.margin_share() < 1 ? least_margin : 1) {}

    Optimality judge(bool& moved) {
        moved = false;
        if (is_least_possible()) return nothing_to_gain();
        try {
            moved = gains();
            if (!moved) look_for_margin();
            result_.judged = !moved && now_.solution.solved && measure_noise();
        } catch (const StopOptimisation&) {  // what was found so far stands, as not judged
        }
        if (moved) evaluator_.keep_margin(margin_, evaluator_.best_scaled_evaluation().constraints);
        tell();
        return result_;
    }

private:
    struct Look {
        QuadraticSolution solution;
        double radius = 0, gain = 0;
    };

    // A sum of squares is never below 0: where it is no more than a gain that counts, no design gains, near by or elsewhere.
    bool is_least_possible() {
        worth_ = least_gain(evaluator_, options_, at_.objective);
        return is_sum_of_squares(evaluator_.start_evaluation()) && is_sum_of_squares(at_) && at_.objective <= worth_;
    }

    const Optimality& nothing_to_gain() {
        const auto n = point_.size();
        result_.judged = true;
        result_.worth = worth_ / evaluator_.objective_scale();
        result_.step = result_.residual = VectorX::Zero(n);
        result_.multipliers = VectorX::Zero(evaluator_.constraints());
        result_.held.assign(static_cast<std::size_t>(n), Held::stationary);
        return result_;
    }

    // With the margin that the search has kept, as long as it helps on the way; then within it.
    // @return whether a better point was found.
    bool gains() {
        if (margin_ == 1) {
            if (probe()) return true;
            if (!is_settled()) return false;
            if (leaves_saddle() || gains_by_measured_curvature()) return true;
            margin_ = least_margin;
        }
        if (probe()) return true;
        return evaluator_.margin_share() < 1 && is_settled() && gains_by_measured_curvature();
    }

    bool is_settled() const { return now_.solution.solved && now_.gain <= worth_ && result_.refused.empty(); }

    // @return whether a probe became the best point.
    bool probe() {
        double radius = first_radius;
        Look refused;  // the last, if its probe could not be evaluated
        for (int k = 0;; ++k) {
            look(radius);
            if (!now_.solution.solved) return false;
            if (now_.gain <= worth_ || k >= most_probes || radius < smallest_radius) {
                if (!result_.refused.empty()) now_ = refused;  // nothing has told that there is no gain
                return false;
            }
            const VectorX before = evaluator_.best_point();
            const Evaluation& seen = evaluator_.at(point_ + now_.solution.step);
            result_.refused = seen.usable ? std::string() : seen.reason;
            if (!seen.usable) refused = now_;
            if (gained() || restores(point_ + now_.solution.step)) return true;
            if (evaluator_.best_point() != before) {  // hardly better: judged from there all the same
                point_ = evaluator_.best_scaled_point();
                at_ = evaluator_.best_scaled_evaluation();
            }
            radius = step_shrink * std::min(radius, seen.usable ? now_.solution.step.lpNorm<Eigen::Infinity>() : 0.5 * radius);
        }
    }

    void look(double radius) {
        worth_ = least_gain(evaluator_, options_, at_.objective);
        now_.radius = radius;
        at_ = with_telling_derivatives(evaluator_, point_, evaluator_.best_scaled_evaluation());
        evaluator_.keep_margin(margin_, at_.constraints);
        const VectorX none = VectorX::Zero(evaluator_.constraints());
        const VectorX y = now_.solution.multipliers.size() == none.size() ? smooth_multipliers(now_.solution) : none;
        RestCurvature rest = curvature_near(evaluator_, point_, at_, y);
        now_.solution = best_step(evaluator_, point_, at_, &rest.matrix(), radius, exact_penalty);
        if (!now_.solution.solved) return;
        now_.gain = predicted_gain(at_, rest.matrix(), now_.solution);
    }

    bool gained() const { return at_.objective - evaluator_.best_scaled_evaluation().objective > 0.5 * worth_; }

    // Requirements curve: a step that keeps them to first order misses them a little. From such a probe, the shortest way back to what is
    // aimed at, as long as that promises a gain. What is missed although the values meet it, or after such a way back, needs more margin.
    // @return whether what was found became the best point.
    bool restores(VectorX there) {
        for (int step = 0;; ++step) {
            const Evaluation& seen = evaluator_.at(there);
            const double missed = seen.usable ? evaluator_.missed_margins(seen.constraints) : 0;
            if (!seen.usable || !(seen.violation > 0) || missed > 1) return false;
            if (missed == 0 || step > 0) margin_ = std::max(margin_, most_margin);
            if (step == most_restorations) return false;
            evaluator_.keep_margin(margin_, at_.constraints);
            const Evaluation telling = with_telling_derivatives(evaluator_, there, seen);
            const QuadraticSolution back = restoring_step(evaluator_, there, telling, now_.radius, exact_penalty);
            if (!back.solved || !(at_.objective - (seen.objective + telling.gradient.dot(back.step)) > worth_)) return false;
            there = evaluator_.moved(there, back.step);
            if (!evaluator_.refusal(there).empty()) return false;
            evaluator_.at(there);
            if (gained()) return true;
        }
    }

    // A step that has been shortened until it promises no gain does not tell that there is none: what holds the design may be the margin
    // that is left, and not the requirement. Then the last word has the step that gives the margin up.
    void look_for_margin() {
        if (!now_.solution.solved || now_.gain > worth_ || now_.radius == first_radius) return;
        const Look last = now_;
        look(first_radius);
        if (!now_.solution.solved || now_.gain <= worth_ || margin_worth() <= worth_) now_ = last;
    }

    // The worth, to first order, of the best point's distance from what its step aims at and reaches.
    double margin_worth() const {
        const VectorX y = whole_multipliers(now_.solution);
        double sum = 0;
        for (Eigen::Index i = 0; i < y.size(); ++i) {
            const double aim = y[i] > 0 ? evaluator_.scaled_constraint_lower()[i] : evaluator_.scaled_constraint_upper()[i];
            if (std::isfinite(aim)) sum += y[i] * (at_.constraints[i] - aim);
        }
        return sum;
    }

    // What the step keeps, to first order: a row each.
    MatrixX holding() const {
        std::vector<VectorX> rows;
        const QuadraticSolution& s = now_.solution;
        const double size = std::max({s.multipliers.size() > 0 ? s.multipliers.lpNorm<Eigen::Infinity>() : 0,
                                      s.cut_multipliers.size() > 0 ? s.cut_multipliers.lpNorm<Eigen::Infinity>() : 0, 1e-12});
        const auto holds = [size](double multiplier) { return std::abs(multiplier) > 1e-6 * size; };
        for (Eigen::Index i = 0; i < s.multipliers.size(); ++i)
            if (holds(s.multipliers[i])) rows.push_back(at_.jacobian.row(i).transpose());
        for (Eigen::Index j = 0; j < s.cut_multipliers.size() && s.cut_of[j] >= 0; ++j)
            if (holds(s.cut_multipliers[j])) rows.push_back(at_.constraint_branches.jacobian.row(j).transpose());
        for (Eigen::Index k = 0; k < point_.size(); ++k) {
            const Held held = what_holds(k);
            if (held == Held::lower_bound || held == Held::upper_bound) rows.push_back(VectorX::Unit(point_.size(), k));
        }
        MatrixX out(count_of(rows), point_.size());
        for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = rows[i].transpose();
        return out;
    }

    MatrixX known_steps() const {
        std::vector<VectorX> steps;
        for (int k = 0; k < evaluator_.known(); ++k) {
            const VectorX step = evaluator_.step_between(point_, evaluator_.scaled_point(k));
            if (step.norm() < near && tells(evaluator_.scaled_evaluation(k))) steps.push_back(step);
        }
        MatrixX out(count_of(steps), point_.size());
        for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = steps[i].transpose();
        return out;
    }

    // Derivatives at one point know nothing of a gain to both sides. Looks aside where nothing is known, and on from there.
    // @return whether what was found became the best point.
    bool leaves_saddle() {
        for (const VectorX& direction : unexplored_directions(holding(), known_steps(), most_looks_aside)) {
            VectorX there = aside(direction);
            if (evaluator_.unscaled(there) == evaluator_.unscaled(point_)) continue;
            for (int step = 0; step < most_steps_aside; ++step) {
                if (!evaluator_.refusal(there).empty()) break;
                const Evaluation& seen = evaluator_.at(there);
                if (gained()) return true;
                if (!seen.usable) break;
                const Evaluation told = with_telling_derivatives(evaluator_, there, seen);
                const RestCurvature rest = curvature_near(evaluator_, there, told, smooth_multipliers(now_.solution));
                const QuadraticSolution onward = best_step(evaluator_, there, told, &rest.matrix(), first_radius, exact_penalty);
                if (!onward.solved) break;
                const double promised = merit(evaluator_, at_, exact_penalty) - (merit(evaluator_, seen, exact_penalty) - onward.decrease);
                if (!(promised > worth_)) break;
                there = evaluator_.moved(there, onward.step);
            }
        }
        return false;
    }

    // Unit vectors along which no gain is promised for the curvature that the model has there, and one would be for a hundredth of it: the
    // columns, those with the steepest slope first. Gauss-Newton's curvature of residuals that do not vanish, and an estimate from a few
    // evaluations, can be that wrong.
    MatrixX doubtful_directions(const MatrixX& curvature, const VectorX& slope) const {
        constexpr double overrated = 100;
        const MatrixX free = free_directions(holding());
        if (free.cols() == 0) return free;
        const auto modes = core::linear::symmetric_eigen<Eigen::Dynamic>(free.transpose() * curvature * free);
        std::vector<std::pair<double, Eigen::Index>> order;
        for (Eigen::Index i = 0; i < free.cols(); ++i) {
            const double along = std::abs(slope.dot(free * modes.vectors.col(i))), bend = std::max(0.0, modes.values[i]) / overrated;
            const double gain = along <= bend * first_radius ? 0.5 * along * along / bend : along * first_radius;
            if (gain > worth_) order.emplace_back(-along, i);
        }
        std::sort(order.begin(), order.end());
        order.resize(std::min(order.size(), most_measured));
        MatrixX out(point_.size(), count_of(order));
        for (Eigen::Index k = 0; k < out.cols(); ++k) out.col(k) = free * modes.vectors.col(order[static_cast<size_t>(k)].second);
        return out;
    }

    // The curvature that differences of gradients show along these directions; elsewhere as it was. The nearest symmetric matrix
    // (Frobenius) to the former one of which this is so. Nothing: a point could not be evaluated.
    std::optional<MatrixX> measured_curvature(const MatrixX& before, const MatrixX& along, const VectorX& y) {
        constexpr double spacing = 1e-3;
        const VectorX here = lagrangian_gradient(at_, y);
        MatrixX change(along.rows(), along.cols());
        for (Eigen::Index k = 0; k < along.cols(); ++k) {
            const VectorX there = evaluator_.moved(point_, spacing * along.col(k)), step = evaluator_.step_between(point_, there);
            if ((step - spacing * along.col(k)).norm() > 0.1 * spacing) return std::nullopt;
            const Evaluation& seen = evaluator_.at(there);
            if (!seen.usable) return std::nullopt;
            change.col(k) = (lagrangian_gradient(seen, y) - here) / spacing - before * along.col(k);
        }
        const MatrixX symmetric = 0.5 * (along.transpose() * change + change.transpose() * along);
        return before + change * along.transpose() + along * change.transpose() - along * symmetric * along.transpose();
    }

    // A gain that only the model's curvature denies: is the curvature there? What the measured one promises is tried.
    // @return whether a better point was found.
    bool gains_by_measured_curvature() {
        if (!at_.objective_branches.of.empty() || !at_.constraint_branches.of.empty()) return false;  // at a kink gradients differ anyhow
        const VectorX y = smooth_multipliers(now_.solution);
        const MatrixX residuals = residual_curvature(at_);
        const MatrixX modelled = residuals + curvature_near(evaluator_, point_, at_, y).matrix();
        const MatrixX along = doubtful_directions(modelled, lagrangian_gradient(at_, y));
        if (along.cols() == 0) return false;
        const std::optional<MatrixX> measured = measured_curvature(modelled, along, y);
        if (!measured) return false;
        const MatrixX rest = *measured - residuals;
        double radius = first_radius;
        for (int k = 0; k < most_measured_probes && radius > smallest_radius; ++k) {
            const QuadraticSolution step = best_step(evaluator_, point_, at_, &rest, radius, exact_penalty);
            if (!step.solved || predicted_gain(at_, rest, step) <= worth_) return false;
            const VectorX there = evaluator_.moved(point_, step.step);
            if (evaluator_.refusal(there).empty()) evaluator_.at(there);
            if (gained()) return true;
            radius = step_shrink * std::min(radius, step.step.lpNorm<Eigen::Infinity>());
        }
        return false;
    }

    // To the side on which the bounds leave more room.
    VectorX aside(const VectorX& direction) const {
        const VectorX one = evaluator_.moved(point_, first_radius * direction), other = evaluator_.moved(point_, -first_radius * direction);
        const auto room = [&](const VectorX& there) { return evaluator_.step_between(point_, there).norm(); };
        return room(one) >= room(other) ? one : other;
    }

    // The objective's, then the constraints', along a line; empty: a point next to the best one cannot be evaluated.
    std::vector<NoiseLevel> noise_levels(double spacing) {
        const int m = evaluator_.constraints();
        MatrixX values(noise_values, 1 + m);
        const VectorX direction = inward(point_);
        for (int i = 0; i < noise_values; ++i) {
            const Evaluation& e = evaluator_.look(point_ + i * spacing * direction);
            if (!e.usable) return {};
            values(i, 0) = e.objective;
            values.row(i).tail(m) = e.constraints.transpose();
        }
        return estimate_noise_by_column(values, spacing);
    }

    // Noise is as large over a quarter of the spacing; what a smooth function's curvature, or a kink, looks like over a wide one is a
    // quarter of that at most. @return whether it could be told.
    bool keep_what_does_not_shrink(std::vector<NoiseLevel>& levels) {
        constexpr double quarter = 0.25, shrunk = 1.0 / 3;
        const std::vector<NoiseLevel> nearer = noise_levels(quarter * noise_spacing);
        if (nearer.empty()) return false;
        for (size_t q = 0; q < levels.size(); ++q)
            if (nearer[q].noise < shrunk * levels[q].noise)
                levels[q] = {.noise = nearer[q].noise, .status = NoiseStatus::spacing_too_large};
        return true;
    }

    // @return whether it could be: a point next to the best one may be none that can be evaluated.
    bool measure_noise() {
        const int m = evaluator_.constraints();
        const VectorX multipliers = whole_multipliers(now_.solution);
        std::vector<NoiseLevel> levels = noise_levels(noise_spacing);
        if (levels.empty()) return false;
        const auto effect_of = [&](int q) {
            const double weight = q == 0 ? 1 : now_.solution.solved ? std::abs(multipliers[q - 1]) : 0;
            return weight * levels[q].noise;
        };
        const auto counts = [&](int q) { return levels[q].status != NoiseStatus::spacing_too_large && effect_of(q) > worth_; };
        bool any = false;
        for (int q = 0; q <= m; ++q) any = any || counts(q);
        if (any && !keep_what_does_not_shrink(levels)) return false;
        result_.noise.resize(1 + m);
        for (int q = 0; q <= m; ++q) {
            const double scale = q == 0 ? evaluator_.objective_scale() : evaluator_.constraint_scale()[q - 1];
            const NoiseLevel& level = levels[q];
            result_.noise[q] = level.noise / scale;
            const double effect = effect_of(q);
            if (level.status == NoiseStatus::spacing_too_large) continue;  // only a bound on it, made of what is smooth
            if (effect > worth_ && effect > result_.noise_in_objective) result_.roughest = q;
            result_.noise_in_objective = std::max(result_.noise_in_objective, effect);
        }
        result_.noise_in_objective /= evaluator_.objective_scale();
        return true;
    }

    // Those that the last step's length holds, or where that holds none, those that gain, the largest gain first; none where the step's
    // gain does not count.
    std::vector<int> improvable() const {
        if (now_.gain <= worth_) return {};
        VectorX share = (now_.solution.box_multipliers.cwiseProduct(now_.solution.step)).cwiseAbs();
        if (share.sum() < telling_share * now_.gain) share = (at_.gradient.cwiseProduct(now_.solution.step)).cwiseAbs();
        std::vector<int> order(share.size()), found;
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share[a] > share[b]; });
        for (const int k : order)
            if (share[k] > telling_share * share.maxCoeff() || found.empty()) found.push_back(k);
        return found;
    }

    // The one answer to what holds a variable: nothing holds one that could still move.
    Held what_holds(Eigen::Index k) const {
        const std::vector<int> moving = improvable();
        if (std::find(moving.begin(), moving.end(), static_cast<int>(k)) != moving.end()) return Held::free;
        const double z = now_.solution.box_multipliers[k], d = now_.solution.step[k];
        const bool has_walls = !evaluator_.is_periodic(k);
        const bool at_lower = has_walls && point_[k] + d <= near_bound, at_upper = has_walls && point_[k] + d >= 1 - near_bound;
        const double size = std::max({std::abs(at_.gradient[k]), 1e-12});
        if (std::abs(z) > 1e-6 + telling_share * size && (z > 0 ? at_lower : at_upper))
            return z > 0 ? Held::lower_bound : Held::upper_bound;
        if (std::abs(d) >= now_.radius * (1 - 1e-3) && now_.gain > worth_) return Held::free;
        for (Eigen::Index i = 0; i < now_.solution.multipliers.size(); ++i)
            if (std::abs(now_.solution.multipliers[i] * at_.jacobian(i, k)) > telling_share * size) return Held::constraints;
        for (Eigen::Index j = 0; j < now_.solution.cut_multipliers.size() && now_.solution.cut_of[j] >= 0; ++j)
            if (std::abs(now_.solution.cut_multipliers[j] * at_.constraint_branches.jacobian(j, k)) > telling_share * size)
                return Held::constraints;
        return Held::stationary;
    }

    void tell() {
        if (!now_.solution.solved) return;
        const double f = evaluator_.objective_scale();
        const auto n = point_.size();
        result_.worth = worth_ / f;
        result_.predicted_gain = now_.gain / f;
        result_.radius = now_.radius;
        result_.step = now_.solution.step.cwiseProduct(evaluator_.range());
        result_.multipliers = whole_multipliers(now_.solution).cwiseProduct(evaluator_.constraint_scale()) / f;
        result_.residual = VectorX::Zero(n);
        result_.held.resize(n);
        for (Eigen::Index k = 0; k < n; ++k) {
            result_.held[k] = what_holds(k);
            const Held held = result_.held[k];
            if (held != Held::lower_bound && held != Held::upper_bound) result_.residual[k] = now_.solution.box_multipliers[k] / f;
        }
        result_.improvable = improvable();
    }

    Evaluator& evaluator_;
    const OptimiserOptions& options_;
    VectorX point_;
    Evaluation at_;
    Look now_;
    double worth_ = 0;
    double margin_;  // share that is kept
    Optimality result_;
};

}  // namespace

const char* to_string(Held held) {
    switch (held) {
        case Held::stationary:
            return "stationary";
        case Held::lower_bound:
            return "lower bound";
        case Held::upper_bound:
            return "upper bound";
        case Held::constraints:
            return "constraints";
        case Held::free:
            return "nothing";
    }
    return "unknown";
}

std::string words(const Optimality& o) {
    if (!o.improvable.empty() && o.refused.empty()) return "a change near by still promises a gain above the tolerance";
    if (!o.improvable.empty()) return "a change near by promises a gain above the tolerance, but designs there cannot be evaluated";
    if (!o.judged) return "whether a better design is near could not be judged";
    if (o.roughest >= 0) return "simulated values scatter by more than the tolerance";
    return "no change near by promises a gain above the tolerance";
}

double least_gain(const Evaluator& evaluator, const OptimiserOptions& options, double scaled_objective) {
    const Evaluation& start = evaluator.start_evaluation();
    const double size = start.usable ? std::abs(start.objective) * evaluator.objective_scale() : 0;
    // A sum of squares is as small as its residuals are: a millionth of these is a millionth of a millionth of it.
    const double vanishing = is_sum_of_squares(start) ? 1e-12 : 1e-6;
    return std::max(options.tolerance * std::max({std::abs(scaled_objective), vanishing * size, 1e-30}),
                    options.negligible * evaluator.objective_scale());
}

Optimality judge(Evaluator& evaluator, const OptimiserOptions& options, bool& moved) { return Judgement(evaluator, options).judge(moved); }

}  // namespace fettle::design::optimisers
