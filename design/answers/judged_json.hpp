// SPDX-License-Identifier: MIT
/// What is told of one judged design as JSON: the same by `fettle optimise` of the design that it found, and by `fettle check`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "design/description/design.hpp"
#include "design/studies/judged_design.hpp"

namespace fettle::design::answers {

/// Adds `by_models`, `play_not_compared` (where there is something to say), `resolution` (null: not measured), `terms`, `constraints`,
/// `relations` and `clearance`: docs/interface.md.
void add_judged(const description::Design& design, const studies::JudgedDesign& judged, nlohmann::ordered_json& json);

}  // namespace fettle::design::answers
