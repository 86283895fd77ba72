// SPDX-License-Identifier: MIT
/// What values and gradients at one design say to him who is about to search from there, without a further simulation:
/// - quantities that no parameter moves (a stroke that ends at a joint's stop): a requirement of one that is violated stays so;
/// - gradients that are too steep to be followed, which hold for a tiny part of the parameters' ranges only, as of parts that rattle.
/// How far a gradient holds is measured by roughness.hpp, with simulations.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "design/description/design.hpp"

namespace fettle::design::gradient_audit {

/// By how much a value changes at most, by its gradient, as all parameters move over their whole ranges: sum_k |dq/dp_k| range_k.
double gradient_reach(const description::Design& design, const VectorX& gradient);

/// Is the constraint violated, and a search from where it has this value and gradient unlikely to meet it? So it is if gradient_reach is at
/// most a tenth of the violation.
bool is_out_of_reach(const description::Design& design, int constraint, double value, const VectorX& gradient);

/// Says that it is, with the numbers, what may hide the dependence, and the remedy. Contract: is_out_of_reach
std::string out_of_reach_text(const description::Design& design, int constraint, double value, const VectorX& gradient);

struct GradientWarnings {
    std::vector<std::string> warnings;  ///< a sentence each, with the place and what to do
    std::vector<std::string> notes;     ///< which quantities no parameter moves, though nothing is wrong with them here
};

/// @param values     The objective, then each constraint's value, SI (design_line.hpp, quantities_of). Contract: 1 + m.
/// @param gradients  The gradients of these, a row each, SI. Contract: (1 + m) x n.
GradientWarnings gradient_warnings(const description::Design& design, const VectorX& values, const MatrixX& gradients);

}  // namespace fettle::design::gradient_audit
