// SPDX-License-Identifier: MIT
/// The one door between an optimiser and a problem. It scales (variables to [0, 1] by their bounds; f and each c by the largest derivative
/// at the start, so that all are of order one; relations between the variables are further rows of c here), evaluates each point once
/// (cached by the exact bits of the point, since Ipopt and NLopt ask for values and derivatives of one point separately), counts, keeps the
/// best design, and stops a run that is over. Scaling and the order of evaluations are functions of the problem alone: a run repeated has
/// the same bits.
///
/// A c that hardly changes at the start, such as a force that is missing there yet, is scaled by a tenth of its distance from its bound
/// instead: by its derivative it would count 1e5 times as much as the others where it does change.
#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

struct EvaluatorOptions {
    int max_evaluations = 200;
    std::function<bool()> should_stop;  ///< optional; asked before each evaluation
    /// Optional: after each evaluation, with its number (1, 2, ...) and whether it became the best.
    std::function<void(int, const VectorX&, const Evaluation&, bool)> on_evaluation;
    /// Optional: of a smoother model of the same thing, near the start. Where this one's derivatives predict its own values worse, they
    /// stand in (local_model.hpp).
    std::optional<Evaluation> reference = {};
    /// Optional: of the start, where it was evaluated before: it is neither asked for nor counted again.
    std::optional<Evaluation> start = {};
};

/// Thrown out of a callback to end the native optimiser; Evaluator::stop_reason says why. Never leaves minimise().
struct StopOptimisation : std::exception {
    const char* what() const noexcept override { return "optimisation stopped"; }
};

enum class StopReason { none, budget, interrupted, exception };

/// Feasible beats infeasible; among feasible the lower objective, among infeasible the smaller violation. What cannot be evaluated is
/// worst.
bool is_better(const Evaluation& one, const Evaluation& other);

/// Whether an evaluation describes the functions near it: values and derivatives.
inline bool tells(const Evaluation& e) { return e.usable && e.has_derivatives; }

class Evaluator {
public:
    /// Evaluates the start (which may fail: `start_evaluation().usable`) and fixes the scaling from it.
    /// Errors: rethrows what Problem::evaluate throws, Interrupted excepted (stop_reason).
    Evaluator(const Problem& problem, EvaluatorOptions options);

    int variables() const { return count_of(problem_.start); }
    int constraints() const { return static_cast<int>(problem_.constraint_lower.size() + problem_.relation_lower.size()); }

    int simulated_constraints() const { return count_of(problem_.constraint_lower); }  ///< the others are relations

    bool is_periodic(Eigen::Index k) const { return !problem_.periodic.empty() && problem_.periodic[static_cast<size_t>(k)]; }
    /// The point of [0, 1]^n that a scaled point stands for: the nearest one, and of a periodic variable the same one of the first period.
    VectorX within(VectorX scaled) const;
    VectorX moved(const VectorX& scaled, const VectorX& step) const { return within(scaled + step); }
    /// The shortest step from one scaled point to another: the two ends of a period are one place.
    VectorX step_between(const VectorX& from, const VectorX& to) const;
    /// Steps from a scaled point that stay within |d_k| <= radius and the bounds.
    struct Box {
        VectorX lower, upper;
    };
    Box steps_from(const VectorX& scaled, double radius) const;

    /// Scaled evaluation: x in [0, 1] (within()), f, (c, r) and derivatives scaled. `usable` may be false.
    /// Throws StopOptimisation when the run is over.
    const Evaluation& at(const VectorX& scaled);

    /// The same, of which the values alone are needed: without derivatives where the problem can do that for less.
    /// Asked for them later, at() evaluates the point again.
    const Evaluation& values_at(const VectorX& scaled);

    /// The same as values_at(), but the point does not become the best one: to find out how rough the problem is.
    const Evaluation& look(const VectorX& scaled);

    /// Why a point cannot be evaluated, without the cost of an evaluation; empty: nothing known against it.
    std::string refusal(const VectorX& scaled) const { return problem_.refusal ? problem_.refusal(unscaled(scaled)) : std::string(); }

    /// So many evaluations more.
    void allow(int evaluations) { options_.max_evaluations += evaluations; }

    /// Aims at the bounds proper, less this share of their margins; 1, as at the beginning: as the problem says. The second form leaves a
    /// constraint of this value (scaled) that is nearer to its bound where it is. Contract: 0 <= share <= 1.
    void keep_margin(double share);
    void keep_margin(double share, const VectorX& scaled_constraints);
    double margin_share() const { return margin_share_; }
    /// The largest miss of a bound proper by these constraints (scaled), in its margin: 0: none; infinite: one that has no margin is
    /// missed.
    double missed_margins(const VectorX& scaled_constraints) const;

    const VectorX& scaled_start() const { return scaled_start_; }
    /// What is aimed at, relations too.
    const VectorX& scaled_constraint_lower() const { return scaled_constraint_lower_; }
    const VectorX& scaled_constraint_upper() const { return scaled_constraint_upper_; }
    /// Are the branches of constraint i those of a value that is the greatest (Problem::is_greatest)?
    bool is_greatest(int i) const { return i < count_of(problem_.is_greatest) && problem_.is_greatest[static_cast<std::size_t>(i)]; }
    std::optional<Evaluation> scaled_reference() const;
    VectorX unscaled(const VectorX& scaled) const;
    double objective_scale() const { return objective_scale_; }            ///< scaled f / f
    const VectorX& constraint_scale() const { return constraint_scale_; }  ///< scaled c / c
    const VectorX& range() const { return range_; }                        ///< of the variables

    const Evaluation& start_evaluation() const { return start_evaluation_; }
    bool has_best() const { return best_index_ >= 0; }
    const VectorX& best_point() const;          ///< unscaled. Contract: has_best
    const VectorX& best_scaled_point() const;   ///< Contract: has_best
    const Evaluation& best_evaluation() const;  ///< unscaled. Contract: has_best
    Evaluation best_scaled_evaluation() const;  ///< Contract: has_best

    /// What is known, in the order in which it was found out, from the start on; scaled.
    int known() const { return count_of(records_); }
    const VectorX& scaled_point(int number) const { return records_[number].scaled_point; }
    const Evaluation& scaled_evaluation(int number) const { return records_[number].scaled_evaluation; }

    int evaluations() const { return known() - (options_.start ? 1 : 0); }  ///< that were asked for
    int failures() const { return failures_; }
    StopReason stop_reason() const { return stop_reason_; }
    void rethrow() const;  ///< rethrows an exception of the problem, if there was one

private:
    struct Record {
        VectorX scaled_point, point;
        Evaluation evaluation, scaled_evaluation;
        Rows relations;
    };
    enum class Wanted { derivatives, values, values_of_no_candidate };
    const Record& asked(const VectorX& scaled, Wanted wanted);
    void evaluate(Record& record, Wanted wanted) const;
    void add_relations(Record& record) const;
    Record known_start() const;
    Evaluation scaled(const Record& record) const;
    void fix_scaling();
    const Record& evaluate_new(const VectorX& scaled_point, Wanted wanted);
    const Record& keep(Record record, Wanted wanted);
    void keep_best();
    void stop(StopReason reason);

    const Problem& problem_;
    EvaluatorOptions options_;
    VectorX range_, scaled_start_, constraint_scale_, scaled_constraint_lower_, scaled_constraint_upper_;
    VectorX margin_;  ///< of constraints and relations, not scaled
    double margin_share_ = 1;
    double objective_scale_ = 1;
    Evaluation start_evaluation_;
    std::deque<Record> records_;        ///< references into it stay valid
    std::map<std::string, int> index_;  ///< by the bits of the scaled point
    int best_index_ = -1;
    int failures_ = 0;
    StopReason stop_reason_ = StopReason::none;
    std::exception_ptr exception_;
};

}  // namespace fettle::design::optimisers
