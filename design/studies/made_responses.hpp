// SPDX-License-Identifier: MIT
/// A design as made: the numbers that it asks for, as functions of the deviations of its tolerances, y(d). Every evaluation is a whole
/// simulation.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/description/tolerance.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::studies {

/// A number that a design asks for: its objective, a constraint, a relation.
struct AskedNumber {
    enum class Kind { objective, constraint, relation };
    std::string name;
    Kind kind = Kind::constraint;
    int index = 0;               ///< among those of its kind
    description::Bounds bounds;  ///< the objective has none
};
bool has_bounds(const AskedNumber& number);
/// The objective, the constraints, the relations.
std::vector<AskedNumber> asked_numbers(const description::Design& design);

struct MadeEvaluation {
    bool usable = false, interrupted = false;
    std::string reason;     ///< why it is not usable
    VectorX values;         ///< per number, SI
    MatrixX jacobian;       ///< numbers x tolerances; empty unless asked for
    std::vector<bool> met;  ///< per number, by what is proven of it where it is; the objective is always
    bool met_all() const;
};

class MadeResponses {
public:
    /// @param problem, tolerances  Of the design as made (description/tolerance.hpp). Contract: both outlive this.
    /// @param on_simulation  After each, from one thread at a time; optional.
    MadeResponses(const problem::DesignProblem& problem, const std::vector<description::Tolerance>& tolerances,
                  std::function<bool()> should_stop = {}, std::function<void()> on_simulation = {});

    const description::Design& design() const { return problem_.design(); }
    const std::vector<description::Tolerance>& tolerances() const { return tolerances_; }
    const std::vector<AskedNumber>& numbers() const { return numbers_; }
    bool should_stop() const { return should_stop_ && should_stop_(); }

    /// May be called from several threads at once.
    MadeEvaluation evaluate(const VectorX& deviations, bool gradients) const;
    /// The simulations themselves. @param balance  as in EvaluateOptions
    problem::DesignEvaluation simulate(const VectorX& deviations, bool gradients, bool balance = false) const;
    /// What `evaluate` takes from them.
    MadeEvaluation measured(const problem::DesignEvaluation& evaluation, bool gradients) const;

private:
    const problem::DesignProblem& problem_;
    const std::vector<description::Tolerance>& tolerances_;
    const std::vector<AskedNumber> numbers_;
    std::function<bool()> should_stop_;
    std::function<void()> on_simulation_;
};

}  // namespace fettle::design::studies
