// SPDX-License-Identifier: MIT
#include "design/studies/optimise_design.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "design/description/requirement_text.hpp"
#include "design/optimisers/least_squares.hpp"
#include "design/optimisers/nearest_design.hpp"
#include "design/problem/buildable.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "design/problem/smoother_models.hpp"
#include "design/studies/limits.hpp"
#include "design/studies/random_start.hpp"

namespace fettle::design::studies {

namespace {

using description::Design;
using problem::DesignEvaluation;

// The requirement that is missed by most, by how much.
std::string shortfall(const Design& design, const VectorX& p, const optimisers::Evaluation& e) {
    if (e.violation <= 0) return "meets every requirement";
    double most = 0;
    std::string text;
    const auto look_at = [&](const std::string& name, double violation, const std::string& unit) {
        if (!(violation > most)) return;
        most = violation;
        text = "misses " + name + " by " + description::amount_text(violation, 1, unit, 4);
    };
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Constraint& constraint = design.constraints[i];
        const description::Measurement value = description::computed(e.measured.size() > 0 ? e.measured[i] : e.constraints[i]);
        look_at(constraint.name, description::violation(constraint.bounds, value), description::unit_name(constraint));
    }
    for (const description::Relation& relation : design.relations)
        look_at(relation.name, description::violation(relation, relation.at(p).value), "");
    constexpr double nearly = 0.01;  // what is proven may be a little less than the value found
    return std::abs(most - e.violation) <= nearly * e.violation ? text : "a requirement is not proven to be met";
}

// `unit`: of the objective.
std::string evaluation_line(const Design& design, const std::string& unit, int number, const VectorX& p, const optimisers::Evaluation& e,
                            bool best) {
    char line[80];
    std::snprintf(line, sizeof line, "%4d  ", number);
    if (!e.usable) return line + ("cannot be evaluated: " + e.reason);
    const std::string text = line + shortfall(design, p, e);
    std::snprintf(line, sizeof line, "objective %-13s", description::amount_text(e.objective, 1, unit, 8).c_str());
    return text.substr(0, 6) + line + " " + text.substr(6) + (best ? ", the best so far" : "");
}

constexpr double repair_tolerance = 1e-2;  // of the squared change: half a percent of the change

using Compute = std::function<HistoryEntry(const problem::DesignProblem&, const VectorX&, Recorded)>;

// Answers for one model: from the history, if there is one that has it, else computed. `model` and `compute` must outlive it.
std::function<optimisers::Evaluation(const VectorX&)> answered(const problem::DesignProblem& model, const std::string& name,
                                                               const Compute& compute, History* history, Recorded wanted) {
    const auto entry = [&model, &compute, wanted](const VectorX& p) { return compute(model, p, wanted); };
    if (history != nullptr) return recorded(*history, entry, name, wanted);
    return [entry](const VectorX& p) { return entry(p).evaluation; };
}

// No contact is possible: a simulation takes milliseconds.
bool moves_by_joints_alone(const problem::DesignProblem& problem) {
    const Result<core::model::Model> model = problem.model_at(description::values_of(problem.design().parameters));
    if (!model || model->mechanism.empty() || problem::has_costly_shapes(problem.design())) return false;
    for (int a = 0; a < count_of(model->bodies); ++a)
        for (int b = a + 1; b < count_of(model->bodies); ++b)
            if (core::model::may_collide(*model, a, b)) return false;
    return true;
}

// One run: the problem that the optimiser sees, what it has tried, and the outcome.
class DesignRun {
public:
    DesignRun(const problem::DesignProblem& problem, const OptimiseOptions& options)
        : problem_(problem), design_(problem.design()), options_(options) {
        with_derivatives_.should_stop = [this] { return !has_ended_ && options_.should_stop && options_.should_stop(); };
        with_derivatives_.on_step = options.on_step;
        compute_ = [this](const problem::DesignProblem& model, const VectorX& p, Recorded wanted) {
            if (options_.replay_only && !has_ended_) throw optimisers::Interrupted();
            ++computed_;
            const bool values = wanted == Recorded::values;
            HistoryEntry entry =
                history_entry(design_, p, model.evaluate(p, values ? problem::without_gradients(with_derivatives_) : with_derivatives_));
            if (&model == &problem_) note_start(entry);
            return entry;
        };
        if (options.history != nullptr)
            for (const HistoryEntry& entry : options.history->replayed())
                if (entry.model.empty()) replayed_.push_back(&entry);
    }

    OptimiseOutcome run(const optimisers::Optimiser& optimiser) {
        optimisers::Problem seen = begun();
        add_smoother_models(seen);
        watch_refusals(seen);
        outcome_.unbuildable = problem::described(design_, problem::try_bounds(problem_));
        for (const std::string& line : outcome_.unbuildable) narrate("bounds: " + line);
        if (options_.repair) seen = optimisers::nearest_to(description::values_of(design_.parameters), std::move(seen));
        if (options_.seed != 0 && !options_.repair && moves_by_joints_alone(problem_))
            search_from_many_places(seen, optimiser);
        else
            outcome_.report = optimisers::optimise(seen, optimiser, settings());
        if (options_.seed != 0 && !options_.repair) begin_again(seen, optimiser);
        outcome_.replayed = outcome_.report.evaluations - computed_;
        has_ended_ = true;
        if (outcome_.report.untried.size() > 0) try_untried(seen);
        if (outcome_.report.best.usable) measure_end();
        return std::move(outcome_);
    }

private:
    void narrate(const std::string& line) const {
        if (options_.narrate) options_.narrate(line);
    }

    optimisers::Problem begun() {
        optimisers::Problem seen = problem::optimiser_problem(problem_, with_derivatives_);
        seen.start = outcome_.start = start_of_seed(problem_, options_.seed);
        for (const HistoryEntry* entry : std::exchange(replayed_, {})) note_start(*entry);
        for (const core::scene::Joint& joint : description::design_of_scenario(design_, 0).scene.mechanism.joints)
            if (joint.assemble) outcome_.sides.push_back({joint.name, *joint.assemble});
        seen.values = answered(problem_, {}, compute_, options_.history, Recorded::values);
        seen.evaluate = [this, own = answered(problem_, {}, compute_, options_.history, Recorded::with_derivatives)](const VectorX& p) {
            optimisers::Evaluation e = own(p);
            if (e.usable && p == outcome_.start) outcome_.objective_start = e.objective;
            if (e.usable && !std::exchange(has_begun_, true)) look_at_start(e);
            return e;
        };
        return seen;
    }

    void note_start(const HistoryEntry& entry) {
        MeasuredAtStart& at = outcome_.measured_at_start;
        const optimisers::Evaluation& e = entry.evaluation;
        if (!e.usable || entry.point != outcome_.start || !at.constraints.empty() || !at.terms.empty()) return;
        const VectorX& measured = e.measured.size() > 0 ? e.measured : e.constraints;
        at.constraints.assign(measured.begin(), measured.end());
        for (const auto& [name, value] : entry.terms) at.terms.push_back(value);
    }

    void look_at_start(const optimisers::Evaluation& e) {
        has_squares_alone_ = optimisers::is_sum_of_squares(e);
        const Eigen::Index m = e.constraints.size();
        VectorX values(1 + m);
        values << e.objective, e.constraints;
        MatrixX gradients(1 + m, e.gradient.size());
        gradients << e.gradient.transpose(), e.jacobian;
        outcome_.at_start = gradient_audit::gradient_warnings(design_, values, gradients);
        for (const std::string& line : outcome_.at_start.warnings) narrate("warning: " + line);
        for (const std::string& line : outcome_.at_start.notes) narrate("note: " + line);
    }

    void add_smoother_models(optimisers::Problem& seen) {
        smoother_ = problem::smoother_models(problem_, seen.prepared ? seen.prepared(seen.start) : seen.start);
        for (const problem::SmootherDesign& model : smoother_) {
            seen.smoother.push_back({model.name,
                                     answered(model.problem, model.name, compute_, options_.history, Recorded::with_derivatives),
                                     answered(model.problem, model.name, compute_, options_.history, Recorded::values)});
        }
        if (smoother_.empty()) return;
        std::string names;
        for (const problem::SmootherDesign& model : smoother_) names += (names.empty() ? "" : ", then ") + model.name;
        narrate("parts rattle in the play of their fits: the search begins with contact that reaches farther, in which they do not (" +
                names + ")");
    }

    void watch_refusals(optimisers::Problem& seen) {
        seen.refusal = [this, ask = seen.refusal](const VectorX& p) {
            std::string reason = ask(p);
            if (!reason.empty()) {
                ++refused_;
                failures_.push_back({p, reason});
            }
            return reason;
        };
    }

    // Searches from one random place after another, roughly and without a verdict, then on from the best end, with one.
    void search_from_many_places(optimisers::Problem& seen, const optimisers::Optimiser& optimiser) {
        constexpr int least = 20;  // worth a search
        constexpr int enough = 5;  // searches that end with the same objective
        constexpr double same = 5e-3, roughly = 1e-3;
        const int reserve = std::min(100, design_.optimiser.max_evaluations / 6);  // of the last one
        std::vector<double> ends;
        const auto agrees = [&](double end) {
            return std::abs(end - outcome_.report.objective) <= same * std::abs(outcome_.report.objective);
        };
        for (int k = 0;; ++k) {
            const int left = design_.optimiser.max_evaluations - outcome_.report.evaluations - reserve;
            if (k > 0 && left < least) break;
            optimisers::OptimiserOptions rough = settings();
            rough.tolerance = std::max(roughly, rough.tolerance);
            rough.judges = false;
            if (k > 0) {
                narrate("on from another random place");
                seen.start = later_start_of_seed(problem_, options_.seed, k);
            }
            if (!go_on(seen, optimiser, rough, std::max(1, left))) return;
            ends.push_back(last_end_);
            const bool vanishes = has_squares_alone_ && outcome_.report.feasible && outcome_.report.objective <= negligible();
            if (vanishes || std::count_if(ends.begin(), ends.end(), agrees) >= enough) break;
        }
        if (!outcome_.report.best.usable) return;
        narrate("on from the best of these");
        seen.start = outcome_.report.point;
        optimisers::OptimiserOptions last = settings();
        last.negligible = negligible();
        go_on(seen, optimiser, last, design_.optimiser.max_evaluations - outcome_.report.evaluations);
    }

    // A random start may lie where nothing leads to what is required: in a clash, beyond a dead centre, where something never happens. What
    // is left of the evaluations goes to others.
    void begin_again(optimisers::Problem& seen, const optimisers::Optimiser& optimiser) {
        constexpr int least = 20;  // worth a search
        for (int k = 1; !outcome_.report.feasible && outcome_.report.status != optimisers::OptimiserStatus::interrupted; ++k) {
            const int left = design_.optimiser.max_evaluations - outcome_.report.evaluations;
            if (left < least) return;
            narrate("from here nothing leads to what is required; on from another random place");
            seen.start = later_start_of_seed(problem_, options_.seed, k);
            if (!go_on(seen, optimiser, settings(), left)) return;
        }
    }

    // What does not count of a sum of squares: its residuals are then a millionth of those at the start.
    double negligible() const { return has_squares_alone_ ? 1e-12 * std::abs(outcome_.objective_start.value_or(0)) : 0; }

    // One more search. @return false: there is no going on.
    bool go_on(const optimisers::Problem& seen, const optimisers::Optimiser& optimiser, optimisers::OptimiserOptions options, int most) {
        const optimisers::OptimiserReport before = outcome_.report;
        options.max_evaluations = most;
        options.on_evaluation = [&, tell = options.on_evaluation](int number, const VectorX& p, const optimisers::Evaluation& e,
                                                                  bool best) {
            tell(before.evaluations + number, p, e, best && (before.evaluations == 0 || optimisers::is_better(e, before.best)));
        };
        const optimisers::OptimiserReport next = optimisers::optimise(seen, optimiser, options);
        last_end_ = next.objective;
        outcome_.report = before.evaluations == 0 ? next : optimisers::better_of(before, next);
        return next.status != optimisers::OptimiserStatus::interrupted && next.evaluations > 0;
    }

    optimisers::OptimiserOptions settings() {
        optimisers::OptimiserOptions settings;
        settings.max_evaluations = design_.optimiser.max_evaluations;
        settings.tolerance = options_.repair ? std::max(repair_tolerance, design_.optimiser.tolerance) : design_.optimiser.tolerance;
        settings.should_stop = options_.should_stop;
        settings.on_evaluation = [this](int number, const VectorX& p, const optimisers::Evaluation& e, bool best) {
            if (!e.usable) failures_.push_back({p, e.reason});
            if (options_.on_evaluation) options_.on_evaluation(number, p, e, best);
            narrate(evaluation_line(design_, options_.repair ? std::string() : description::objective_unit(design_), number, p, e, best));
        };
        settings.narrate = [this](const std::string& line) { narrate(line); };
        return settings;
    }

    // Stopped among the smoother models: what these have led to may be better than the start as written, too, and is not lost.
    void try_untried(const optimisers::Problem& seen) {
        optimisers::OptimiserReport& report = outcome_.report;
        const VectorX point = report.untried;
        const optimisers::Evaluation found = seen.values(point);
        const bool better = optimisers::is_better(found, report.best);
        optimisers::take_if_better(report, point, found);
        if (better) report.message += "; the design is the best of these, as it is as written";
    }

    // The best design once more, with its certificates. Not interruptible: it is what makes the result of an interrupted run usable.
    void measure_end() {
        const VectorX point = outcome_.report.point;
        static_cast<JudgedDesign&>(outcome_) = judge_design(problem_, point, {options_.should_stop, options_.on_step});
        judge_end();
        if (!outcome_.final.usable || outcome_.report.feasible) return;
        outcome_.limits =
            limits_of(problem_, point, outcome_.final, outcome_.report.best.jacobian, failures_, outcome_.report.evaluations + refused_);
    }

    // Do both say the same of a design? To more than the rounding of another machine, which may have computed one of them.
    bool agree(const optimisers::Evaluation& a, const optimisers::Evaluation& b) const {
        const auto near = [](double x, double y, double size) {
            return std::abs(x - y) <= 1e-6 * std::max({std::abs(x), std::abs(y), std::abs(size)});
        };
        if (!a.usable || !b.usable || (a.violation <= 0) != (b.violation <= 0) || a.constraints.size() != b.constraints.size())
            return false;
        for (Eigen::Index i = 0; i < a.constraints.size(); ++i)
            if (!near(a.constraints[i], b.constraints[i], design_.constraints[i].bounds.unit)) return false;
        return near(a.objective, b.objective, outcome_.objective_start.value_or(0));
    }

    // The design's measure now is what counts, whatever the search was told of it, by a history perhaps.
    void judge_end() {
        optimisers::OptimiserReport& report = outcome_.report;
        optimisers::Evaluation now = problem::optimiser_evaluation(outcome_.final);
        if (options_.repair) now.objective = report.best.objective;  // a distance, of which it knows nothing
        if (agree(now, report.best)) return;
        const std::string stopped = report.status == optimisers::OptimiserStatus::interrupted ? report.message + "; " : "";
        report.message = stopped + "evaluated once more, this design is not what the " + (outcome_.replayed > 0 ? "history" : "search") +
                         " says it is" + (now.usable ? "" : ", and cannot be evaluated: " + now.reason) +
                         "; something that it depends on has changed that nobody knows of (a file that a program reads): run it without "
                         "--resume";
        report.feasible = now.usable && now.violation <= 0;
        report.optimality = {};
        if (stopped.empty())
            report.status = report.feasible ? optimisers::OptimiserStatus::feasible : optimisers::OptimiserStatus::infeasible;
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        report.objective = now.usable ? now.objective : unknown;
        report.violation = now.usable ? now.violation : unknown;
        report.best = std::move(now);
    }

    const problem::DesignProblem& problem_;
    const Design& design_;
    const OptimiseOptions& options_;
    problem::EvaluateOptions with_derivatives_;
    Compute compute_;
    std::vector<problem::SmootherDesign> smoother_;
    std::vector<FailedTrial> failures_;
    std::vector<const HistoryEntry*> replayed_;  // of the design's own model, until the start is known
    int computed_ = 0, refused_ = 0;
    bool has_begun_ = false, has_ended_ = false, has_squares_alone_ = false;
    double last_end_ = 0;  // of the search that was made last
    OptimiseOutcome outcome_;
};

}  // namespace

HistoryEntry history_entry(const Design& design, const VectorX& p, const DesignEvaluation& evaluation) {
    HistoryEntry entry;
    entry.point = p;
    entry.forward_seconds = evaluation.forward_seconds;
    entry.backward_seconds = evaluation.backward_seconds;
    entry.evaluation = problem::optimiser_evaluation(evaluation);
    if (!entry.evaluation.usable) return entry;
    for (size_t i = 0; i < evaluation.constraints.size(); ++i)
        if (evaluation.constraints[i].is_proven) entry.certified.emplace_back(design.constraints[i].name, evaluation.constraints[i].lower);
    for (size_t k = 0; k < evaluation.terms.size(); ++k) entry.terms.emplace_back(design.objective[k].name, evaluation.terms[k].value);
    return entry;
}

Result<OptimiseOutcome> optimise_design(const problem::DesignProblem& problem, const OptimiseOptions& options) {
    const std::string& name = options.optimiser.empty() ? problem.design().optimiser.name : options.optimiser;
    const auto optimiser = optimisers::make_optimiser(name, "optimiser");
    if (!optimiser) return optimiser.errors();
    return DesignRun(problem, options).run(**optimiser);
}

}  // namespace fettle::design::studies
