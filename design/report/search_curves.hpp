// SPDX-License-Identifier: MIT
/// How an optimisation went, from its history (design/studies/history.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/description/design.hpp"

namespace fettle::design::report {

/// {objective, violation: lists by evaluation, null of those that failed; own: was it of the design's own model; model: its name;
/// parameters: per parameter the list of its shares of the range between its bounds; constraints: list of {name, spare: by evaluation, how
/// far within its bounds, in its unit, null of those that failed}}. Lines that cannot be read (a last one that was cut off) are left out.
/// @param text  of history.jsonl.
nlohmann::ordered_json search_curves(const std::string& text, const description::Design& design);

}  // namespace fettle::design::report
