// SPDX-License-Identifier: MIT
#include "design/optimisers/optimisation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/text.hpp"
#include "design/optimisers/ipopt_optimiser.hpp"
#include "design/optimisers/nlopt_optimiser.hpp"
#include "design/optimisers/sequential_optimiser.hpp"

namespace fettle::design::optimisers {

const char* to_string(OptimiserStatus status) {
    switch (status) {
        case OptimiserStatus::optimal:
            return "optimal";
        case OptimiserStatus::feasible:
            return "feasible";
        case OptimiserStatus::infeasible:
            return "infeasible";
        case OptimiserStatus::interrupted:
            return "interrupted";
        case OptimiserStatus::start_failed:
            return "start_failed";
    }
    return "unknown";
}

const std::vector<std::string>& optimiser_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const OptimiserInfo& info : optimiser_table()) list.push_back(info.name);
        return list;
    }();
    return names;
}

const std::vector<OptimiserInfo>& optimiser_table() {
    static const std::vector<OptimiserInfo> table{
        {"sqp", "sequential quadratic programming in a trust region, made for simulations: few evaluations; the default"},
        {"gauss_newton",
         "as sqp, with the residuals' curvature alone (without constraints: Levenberg and Marquardt's); for sums of squares"},
        {"ipopt", "the interior-point method of Ipopt, which estimates curvature from gradients; uses gradients"},
        {"mma", "method of moving asymptotes (NLopt); uses gradients, inequality constraints"},
        {"ccsaq", "conservative convex separable approximations with a quadratic term (NLopt); uses gradients, inequality constraints"},
        {"slsqp", "sequential least-squares quadratic programming (NLopt); uses gradients"},
        {"cobyla", "linear approximations of the values alone (NLopt); uses no gradient"}};
    return table;
}

Result<std::unique_ptr<Optimiser>> make_optimiser(const std::string& name, const std::string& where) {
    if (name == "sqp") return std::unique_ptr<Optimiser>(std::make_unique<SequentialOptimiser>());
    if (name == "gauss_newton") return std::unique_ptr<Optimiser>(std::make_unique<SequentialOptimiser>(Curvature::gauss_newton));
    if (name == "ipopt") return std::unique_ptr<Optimiser>(std::make_unique<IpoptOptimiser>());
    if (name == "mma") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::mma));
    if (name == "ccsaq") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::ccsaq));
    if (name == "slsqp") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::slsqp));
    if (name == "cobyla") return std::unique_ptr<Optimiser>(std::make_unique<NloptOptimiser>(NloptAlgorithm::cobyla));
    return Error{ErrorCode::out_of_range, where,
                 "unknown optimiser \"" + name + "\"; known are sqp, gauss_newton, ipopt, mma, ccsaq, slsqp, cobyla"};
}

namespace {

constexpr int starts_tried = 6;
constexpr double early_tolerance = 10;  // of the smoother models, times the one asked for
constexpr double later_radius = 0.1;    // of the first step in a model that begins where another one ended
constexpr int most_rounds = 6;          // of optimising on from a probe that gained

class StagedRun {
public:
    StagedRun(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options)
        : problem_(problem),
          optimiser_(optimiser),
          options_(options),
          reserve_(options.max_evaluations >= 40 ? 12
                   : problem.smoother.empty()    ? 0
                                                 : options.max_evaluations / 4),
          own_share_(std::max(reserve_, options.max_evaluations / 2)) {}

    OptimiserReport run() {
        report_.point = problem_.start;
        bool begun = false;
        VectorX point = problem_.prepared && !problem_.smoother.empty() ? problem_.prepared(problem_.start) : problem_.start;
        if (!problem_.smoother.empty()) evaluate_start();
        if (ended_at_start(report_.start)) return std::move(report_);
        for (const SmootherModel& model : problem_.smoother) {
            if (stopped_ != StopReason::none) break;
            narrate(options_, "now with " + model.name + (begun ? ", from the best of these:" : ":"));
            begun = optimise_smoother(model, begun, point) || begun;
        }
        optimise_problem(begun, point);
        return std::move(report_);
    }

private:
    int left() const { return std::max(0, options_.max_evaluations - report_.evaluations); }

    EvaluatorOptions limits(int evaluations) {
        EvaluatorOptions limits{evaluations, options_.should_stop, {}, reference_};
        if (options_.on_evaluation) {
            limits.on_evaluation = [this](int number, const VectorX& point, const Evaluation& e, bool best) {
                options_.on_evaluation(report_.evaluations + number, point, e, best);
            };
        }
        return limits;
    }

    void count(const Evaluator& evaluator) {
        report_.evaluations += evaluator.evaluations();
        report_.failures += evaluator.failures();
        stopped_ = evaluator.stop_reason();
    }

    Problem begun_at(const VectorX& point, const SmootherModel* model) const {
        Problem problem = problem_;
        problem.start = point.cwiseMax(problem_.lower).cwiseMin(problem_.upper);
        if (model == nullptr) return problem;
        problem.evaluate = model->evaluate;
        problem.values = model->values;
        return problem;
    }

    void evaluate_start() {
        Evaluator evaluator(problem_, limits(std::min(1, left())));
        report_.start = evaluator.start_evaluation();
        count(evaluator);
    }

    // A feasible start whose objective cannot be less.
    bool ended_at_start(const Evaluation& start) {
        if (!start.usable || start.violation > 0 || start.objective > problem_.objective_floor) return false;
        report_.status = OptimiserStatus::optimal;
        report_.message = "the start meets every requirement, and no other design can be better";
        report_.start = report_.best = start;
        report_.feasible = true;
        return true;
    }

    // The start, and points on the way from it to the middle of the bounds.
    VectorX candidate(const VectorX& start, int k) const {
        const VectorX middle = 0.5 * (problem_.lower + problem_.upper);
        const VectorX point = k == 0 ? start : VectorX(middle + std::pow(0.5, k) * (start - middle));
        return k > 0 && problem_.prepared ? problem_.prepared(point) : point;
    }

    // @return whether the model could be evaluated; then `point` is its best one.
    bool optimise_smoother(const SmootherModel& model, bool begun, VectorX& point) {
        StageReport stage;
        stage.model = model.name;
        const VectorX start = point;
        for (int k = 0; k < (begun ? 1 : starts_tried) && stopped_ == StopReason::none; ++k) {
            const Problem problem = begun_at(candidate(start, k), &model);
            Evaluator evaluator(problem, limits(std::min(left(), std::max(1, left() - own_share_))));
            stage.message = evaluator.start_evaluation().reason;
            if (evaluator.start_evaluation().usable) {
                OptimiserOptions options = options_;
                options.tolerance *= early_tolerance;
                options.meets_requirements = false;  // those are the problem's own
                if (begun) options.radius = std::min(options.radius, later_radius);
                const NativeOutcome native = minimise(evaluator, options);
                point = evaluator.best_point();
                reference_ = evaluator.best_evaluation();
                stage.message = native.message;
                stage.objective = evaluator.best_evaluation().objective;
                stage.violation = evaluator.best_evaluation().violation;
                report_.iterations += native.iterations;
            }
            const bool usable = evaluator.start_evaluation().usable;
            stage.evaluations += evaluator.evaluations();
            count(evaluator);
            evaluator.rethrow();
            if (stopped_ == StopReason::budget) stopped_ = StopReason::none;  // what is left is the problem's own
            if (!usable) continue;
            report_.stages.push_back(stage);
            return true;
        }
        report_.stages.push_back(stage);
        return false;
    }

    NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
        try {
            return optimiser_.minimise(evaluator, options);
        } catch (const StopOptimisation&) {  // thrown in the optimiser's own evaluations, outside its native callbacks
            return {0, "stopped"};
        }
    }

    void optimise_problem(bool begun, const VectorX& from) {
        if (!problem_.smoother.empty() && stopped_ != StopReason::interrupted)
            narrate(options_, std::string("now the design as written") + (begun ? ", from the best of these:" : ":"));
        if (begun) report_.untried = begun_at(from, nullptr).start;
        for (int k = 0; k < starts_tried; ++k) {
            if (stopped_ == StopReason::interrupted) break;
            const Problem problem = begun_at(candidate(from, k), nullptr);
            const int native = std::max(std::min(1, left()), left() - reserve_);
            Evaluator evaluator(problem, limits(native));
            if (evaluator.stop_reason() == StopReason::none) report_.untried.resize(0);
            if (k == 0 && problem_.smoother.empty()) {
                report_.start = evaluator.start_evaluation();
                if (ended_at_start(report_.start)) {
                    count(evaluator);
                    return;
                }
            }
            if (evaluator.start_evaluation().usable) {
                finish(evaluator, begun, left() - native);
                return;
            }
            count(evaluator);
            if (report_.start.usable) return conclude(search_from_start().message);
            const std::string reason = evaluator.start_evaluation().reason;
            if (k == 0) report_.message = "the start cannot be evaluated: " + reason;
            if (stopped_ != StopReason::none) break;
        }
        report_.status = stopped_ == StopReason::interrupted ? OptimiserStatus::interrupted : OptimiserStatus::start_failed;
        report_.budget_spent = stopped_ == StopReason::budget;
        report_.best = report_.start;  // no other design was evaluated as written
        report_.feasible = report_.best.usable && report_.best.violation <= 0;
        if (stopped_ == StopReason::interrupted) report_.message = "stopped as asked after " + evaluations_text() + ", of smoother models";
    }

    // @param spare  Evaluations that the native optimiser has not been given: they are the verdict's.
    void finish(Evaluator& evaluator, bool begun, int spare) {
        NativeOutcome native = search(evaluator, begun, spare);
        if (is_better(report_.start, report_.best)) native = search_from_start();
        conclude(native.message);
    }

    // Where the smoother models have led to is worse than where they began.
    NativeOutcome search_from_start() {
        narrate(options_, "as written, the start is better than this; on from there:");
        const Problem problem = begun_at(problem_.start, nullptr);
        const int native = std::max(std::min(1, left()), left() - reserve_), spare = left() - native;
        EvaluatorOptions options = limits(native);
        options.start = report_.start;
        options.reference.reset();
        Evaluator evaluator(problem, options);
        return search(evaluator, false, spare);
    }

    // The problem itself, from the evaluator's best point.
    NativeOutcome search(Evaluator& evaluator, bool begun, int spare) {
        OptimiserOptions options = options_;
        if (begun) options.radius = std::min(options.radius, later_radius);
        StageReport stage;
        NativeOutcome native = minimise(evaluator, options);
        report_.iterations += native.iterations;
        evaluator.allow(spare);
        report_.optimality = {};
        const StopReason ended = evaluator.stop_reason();
        if (ended == StopReason::none || ended == StopReason::budget) {
            const bool complete = complete_best(evaluator);
            if (options.judges && complete && evaluator.best_evaluation().violation <= 0) judge_and_go_on(evaluator, options);
        }
        evaluator.rethrow();
        report_.point = evaluator.best_point();
        report_.best = evaluator.best_evaluation();
        report_.feasible = report_.best.violation <= 0;
        stage.evaluations = evaluator.evaluations();
        stage.objective = report_.best.objective;
        stage.violation = report_.best.violation;
        stage.message = native.message;
        report_.stages.push_back(stage);
        count(evaluator);
        return native;
    }

    // The verdict needs derivatives, and so do the limits of a design. A derivative-free optimiser has had none.
    static bool complete_best(Evaluator& evaluator) {
        try {
            return evaluator.at(evaluator.best_scaled_point()).usable;
        } catch (const StopOptimisation&) {
            return false;
        }
    }

    // A probe that gains is where the optimiser goes on.
    void judge_and_go_on(Evaluator& evaluator, OptimiserOptions options) {
        options.radius = std::min(options.radius, later_radius);
        narrate(options_, "no step gains any more; is it the best near by? A few designs round it, some of them worse on purpose:");
        for (int round = 0; round < most_rounds; ++round) {
            bool moved = false;
            report_.optimality = judge(evaluator, options, moved);
            if (!moved || evaluator.stop_reason() != StopReason::none) return;
            narrate(options_, "one of them is better: going on from there");
            report_.iterations += minimise(evaluator, options).iterations;
        }
    }

    void conclude(const std::string& native) {
        report_.budget_spent = stopped_ == StopReason::budget;
        report_.status = !report_.feasible                 ? OptimiserStatus::infeasible
                         : report_.optimality.is_optimal() ? OptimiserStatus::optimal
                                                           : OptimiserStatus::feasible;
        report_.message = optimiser_.name() + ": " + (report_.feasible ? words(report_.optimality) : native);
        if (report_.budget_spent) report_.message = budget_text();
        if (stopped_ != StopReason::interrupted) return;
        report_.status = OptimiserStatus::interrupted;
        report_.message = "stopped as asked after " + evaluations_text();
    }

    std::string evaluations_text() const { return core::base::counted(static_cast<std::size_t>(report_.evaluations), "evaluation"); }

    std::string budget_text() const {
        const std::string text = "stopped after " + evaluations_text();
        if (report_.evaluations >= options_.max_evaluations) return text + ", the most that the design allows (`max_evaluations`)";
        return text + "; of the " + std::to_string(options_.max_evaluations) +
               " that the design allows (`max_evaluations`) the others are kept to judge a design that meets every requirement";
    }

    const Problem& problem_;
    const Optimiser& optimiser_;
    const OptimiserOptions& options_;
    int reserve_;    // evaluations of the verdict
    int own_share_;  // evaluations of the problem itself, the verdict's among them: the smoother models leave it so many
    StopReason stopped_ = StopReason::none;
    std::optional<Evaluation> reference_;  // of the last smoother model, at its end
    OptimiserReport report_;
};

}  // namespace

void take_if_better(OptimiserReport& report, const VectorX& point, const Evaluation& evaluation) {
    if (!is_better(evaluation, report.best)) return;
    report.point = point;
    report.best = evaluation;
    report.objective = evaluation.objective;
    report.violation = evaluation.violation;
    report.feasible = evaluation.violation <= 0;
    report.optimality = {};
    if (report.status != OptimiserStatus::interrupted)
        report.status = report.feasible ? OptimiserStatus::feasible : OptimiserStatus::infeasible;
}

OptimiserReport better_of(OptimiserReport first, OptimiserReport later) {
    OptimiserReport best = is_better(first.best, later.best) ? first : later;
    best.start = first.start;
    best.untried = later.untried;
    best.evaluations = first.evaluations + later.evaluations;
    best.failures = first.failures + later.failures;
    best.iterations = first.iterations + later.iterations;
    best.stages = std::move(first.stages);
    best.stages.insert(best.stages.end(), later.stages.begin(), later.stages.end());
    const std::string count = core::base::counted(static_cast<std::size_t>(best.evaluations), "evaluation");
    if (best.budget_spent) best.message = "stopped after " + count + ", which `max_evaluations` allows, of several searches";
    if (later.status != OptimiserStatus::interrupted) return best;
    best.status = OptimiserStatus::interrupted;
    best.message = "stopped as asked after " + count;
    return best;
}

OptimiserReport optimise(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options) {
    OptimiserReport report = StagedRun(problem, optimiser, options).run();
    if (report.best.usable) {
        report.objective = report.best.objective;
        report.violation = report.best.violation;
    }
    return report;
}

}  // namespace fettle::design::optimisers
