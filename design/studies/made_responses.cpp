// SPDX-License-Identifier: MIT
#include "design/studies/made_responses.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

namespace fettle::design::studies {

namespace {

using description::Design;
using problem::DesignEvaluation;
using Kind = AskedNumber::Kind;

VectorX values_of(const DesignEvaluation& evaluation) {
    VectorX y(1 + count_of(evaluation.constraints) + evaluation.relations.values.size());
    y[0] = evaluation.objective;
    for (int i = 0; i < count_of(evaluation.constraints); ++i) y[1 + i] = evaluation.constraints[i].value;
    y.tail(evaluation.relations.values.size()) = evaluation.relations.values;
    return y;
}

bool is_met(const Design& design, const AskedNumber& number, const DesignEvaluation& evaluation) {
    switch (number.kind) {
        case Kind::constraint:
            return violation(number.bounds, evaluation.constraints[number.index]) == 0;
        case Kind::relation:
            return violation(design.relations[number.index], evaluation.relations.values[number.index]) == 0;
        case Kind::objective:
            break;
    }
    return true;
}

}  // namespace

bool has_bounds(const AskedNumber& number) { return std::isfinite(number.bounds.lower) || std::isfinite(number.bounds.upper); }

std::vector<AskedNumber> asked_numbers(const Design& design) {
    std::vector<AskedNumber> out{{"objective", Kind::objective, 0, {}}};
    for (int i = 0; i < count_of(design.constraints); ++i)
        out.push_back({design.constraints[i].name, Kind::constraint, i, design.constraints[i].bounds});
    for (int i = 0; i < count_of(design.relations); ++i)
        out.push_back({design.relations[i].name, Kind::relation, i, design.relations[i].bounds});
    return out;
}

bool MadeEvaluation::met_all() const {
    return std::all_of(met.begin(), met.end(), [](bool each) { return each; });
}

MadeResponses::MadeResponses(const problem::DesignProblem& problem, const std::vector<description::Tolerance>& tolerances,
                             std::function<bool()> should_stop, std::function<void()> on_simulation)
    : problem_(problem),
      tolerances_(tolerances),
      numbers_(asked_numbers(problem.design())),
      should_stop_(std::move(should_stop)),
      on_simulation_(std::move(on_simulation)) {}

DesignEvaluation MadeResponses::simulate(const VectorX& deviations, bool gradients, bool balance) const {
    static std::mutex mutex;
    problem::EvaluateOptions options;
    options.gradients = gradients;
    options.balance = balance;
    options.should_stop = should_stop_;
    DesignEvaluation out = problem_.evaluate(with_deviations(design(), tolerances_, deviations), options);
    const std::lock_guard lock(mutex);
    if (on_simulation_) on_simulation_();
    return out;
}

MadeEvaluation MadeResponses::evaluate(const VectorX& deviations, bool gradients) const {
    return measured(simulate(deviations, gradients), gradients);
}

MadeEvaluation MadeResponses::measured(const DesignEvaluation& evaluation, bool gradients) const {
    MadeEvaluation out;
    out.usable = evaluation.usable;
    out.interrupted = evaluation.interrupted;
    out.reason = evaluation.reason;
    if (!out.usable) return out;
    out.values = values_of(evaluation);
    for (const AskedNumber& number : numbers_) out.met.push_back(is_met(design(), number, evaluation));
    if (!gradients) return out;
    out.jacobian.resize(count_of(numbers_), count_of(tolerances_));
    for (int k = 0; k < count_of(tolerances_); ++k) {
        const int p = tolerances_[k].parameter;
        out.jacobian(0, k) = evaluation.gradient[p];
        out.jacobian.block(1, k, evaluation.jacobian.rows(), 1) = evaluation.jacobian.col(p);
        out.jacobian.block(1 + evaluation.jacobian.rows(), k, evaluation.relations.jacobian.rows(), 1) =
            evaluation.relations.jacobian.col(p);
    }
    return out;
}

}  // namespace fettle::design::studies
