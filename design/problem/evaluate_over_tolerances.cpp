// SPDX-License-Identifier: MIT
#include "design/problem/evaluate_over_tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.hpp"
#include "design/description/made_design.hpp"
#include "design/problem/proven_clearance.hpp"
#include "design/problem/stopwatch.hpp"

namespace fettle::design::problem {

namespace {

using description::Design;
using description::MadeDesign;
using tolerances::RobustOffset;

/// A number that is asked for over the tolerances.
struct AskedNumber {
    bool of_objective = false;
    int index = 0;  // of the constraint or term
    int made = 0;   // of the constraint as made
    int side = 1;
    description::OverTolerances over;
};

bool is_proven(const description::OverTolerances& over) { return over.kind == description::OverTolerances::Kind::proven; }

/// A requirement's certified bounds over the tolerances, and the gradient of its worst parts, in the parameters as drawn.
struct ProvenRow {
    ProvenClearance clearance;
    double value = 0;  // of the worst parts: between the bounds
    VectorX gradient;
};

// Between the bounds [m]: well within the requirement's margin, or what is proven at one design scatters beside the next.
double proof_tolerance(const description::Bounds& bounds) {
    constexpr double finest = 1e-8, usual = 1e-7;
    return bounds.margin > 0 ? std::clamp(bounds.margin / 20, finest, usual) : usual;
}

Result<ProvenRow> proven_row(const Design& design, const EvaluateAsMade& as_made, const VectorX& p, int constraint) {
    const MadeDesign& made = *design.as_made;
    const VectorX here = made.extended(p);
    const Result<core::model::Model> model = as_made.model_at(base_point(made, here));
    if (!model) return model.errors();
    const quantities::ClearanceRange* range = design.constraints[constraint].quantity->facts().clearance;
    if (range == nullptr) return Error{ErrorCode::unsupported, design.constraints[constraint].name, "only a clearance can be proven"};
    Result<ProvenClearance> found = proven_clearance(made, here, *model, *range, proof_tolerance(design.constraints[constraint].bounds));
    if (!found) return found.errors();
    const std::optional<optimisers::Rows> rows = as_made.rest_rows(here + made.moved_by(found->deviations));
    if (!rows) return Error{ErrorCode::inconsistent, design.constraints[constraint].name, "its worst parts cannot be made"};
    Eigen::Index row = 0;
    for (int i = 0; i < constraint; ++i)
        if (design.constraints[i].quantity->is_at_rest()) ++row;
    ProvenRow out{*std::move(found), rows->values[row], VectorX(rows->jacobian.row(row).head(p.size()))};
    out.value = std::clamp(out.value, out.clearance.lower, std::max(out.clearance.lower, out.clearance.upper));
    return out;
}

std::vector<AskedNumber> asked_numbers(const Design& design) {
    std::vector<AskedNumber> out;
    for (int i = 0; i < count_of(design.constraints); ++i) {
        const description::Bounds& bounds = design.constraints[i].bounds;
        if (bounds.over_tolerances) out.push_back({false, i, i, description::side_of(bounds), *bounds.over_tolerances});
    }
    int made = count_of(design.constraints);
    for (int k = 0; k < count_of(design.objective); ++k) {
        const description::ObjectiveTerm& term = design.objective[k];
        if (term.over_tolerances) out.push_back({true, k, made++, term.weight < 0 ? -1 : 1, *term.over_tolerances});
    }
    return out;
}

/// Differences of all rows' gradients along one direction.
struct Difference {
    MatrixX here, above, below;  // rows as made, columns as drawn; empty: cannot be simulated
};

/// What a gradient changes by per unit of the step, as far as it does so smoothly.
struct Change {
    VectorX value;
    bool is_at_kink = false;
};

Change change_of(const Difference& d, int row, double step, const VectorX& ranges) {
    constexpr double jump = 1e-2;       // of the gradient: more than that within a step is looked at
    constexpr double large_jump = 0.1;  // and on both sides it is none of a smooth function
    const VectorX here = d.here.row(row);
    const auto size = [&](const VectorX& gradient) { return gradient.cwiseProduct(ranges).norm(); };
    if (d.above.size() == 0) return {(here - d.below.row(row).transpose()) / step, false};
    if (d.below.size() == 0) return {(d.above.row(row).transpose() - here) / step, false};
    const VectorX up = d.above.row(row).transpose() - here, down = here - d.below.row(row).transpose();
    const bool is_smooth = size(up - down) <= std::max(jump * size(here), 0.5 * (size(up) + size(down)));
    if (is_smooth) return {(up + down) / (2 * step), false};
    const VectorX& least = size(up) < size(down) ? up : down;
    if (size(least) <= large_jump * size(here)) return {least / step, true};
    return {VectorX::Zero(here.size()), true};
}

class RobustEvaluation {
public:
    RobustEvaluation(const Design& design, const EvaluateAsMade& as_made, const EvaluateOptions& options)
        : design_(design), made_(*design.as_made), as_made_(as_made), options_(options), n_(count_of(design.parameters)) {
        scales_ = made_.deviations.standard_deviations();
    }

    DesignEvaluation at(const VectorX& p) {
        here_ = made_.extended(p);
        EvaluateOptions nominal = options_;
        nominal.gradients = true;
        if (!options_.gradients) nominal.branches = BranchReach::none;
        out_ = as_made_.evaluate(here_, nominal);
        out_.parameters = p;
        if (!out_.usable) return std::move(out_);
        const MatrixX search = search_jacobian(out_);
        proven_.resize(asked_.size());
        for (std::size_t r = 0; r < asked_.size(); ++r) {
            const AskedNumber& number = asked_[r];
            if (is_proven(number.over)) {
                Result<ProvenRow> row = proven_row(design_, as_made_, p, number.index);
                if (!row) {
                    give_up(row.errors().front().where + ": " + row.errors().front().message);
                    leave_as_drawn();
                    return std::move(out_);
                }
                proven_[r] = *std::move(row);
            }
            offsets_.push_back(offset_of(r, search.row(number.made), out_.constraints));
            out_.robust.push_back({number.of_objective, number.index, {}, 0, 0, 0, made_.by_deviation(search.row(number.made)), {}, false});
        }
        if (options_.gradients) {
            const Stopwatch differences;
            differentiate(search);
            out_.backward_seconds += differences.seconds();
        }
        add_reserves();
        if (out_.usable) judge();
        leave_as_drawn();
        return std::move(out_);
    }

private:
    // The offset of a proven number is the difference between its values as made and as drawn.
    RobustOffset offset_of(std::size_t r, const VectorX& gradient, const std::vector<description::Measurement>& drawn) const {
        if (!proven_[r]) return offset_of(asked_[r], gradient);
        RobustOffset out;
        out.offset = proven_[r]->value - drawn[asked_[r].index].value;
        out.direction = VectorX::Zero(scales_.size());
        return out;
    }
    RobustOffset offset_of(const AskedNumber& number, const VectorX& gradient) const {
        return description::offset_of(number.over, made_.by_deviation(gradient), made_.deviations, number.side);
    }

    // The length of a direction, in standard deviations of what it moves most; of a deviation that is a constant, in itself.
    double length_of(const VectorX& direction) const {
        double most = 0;
        for (Eigen::Index j = 0; j < direction.size(); ++j)
            if (direction[j] != 0) most = std::max(most, scales_[j] > 0 ? std::abs(direction[j]) / scales_[j] : 1.0);
        return most;
    }

    // The known direction that this one is a multiple of, else it becomes one; and the multiple.
    std::pair<int, double> along(const VectorX& direction) {
        const double length = length_of(direction);
        const auto is_same = [&](const VectorX& known) { return length_of(known - direction / length) < 1e-9; };
        const auto is_opposite = [&](const VectorX& known) { return length_of(known + direction / length) < 1e-9; };
        for (int k = 0; k < count_of(directions_); ++k) {
            if (is_same(directions_[k])) return {k, length};
            if (is_opposite(directions_[k])) return {k, -length};
        }
        directions_.push_back(direction / length);
        return {count_of(directions_) - 1, length};
    }

    // Each row's direction as a sum of multiples of those that differences are taken along.
    std::vector<std::vector<std::pair<int, double>>> find_directions() {
        std::vector<std::vector<std::pair<int, double>>> parts(offsets_.size());
        for (std::size_t r = 0; r < offsets_.size(); ++r)
            if (!offsets_[r].direction.isZero(0)) parts[r] = {along(offsets_[r].direction)};
        if (count_of(directions_) <= scales_.size()) return parts;
        directions_.clear();
        for (std::size_t r = 0; r < offsets_.size(); ++r) {
            parts[r].clear();
            for (Eigen::Index j = 0; j < scales_.size(); ++j)
                if (offsets_[r].direction[j] != 0) parts[r].push_back(along(offsets_[r].direction[j] * VectorX::Unit(scales_.size(), j)));
        }
        return parts;
    }

    void differentiate(const MatrixX& search) {
        changes_.assign(asked_.size(), VectorX::Zero(n_));
        const auto parts = find_directions();
        std::vector<Difference> differences(directions_.size());
        for (Difference& difference : differences) difference.here = search.leftCols(n_);
        std::vector<std::string> reasons(2 * directions_.size());
        std::vector<char> interrupted(reasons.size());
        EvaluateOptions beside = for_several(options_);
        beside.on_step = nullptr;
        beside.balance = false;
        beside.branches = BranchReach::none;
        const std::vector<bool> at_rest = directions_at_rest(parts);
        core::base::parallel_for(count_of(reasons), 1, [&](int task) {
            Difference& difference = differences[task / 2];
            const double step = task % 2 == 0 ? robust_step : -robust_step;
            const VectorX point = here_ + step * made_.moved_by(directions_[task / 2]);
            MatrixX& found = task % 2 == 0 ? difference.above : difference.below;
            if (at_rest[task / 2]) {
                found = search_at_rest(point);
                if (found.size() == 0) reasons[task] = "its parts cannot be made";
                return;
            }
            const DesignEvaluation evaluation = as_made_.evaluate(point, beside);
            reasons[task] = evaluation.reason;
            interrupted[task] = evaluation.interrupted;
            if (evaluation.usable) found = search_jacobian(evaluation).leftCols(n_);
        });
        if (std::any_of(interrupted.begin(), interrupted.end(), [](char is) { return is != 0; })) {
            out_.interrupted = true;
            return give_up("interrupted");
        }
        for (std::size_t k = 0; k < differences.size(); ++k)
            if (differences[k].above.size() == 0 && differences[k].below.size() == 0)
                return give_up("made with deviations of 1/32 of a standard deviation: " + reasons[2 * k]);
        const VectorX ranges = ranges_of_parameters();
        for (std::size_t r = 0; r < asked_.size(); ++r) {
            if (proven_[r]) changes_[r] = proven_[r]->gradient - search.row(asked_[r].made).head(n_).transpose();
            for (const auto& [direction, multiple] : parts[r]) {
                const Change change = change_of(differences[direction], asked_[r].made, robust_step, ranges);
                changes_[r] += multiple * change.value;
                out_.robust[r].is_at_kink = out_.robust[r].is_at_kink || change.is_at_kink;
            }
        }
    }

    // Those that nothing names that follows from a motion.
    std::vector<bool> directions_at_rest(const std::vector<std::vector<std::pair<int, double>>>& parts) const {
        std::vector<bool> out(directions_.size(), as_made_.rest_rows != nullptr);
        for (std::size_t r = 0; r < asked_.size(); ++r)
            if (!made_.design.constraints[asked_[r].made].quantity->is_at_rest())
                for (const auto& [direction, multiple] : parts[r]) out[direction] = false;
        return out;
    }

    // The gradients of what is at rest, the others' 0; empty: they cannot be had.
    MatrixX search_at_rest(const VectorX& point) const {
        const std::optional<optimisers::Rows> rows = as_made_.rest_rows(point);
        if (!rows) return {};
        const auto& constraints = made_.design.constraints;
        MatrixX out = MatrixX::Zero(count_of(constraints), n_);
        Eigen::Index next = 0;
        for (int i = 0; i < count_of(constraints); ++i)
            if (constraints[i].quantity->is_at_rest()) out.row(i) = rows->jacobian.row(next++).head(n_);
        return out;
    }

    VectorX ranges_of_parameters() const {
        VectorX ranges(n_);
        for (int k = 0; k < n_; ++k) ranges[k] = design_.parameters[k].upper - design_.parameters[k].lower;
        return ranges;
    }

    void give_up(const std::string& reason) {
        out_.usable = false;
        out_.reason = reason;
    }

    void add_reserves() {
        for (std::size_t r = 0; r < asked_.size(); ++r) {
            const AskedNumber& number = asked_[r];
            RobustRow& row = out_.robust[r];
            description::Measurement& measured = (number.of_objective ? out_.terms : out_.constraints)[number.index];
            // What the search sees of a constraint that is continued has a gradient of its own.
            const RobustOffset own = offset_of(r, out_.jacobian.row(number.made), out_.constraints);
            row.drawn = measured;
            row.mean = own.mean;
            row.standard_deviation = own.standard_deviation;
            row.reserve = own.offset;
            measured.value += own.offset;
            measured.lower += own.offset;
            measured.upper += own.offset;
            measured.is_proven = false;
            if (proven_[r]) {
                const ProvenClearance& of = proven_[r]->clearance;
                measured.lower = of.lower;
                measured.upper = std::max(of.lower, of.upper);
                measured.is_proven = true;
                if (!of.fault.empty()) measured.fault = of.fault;
                row.deviations = of.deviations;
            }
            number.of_objective ? add_to_objective(r) : add_to_constraint(r);
        }
    }

    bool has_changes() const { return !changes_.empty(); }

    void add_to_objective(std::size_t r) {
        const description::ObjectiveTerm& term = design_.objective[asked_[r].index];
        const double scale = term.weight / term.unit;
        out_.objective += scale * out_.robust[r].reserve;
        if (!has_changes()) return;
        out_.gradient.head(n_) += scale * changes_[r];
        AskedNumber scaled = asked_[r];
        scaled.side = 1;  // f is minimised, whatever the sign of its weight
        add_to_branches(scaled, scale * changes_[r], out_.objective_branches);
    }

    void add_to_constraint(std::size_t r) {
        const AskedNumber& number = asked_[r];
        for (ContinuedRow& continued : out_.continued) {
            if (continued.constraint != number.index) continue;
            continued.value += offsets_[r].offset;
            if (has_changes()) continued.gradient.head(n_) += changes_[r];
        }
        if (!has_changes()) return;
        out_.jacobian.row(number.index).head(n_) += changes_[r].transpose();
        add_to_branches(number, changes_[r], out_.constraint_branches, proven_[r] ? std::optional(offsets_[r].offset) : std::nullopt);
    }

    // Each with the reserve of its own derivatives, which changes as that of the one that the value is.
    void add_to_branches(const AskedNumber& number, const VectorX& change, optimisers::Branches& branches,
                         std::optional<double> same_offset = {}) const {
        for (Eigen::Index k = 0; k < branches.values.size(); ++k) {
            if (branches.of[static_cast<std::size_t>(k)] != number.index) continue;
            branches.values[k] += same_offset ? *same_offset : offset_of(number, branches.jacobian.row(k)).offset;
            branches.jacobian.row(k).head(n_) += change.transpose();
        }
    }

    void judge() {
        out_.violation = 0;
        for (int i = 0; i < count_of(design_.constraints); ++i)
            out_.violation = std::max(out_.violation, violation(design_.constraints[i].bounds, out_.constraints[i]));
    }

    // Without the rows and columns that the design as made has more.
    void leave_as_drawn() {
        const auto m = count_of(design_.constraints);
        out_.constraints.resize(design_.constraints.size());
        const auto as_drawn = [&](MatrixX& rows) {
            if (rows.size() > 0) rows = MatrixX(rows.leftCols(n_));
        };
        if (!options_.gradients || !out_.usable) {
            out_.gradient.resize(0);
            out_.jacobian.resize(0, 0);
            out_.residuals.resize(0);
            out_.residual_jacobian.resize(0, 0);
            out_.constraint_branches = out_.objective_branches = {};
            out_.ties.clear();
            out_.forward_seconds += std::exchange(out_.backward_seconds, 0.0);
            for (ContinuedRow& continued : out_.continued) continued.gradient.resize(0);
            if (!out_.usable) out_.objective = out_.violation = std::nan("");
            return;
        }
        out_.gradient = VectorX(out_.gradient.head(n_));
        out_.jacobian = MatrixX(out_.jacobian.topLeftCorner(m, n_));
        as_drawn(out_.residual_jacobian);
        as_drawn(out_.constraint_branches.jacobian);
        as_drawn(out_.objective_branches.jacobian);
        for (ContinuedRow& continued : out_.continued) continued.gradient = VectorX(continued.gradient.head(n_));
        for (Tie& tie : out_.ties) {
            tie.least = VectorX(tie.least.head(n_));
            tie.greatest = VectorX(tie.greatest.head(n_));
        }
    }

    const Design& design_;
    const MadeDesign& made_;
    const EvaluateAsMade& as_made_;
    const EvaluateOptions& options_;
    const int n_;
    const std::vector<AskedNumber> asked_ = asked_numbers(design_);
    VectorX scales_;
    VectorX here_;
    DesignEvaluation out_;
    std::vector<std::optional<ProvenRow>> proven_;  // of each number that is asked for
    std::vector<RobustOffset> offsets_;             // of what the search sees
    std::vector<VectorX> directions_;               // of length 1
    std::vector<VectorX> changes_;                  // of the offsets, per parameter as drawn; empty: not asked for
};

}  // namespace

DesignEvaluation evaluate_over_tolerances(const Design& design, const EvaluateAsMade& as_made, const VectorX& p,
                                          const EvaluateOptions& options) {
    return RobustEvaluation(design, as_made, options).at(p);
}

bool add_reserves(const Design& design, const EvaluateAsMade& as_made, const VectorX& p, const std::vector<int>& constraints,
                  optimisers::Rows& rows) {
    const MadeDesign& made = *design.as_made;
    for (Eigen::Index k = 0; k < rows.values.size(); ++k) {
        const int constraint = constraints[static_cast<std::size_t>(k)];
        const description::Bounds& bounds = design.constraints[constraint].bounds;
        if (!bounds.over_tolerances) continue;
        if (is_proven(*bounds.over_tolerances)) {
            const Result<ProvenRow> row = proven_row(design, as_made, p, constraint);
            if (!row) return false;
            rows.values[k] = row->value;
            rows.jacobian.row(k).head(p.size()) = row->gradient.transpose();
            continue;
        }
        const VectorX gradient = made.by_deviation(rows.jacobian.row(k));
        rows.values[k] += description::offset_of(*bounds.over_tolerances, gradient, made.deviations, description::side_of(bounds)).offset;
    }
    rows.jacobian = MatrixX(rows.jacobian.leftCols(count_of(design.parameters)));
    return true;
}

}  // namespace fettle::design::problem
