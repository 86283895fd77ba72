// SPDX-License-Identifier: MIT
/// A formula of the design's parameters inside of a quantity, such as a target that moves with them: its value, and its part of the
/// gradient.
#pragma once

#include "fettle/core/expression/formula.hpp"
#include "fettle/design/description/quantity.hpp"

namespace fettle::design::quantities {

/// The value at the simulated design's parameters. Contract: its inputs are among them (problem/check_design.hpp looks).
double value_at(const core::expression::Formula& formula, const description::Simulated& simulated);

/// Adds scale * d(parameter of that name) to the seeds.
void add_parameter_seed(const std::string& parameter, const description::Simulated& simulated, double scale, description::Seeds& seeds);

/// Adds scale * d(value_at) to the seeds.
void add_formula_seed(const core::expression::Formula& formula, const description::Simulated& simulated, double scale,
                      description::Seeds& seeds);

}  // namespace fettle::design::quantities
