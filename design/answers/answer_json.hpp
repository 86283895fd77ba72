// SPDX-License-Identifier: MIT
/// The common parts of answers as JSON; keys and units are those of docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/clearance/clearance.hpp"
#include "design/description/design.hpp"
#include "design/optimisers/problem.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::answers {

/// A word of a command as it can be typed: in quotes where a shell would take it apart or change it.
std::string shell_word(const std::string& word);

nlohmann::ordered_json vector_json(const Vector3& v);

/// The number; null where it is infinite or none.
nlohmann::ordered_json finite_or_null(double x);

/// {a, b, minimum, lower, upper, status, time, point_a, point_b}
nlohmann::ordered_json pair_json(const core::clearance::PairClearance& pair, const std::vector<std::string>& body_names);

/// violated if one is; else undecided if one is; else clear.
core::clearance::PairStatus overall_status(const std::vector<core::clearance::PairClearance>& pairs);

/// {minimum, least, status, pairs}: the (smallest) required minimum, and the smallest proven bound.
nlohmann::ordered_json clearance_json(const std::vector<core::clearance::PairClearance>& pairs, const std::vector<std::string>& body_names);

/// Values by parameter name, in the parameters' own units.
nlohmann::ordered_json parameters_json(const description::Design& design, const VectorX& values);
/// Unit by parameter name.
nlohmann::ordered_json units_json(const description::Design& design);
/// Derivatives by parameter name, per unit of the parameter as the file has it.
nlohmann::ordered_json gradient_json(const description::Design& design, const VectorX& gradient);

/// Per relation {name, value, lower, upper, met, gradient}: SI, bounds null where there is none, gradients as gradient_json.
nlohmann::ordered_json relations_json(const description::Design& design, const optimisers::Rows& relations);

/// {value, reason} of a constraint that is continued, SI; null: it is not.
nlohmann::ordered_json continued_json(const problem::DesignEvaluation& evaluation, std::size_t constraint);

/// {kind, sigma, drawn, mean, standard_deviation, reserve, at_kink} of a constraint or term over the tolerances, SI; null: as drawn.
nlohmann::ordered_json over_tolerances_json(const description::Design& design, const problem::DesignEvaluation& evaluation,
                                            bool of_objective, std::size_t index);

std::vector<std::string> body_names(const core::model::Model& model);

/// The unit that `length_unit` [m] is: "mm"; "m" if it is none that we know.
std::string unit_name(double length_unit);

}  // namespace fettle::design::answers
