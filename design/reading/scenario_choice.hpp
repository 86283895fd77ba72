// SPDX-License-Identifier: MIT
/// Which of a design's scenarios a term, constraint or named quantity of its file is about: `"scenario": "upside down"`, "all",
/// "mean", "worst".
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::reading {

/// What reading quantities needs to know of the scenarios.
struct ScenarioNames {
    std::vector<std::string> names;
    bool parts_differ = false;  ///< one sets something of the parts, or where they are at the start
};

/// The one that is worst, wherever that is.
inline constexpr std::string_view worst_scenario = "worst";

/// Words for several scenarios, which none can be called.
bool is_scenario_word(std::string_view name);

/// A quantity in one scenario; `suffix` tells it from the others of its entry: " [upside down]".
struct ScenarioQuantity {
    std::shared_ptr<const description::Quantity> quantity;
    std::string suffix;
};

/// One for each scenario that the entry's `scenario` chooses; if it says nothing, or a word for several, for all: but one alone of a
/// quantity that is the same in all, and of an expression whose quantities have their scenarios already. Faults: no such scenario.
std::vector<ScenarioQuantity> in_scenarios(const core::files::JsonNode& entry, const std::shared_ptr<const description::Quantity>& quantity,
                                           const ScenarioNames& scenarios);

/// The quantity in the scenario that its entry in `quantities` names; left as it is where it names none.
std::shared_ptr<const description::Quantity> in_named_scenario(const core::files::JsonNode& entry,
                                                               const std::shared_ptr<const description::Quantity>& quantity,
                                                               const ScenarioNames& scenarios);

}  // namespace fettle::design::reading
