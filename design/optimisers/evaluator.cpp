// SPDX-License-Identifier: MIT
#include "design/optimisers/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/contract.hpp"

namespace fettle::design::optimisers {

namespace {

std::string bits_of(const VectorX& x) {
    std::string key(static_cast<size_t>(x.size()) * sizeof(double), '\0');
    std::memcpy(key.data(), x.data(), key.size());
    return key;
}

bool has_sizes(const Branches& b, int variables, int functions) {
    const auto k = static_cast<Eigen::Index>(b.of.size());
    return b.values.size() == k && b.jacobian.rows() == k && (k == 0 || b.jacobian.cols() == variables) &&
           std::all_of(b.of.begin(), b.of.end(), [&](int i) { return i >= 0 && i < functions; });
}

bool all_finite(const Branches& b) { return b.values.allFinite() && b.jacobian.allFinite(); }

// A NaN in an answer is a failure like any other: the optimisers must never compute with it.
Evaluation checked(Evaluation e, int variables, int constraints) {
    if (!e.usable) return e;
    FETTLE_ASSERT(e.constraints.size() == constraints, "an evaluation has the problem's constraints");
    if (!e.has_derivatives) {
        if (std::isfinite(e.objective) && e.constraints.allFinite() && std::isfinite(e.violation)) return e;
        e.usable = false;
        e.reason = "the evaluation gave a number that is not finite";
        return e;
    }
    FETTLE_ASSERT(e.gradient.size() == variables && e.constraints.size() == constraints && e.jacobian.rows() == constraints &&
                      e.jacobian.cols() == variables && e.residual_jacobian.rows() == e.residuals.size() &&
                      (e.residuals.size() == 0 || e.residual_jacobian.cols() == variables),
                  "an evaluation has the problem's sizes");
    FETTLE_ASSERT(has_sizes(e.constraint_branches, variables, constraints) &&
                      has_sizes(e.objective_branches, variables, std::numeric_limits<int>::max()),
                  "branches have the problem's sizes");
    const bool finite = std::isfinite(e.objective) && e.gradient.allFinite() && e.constraints.allFinite() && e.jacobian.allFinite() &&
                        e.residual_jacobian.allFinite() && std::isfinite(e.violation) && all_finite(e.constraint_branches) &&
                        all_finite(e.objective_branches);
    if (!finite) {
        e.usable = false;
        e.reason = "the evaluation gave a number that is not finite";
    }
    return e;
}

VectorX joined(const VectorX& a, const VectorX& b) {
    VectorX both(a.size() + b.size());
    both.head(a.size()) = a;
    both.tail(b.size()) = b;
    return both;
}

MatrixX stacked(const MatrixX& a, const MatrixX& b) {
    MatrixX both(a.rows() + b.rows(), a.cols());
    both.topRows(a.rows()) = a;
    both.bottomRows(b.rows()) = b;
    return both;
}

VectorX margin_of(const VectorX& margin, const VectorX& bounds) {
    if (margin.size() == 0) return VectorX::Zero(bounds.size());
    FETTLE_ASSERT(margin.size() == bounds.size() && margin.minCoeff() >= 0, "one margin per bound, not negative");
    return margin;
}

}  // namespace

bool is_better(const Evaluation& one, const Evaluation& other) {
    if (!one.usable || !other.usable) return one.usable && !other.usable;
    const bool feasible = one.violation <= 0, other_feasible = other.violation <= 0;
    if (feasible != other_feasible) return feasible;
    return feasible ? one.objective < other.objective : one.violation < other.violation;
}

Evaluator::Evaluator(const Problem& problem, EvaluatorOptions options) : problem_(problem), options_(std::move(options)) {
    FETTLE_ASSERT(problem.lower.size() == variables() && problem.upper.size() == variables(), "one bound per variable");
    FETTLE_ASSERT((problem.lower.array() <= problem.start.array()).all() && (problem.start.array() <= problem.upper.array()).all(),
                  "the start lies within the bounds");
    FETTLE_ASSERT(problem.periodic.empty() || count_of(problem.periodic) == variables(), "said of each variable or of none");
    FETTLE_ASSERT(problem.constraint_upper.size() == problem.constraint_lower.size(), "one bound per constraint");
    FETTLE_ASSERT(problem.relation_upper.size() == problem.relation_lower.size(), "one bound per relation");
    margin_ =
        joined(margin_of(problem.constraint_margin, problem.constraint_lower), margin_of(problem.relation_margin, problem.relation_lower));
    // A variable whose bounds coincide stays where it is; any range scales it.
    range_ = (problem.upper - problem.lower).unaryExpr([](double r) { return r > 0 ? r : 1.0; });
    scaled_start_ = (problem.start - problem.lower).cwiseQuotient(range_).cwiseMax(0).cwiseMin(1);
    constraint_scale_ = VectorX::Ones(constraints());
    try {
        start_evaluation_ =
            (options_.start ? keep(known_start(), Wanted::derivatives) : evaluate_new(scaled_start_, Wanted::derivatives)).evaluation;
    } catch (const StopOptimisation&) {
        start_evaluation_.reason = stop_reason_ == StopReason::interrupted ? "interrupted" : "no evaluation allowed";
    }
    rethrow();
    fix_scaling();
}

std::optional<Evaluation> Evaluator::scaled_reference() const {
    if (!options_.reference || !tells(*options_.reference)) return std::nullopt;
    Record record;
    record.evaluation = *options_.reference;
    record.relations = records_.front().relations;  // of no model: not asked for
    return scaled(record);
}

void Evaluator::fix_scaling() {
    if (start_evaluation_.usable) {
        const VectorX g = start_evaluation_.gradient.cwiseProduct(range_);
        const double size = variables() > 0 ? g.lpNorm<Eigen::Infinity>() : 0;
        const double objective_size = std::max(size, 1e-3 * std::abs(start_evaluation_.objective));
        if (objective_size > 0) objective_scale_ = 1 / objective_size;
        const VectorX values = joined(start_evaluation_.constraints, records_.front().relations.values);
        const MatrixX jacobian = stacked(start_evaluation_.jacobian, records_.front().relations.jacobian);
        const VectorX lower = joined(problem_.constraint_lower, problem_.relation_lower),
                      upper = joined(problem_.constraint_upper, problem_.relation_upper);
        for (int i = 0; i < constraints(); ++i) {
            const double row = jacobian.row(i).cwiseProduct(range_.transpose()).lpNorm<Eigen::Infinity>();
            const double to_bound = std::min(std::abs(values[i] - lower[i]), std::abs(values[i] - upper[i]));
            const double row_size = std::max({row, 1e-3 * std::abs(values[i]), std::isfinite(to_bound) ? 0.1 * to_bound : 0});
            if (row_size > 0) constraint_scale_[i] = 1 / row_size;
        }
    }
    keep_margin(1);
    for (Record& record : records_) record.scaled_evaluation = scaled(record);
}

void Evaluator::keep_margin(double share) {
    FETTLE_ASSERT(0 <= share && share <= 1, "a share of the margin");
    margin_share_ = share;
    const VectorX nearer = (1 - share) * margin_;
    scaled_constraint_lower_ = (joined(problem_.constraint_lower, problem_.relation_lower) - nearer).cwiseProduct(constraint_scale_);
    scaled_constraint_upper_ = (joined(problem_.constraint_upper, problem_.relation_upper) + nearer).cwiseProduct(constraint_scale_);
}

void Evaluator::keep_margin(double share, const VectorX& scaled_constraints) {
    keep_margin(0);
    const VectorX lower = scaled_constraint_lower_.cwiseMax(scaled_constraints),
                  upper = scaled_constraint_upper_.cwiseMin(scaled_constraints);
    keep_margin(share);
    scaled_constraint_lower_ = scaled_constraint_lower_.cwiseMin(lower);
    scaled_constraint_upper_ = scaled_constraint_upper_.cwiseMax(upper);
}

double Evaluator::missed_margins(const VectorX& scaled_constraints) const {
    double largest = 0;
    for (int i = 0; i < constraints(); ++i) {
        const double value = scaled_constraints[i] / constraint_scale_[i];
        const Eigen::Index relation = i - problem_.constraint_lower.size();
        const double lower = relation < 0 ? problem_.constraint_lower[i] : problem_.relation_lower[relation];
        const double upper = relation < 0 ? problem_.constraint_upper[i] : problem_.relation_upper[relation];
        const double missed = std::max(lower - margin_[i] - value, value - upper - margin_[i]);
        if (missed > 0) largest = std::max(largest, missed / margin_[i]);
    }
    return largest;
}

VectorX Evaluator::within(VectorX scaled) const {
    for (Eigen::Index k = 0; k < scaled.size(); ++k) {
        const bool is_outside = scaled[k] < 0 || scaled[k] > 1;
        if (is_outside) scaled[k] = is_periodic(k) ? scaled[k] - std::floor(scaled[k]) : std::clamp(scaled[k], 0.0, 1.0);
    }
    return scaled;
}

VectorX Evaluator::step_between(const VectorX& from, const VectorX& to) const {
    VectorX step = to - from;
    for (Eigen::Index k = 0; k < step.size(); ++k)
        if (is_periodic(k)) step[k] -= std::round(step[k]);
    return step;
}

Evaluator::Box Evaluator::steps_from(const VectorX& scaled, double radius) const {
    Box box{(-scaled).cwiseMax(-radius), (VectorX::Ones(scaled.size()) - scaled).cwiseMin(radius)};
    for (Eigen::Index k = 0; k < scaled.size(); ++k) {
        if (!is_periodic(k)) continue;
        box.lower[k] = -radius;
        box.upper[k] = radius;
    }
    return box;
}

VectorX Evaluator::unscaled(const VectorX& scaled_point) const {
    // The start is answered exactly: lower + (start - lower) / range * range can differ from it in the last bit.
    if (scaled_point == scaled_start_) return problem_.start;
    VectorX point = (problem_.lower + within(scaled_point).cwiseProduct(range_)).cwiseMax(problem_.lower).cwiseMin(problem_.upper);
    if (!problem_.representable) return point;
    return problem_.representable(point).cwiseMax(problem_.lower).cwiseMin(problem_.upper);
}

Evaluation Evaluator::scaled(const Record& record) const {
    const Evaluation& e = record.evaluation;
    Evaluation s = e;
    if (!e.usable) return s;
    s.objective = e.objective * objective_scale_;
    if (!e.has_derivatives) {
        s.constraints = joined(e.constraints, record.relations.values).cwiseProduct(constraint_scale_);
        return s;
    }
    s.gradient = e.gradient.cwiseProduct(range_) * objective_scale_;
    s.constraints = joined(e.constraints, record.relations.values).cwiseProduct(constraint_scale_);
    s.jacobian = constraint_scale_.asDiagonal() * stacked(e.jacobian, record.relations.jacobian) * range_.asDiagonal();
    s.residuals = std::sqrt(objective_scale_) * e.residuals;
    if (e.residuals.size() > 0) s.residual_jacobian = std::sqrt(objective_scale_) * e.residual_jacobian * range_.asDiagonal();
    for (size_t k = 0; k < e.constraint_branches.of.size(); ++k) {
        const double scale = constraint_scale_[e.constraint_branches.of[k]];
        const auto row = static_cast<Eigen::Index>(k);
        s.constraint_branches.values[row] *= scale;
        s.constraint_branches.jacobian.row(row) = scale * e.constraint_branches.jacobian.row(row).cwiseProduct(range_.transpose());
    }
    if (e.objective_branches.of.empty()) return s;
    s.objective_branches.values = objective_scale_ * e.objective_branches.values;
    s.objective_branches.jacobian = objective_scale_ * e.objective_branches.jacobian * range_.asDiagonal();
    return s;
}

const Evaluator::Record& Evaluator::asked(const VectorX& point, Wanted wanted) {
    const VectorX inside = within(point);
    const auto found = index_.find(bits_of(inside));
    if (found == index_.end()) return evaluate_new(inside, wanted);
    const Record& before = records_[found->second];
    if (wanted != Wanted::derivatives || !before.evaluation.usable || before.evaluation.has_derivatives) return before;
    const bool was_best = best_index_ == found->second;
    const Record& complete = evaluate_new(inside, wanted);
    if (was_best && complete.evaluation.usable) best_index_ = known() - 1;
    return complete;
}

const Evaluation& Evaluator::at(const VectorX& point) { return asked(point, Wanted::derivatives).scaled_evaluation; }

const Evaluation& Evaluator::values_at(const VectorX& point) { return asked(point, Wanted::values).scaled_evaluation; }

const Evaluation& Evaluator::look(const VectorX& point) { return asked(point, Wanted::values_of_no_candidate).scaled_evaluation; }

void Evaluator::evaluate(Record& record, Wanted wanted) const {
    const auto relations = count_of(problem_.relation_lower);
    const bool values = wanted != Wanted::derivatives && problem_.values;
    record.evaluation =
        checked(values ? problem_.values(record.point) : problem_.evaluate(record.point), variables(), constraints() - relations);
    add_relations(record);
}

void Evaluator::add_relations(Record& record) const {
    const auto relations = count_of(problem_.relation_lower);
    record.relations.jacobian.resize(0, variables());
    if (relations == 0) return;
    record.relations = problem_.relations(record.point);
    FETTLE_ASSERT(record.relations.values.size() == relations && record.relations.jacobian.rows() == relations &&
                      record.relations.jacobian.cols() == variables(),
                  "one value and one gradient per relation");
    if (!record.evaluation.usable || (record.relations.values.allFinite() && record.relations.jacobian.allFinite())) return;
    record.evaluation.usable = false;
    record.evaluation.reason = "a relation between the parameters is not a finite number";
}

const Evaluator::Record& Evaluator::evaluate_new(const VectorX& scaled_point, Wanted wanted) {
    if (evaluations() >= options_.max_evaluations) stop(StopReason::budget);
    if (options_.should_stop && options_.should_stop()) stop(StopReason::interrupted);
    Record record;
    record.scaled_point = scaled_point;
    record.point = unscaled(scaled_point);
    try {
        evaluate(record, wanted);
    } catch (const Interrupted&) {
        stop(StopReason::interrupted);
    } catch (...) {
        exception_ = std::current_exception();
        stop(StopReason::exception);
    }
    if (!record.evaluation.usable) ++failures_;
    const int best_before = best_index_;
    const Record& last = keep(std::move(record), wanted);
    if (options_.on_evaluation) options_.on_evaluation(evaluations(), last.point, last.evaluation, best_index_ != best_before);
    return last;
}

Evaluator::Record Evaluator::known_start() const {
    Record record;
    record.scaled_point = scaled_start_;
    record.point = problem_.start;
    record.evaluation = checked(*options_.start, variables(), count_of(problem_.constraint_lower));
    add_relations(record);
    return record;
}

const Evaluator::Record& Evaluator::keep(Record record, Wanted wanted) {
    record.scaled_evaluation = scaled(record);
    index_[bits_of(record.scaled_point)] = known();
    records_.push_back(std::move(record));
    if (wanted != Wanted::values_of_no_candidate) keep_best();
    return records_.back();
}

void Evaluator::keep_best() {
    const Evaluation& now = records_.back().evaluation;
    if (!now.usable) return;
    if (best_index_ < 0 || is_better(now, records_[best_index_].evaluation)) best_index_ = known() - 1;
}

void Evaluator::stop(StopReason reason) {
    if (stop_reason_ == StopReason::none) stop_reason_ = reason;
    throw StopOptimisation();
}

void Evaluator::rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
}

const VectorX& Evaluator::best_point() const {
    FETTLE_ASSERT(has_best(), "no point could be evaluated");
    return records_[best_index_].point;
}

const VectorX& Evaluator::best_scaled_point() const {
    FETTLE_ASSERT(has_best(), "no point could be evaluated");
    return records_[best_index_].scaled_point;
}

const Evaluation& Evaluator::best_evaluation() const {
    FETTLE_ASSERT(has_best(), "no point could be evaluated");
    return records_[best_index_].evaluation;
}

Evaluation Evaluator::best_scaled_evaluation() const {
    FETTLE_ASSERT(has_best(), "no point could be evaluated");
    return records_[best_index_].scaled_evaluation;
}

}  // namespace fettle::design::optimisers
