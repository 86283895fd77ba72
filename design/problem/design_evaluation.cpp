// SPDX-License-Identifier: MIT
#include "design/problem/design_evaluation.hpp"

#include <cmath>
#include <mutex>
#include <utility>

#include "core/base/text.hpp"
#include "design/description/made_design.hpp"

namespace fettle::design::problem {

VectorX search_values(const DesignEvaluation& evaluation) {
    VectorX values(evaluation.constraints.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = evaluation.constraints[static_cast<size_t>(i)].value;
    for (const ContinuedRow& row : evaluation.continued) values[row.constraint] = row.value;
    return values;
}

MatrixX search_jacobian(const DesignEvaluation& evaluation) {
    MatrixX jacobian = evaluation.jacobian;
    for (const ContinuedRow& row : evaluation.continued) jacobian.row(row.constraint) = row.gradient.transpose();
    return jacobian;
}

std::string remark(const DesignEvaluation& evaluation, size_t constraint) {
    std::string text = evaluation.constraints[constraint].fault;
    for (const ContinuedRow& row : evaluation.continued)
        if (row.constraint == static_cast<int>(constraint)) text += (text.empty() ? "" : "; ") + row.reason;
    return text;
}

const RobustRow* robust_row(const DesignEvaluation& evaluation, bool of_objective, size_t index) {
    for (const RobustRow& row : evaluation.robust)
        if (row.of_objective == of_objective && row.index == static_cast<int>(index)) return &row;
    return nullptr;
}

std::string reserve_text(const DesignEvaluation& evaluation, bool of_objective, size_t index, const description::CountedUnit& unit) {
    const RobustRow* row = robust_row(evaluation, of_objective, index);
    if (row == nullptr) return {};
    const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 4); };
    std::string text = "as drawn " + amount(row->drawn.value);
    if (row->mean != 0) text += ", mean " + amount(row->drawn.value + row->mean);
    text += row->standard_deviation > 0 ? ", sigma " + amount(row->standard_deviation) : ", reserve " + amount(std::abs(row->reserve));
    if (row->is_at_kink) text += " (its derivatives jump close by: how the reserve changes is not known there)";
    return text;
}

std::string reserves_text(const description::Design& design) {
    if (!design.as_made) return {};
    const auto is_proven = [](const auto& over) { return over && over->kind == description::OverTolerances::Kind::proven; };
    const auto is_computed = [&](const auto& over) { return over && !is_proven(over); };
    const bool all_proven =
        std::none_of(design.constraints.begin(), design.constraints.end(),
                     [&](const auto& c) { return is_computed(c.bounds.over_tolerances); }) &&
        std::none_of(design.relations.begin(), design.relations.end(),
                     [&](const auto& r) { return is_computed(r.bounds.over_tolerances); }) &&
        std::none_of(design.objective.begin(), design.objective.end(), [&](const auto& t) { return is_computed(t.over_tolerances); });
    const bool some_proven = std::any_of(design.constraints.begin(), design.constraints.end(),
                                         [&](const auto& c) { return is_proven(c.bounds.over_tolerances); });
    if (all_proven) return "over all combinations of " + core::base::counted(design.as_made->tolerances.size(), "tolerance") + ": proven";
    return "over " + core::base::counted(design.as_made->tolerances.size(), "tolerance") +
           (some_proven ? ", to first order of the derivatives: computed, not proven, but for what is asked to be proven"
                        : ", to first order of the derivatives: computed, not proven");
}

EvaluateOptions for_several(EvaluateOptions options) {
    if (!options.should_stop) return options;
    options.should_stop = [ask = std::move(options.should_stop), mutex = std::make_shared<std::mutex>()] {
        const std::lock_guard lock(*mutex);
        return ask();
    };
    return options;
}

}  // namespace fettle::design::problem
