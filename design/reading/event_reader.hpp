// SPDX-License-Identifier: MIT
/// Quantities that are about when something happens, and those of several named quantities. Part of quantity_reader.hpp.
#pragma once

#include <memory>

#include "core/files/json_document.hpp"
#include "design/quantities/step_series.hpp"
#include "design/reading/read_context.hpp"

namespace fettle::design::reading {

/// What each instant has a number of: a quantity of the design's `quantities` by its name, or a formula of such over the steps.
/// @param derivative  In time, of its numbers. @return nothing if something was wrong; the faults are the node's.
std::shared_ptr<const quantities::StepSeries> read_series(const core::files::JsonNode& node, const ReadContext& context, int derivative);

/// A quantity of the design's `quantities` by its name, or a formula of such.
std::shared_ptr<const description::Quantity> read_named(const core::files::JsonNode& node, const ReadContext& context);

std::shared_ptr<const description::Quantity> read_event_time(const core::files::JsonNode& node, const ReadContext& context);
std::shared_ptr<const description::Quantity> read_value_at(const core::files::JsonNode& node, const ReadContext& context);
std::shared_ptr<const description::Quantity> read_time_share(const core::files::JsonNode& node, const ReadContext& context);
/// The largest, or the least, of several.
std::shared_ptr<const description::Quantity> read_largest(const core::files::JsonNode& node, const ReadContext& context);
std::shared_ptr<const description::Quantity> read_least(const core::files::JsonNode& node, const ReadContext& context);

}  // namespace fettle::design::reading
