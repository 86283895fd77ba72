// SPDX-License-Identifier: MIT
/// What `gradient` answers: objective, constraints and their gradients, and with --check the audit of them. Keys: docs/interface.md.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/gradient_audit/difference_check.hpp"
#include "design/gradient_audit/gradient_warnings.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::answers {

/// The tie of a term of the objective or of a constraint; null where one branch alone attains its value.
const problem::Tie* tie_of(const problem::DesignEvaluation& evaluation, bool of_objective, std::size_t index);

/// One unit of a parameter, as the design has it, in SI. Contract: the design has a parameter of this name.
double parameter_unit(const description::Design& design, const std::string& parameter);

/// What is to be said of the design besides its numbers: of its motions (motion_warnings.hpp) and of its gradients.
gradient_audit::GradientWarnings gradient_warnings(const description::Design& design, const problem::DesignEvaluation& evaluation);

/// {status, message} of a design that cannot be evaluated.
nlohmann::ordered_json not_evaluated_json(const problem::DesignEvaluation& evaluation);

/// Values and gradients of a design that has them.
nlohmann::ordered_json values_json(const description::Design& design, const problem::DesignEvaluation& evaluation);

/// What --check adds.
/// @param limit  The limit of the verdict (check_faults.hpp). Contract: > 0
nlohmann::ordered_json check_json(const description::Design& design, const gradient_audit::CheckReport& report, double limit);

}  // namespace fettle::design::answers
