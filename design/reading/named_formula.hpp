// SPDX-License-Identifier: MIT
/// Formulas of a design's named quantities, its parameters and variables. Part of quantity_reader.hpp.
#pragma once

#include <functional>
#include <memory>

#include "core/files/json_document.hpp"
#include "design/quantities/step_expression.hpp"
#include "design/reading/read_context.hpp"

namespace fettle::design::reading {

/// A formula of the numbers that quantities come to. @return nothing if something was wrong; the faults are the node's.
std::shared_ptr<const description::Quantity> read_formula(const core::files::JsonNode& text, const ReadContext& context);

/// A formula of what they are over the steps, likewise.
/// @param reduction_of  What is made of the numbers of this dimension.
std::shared_ptr<const quantities::StepSeries> read_step_formula(const core::files::JsonNode& text, const ReadContext& context,
                                                                const std::function<quantities::Reduction(Dimension)>& reduction_of);

}  // namespace fettle::design::reading
