// SPDX-License-Identifier: MIT
#include "design/reading/scenario_choice.hpp"

#include <algorithm>
#include <optional>

#include "design/quantities/in_scenario.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;

constexpr std::string_view several[] = {"all", "mean", worst_scenario};

std::optional<std::string> chosen(const JsonNode& entry, const ScenarioNames& scenarios, bool one) {
    const JsonNode node = entry["scenario"];
    if (!node.exists()) return std::nullopt;
    if (scenarios.names.empty()) {
        node.fail(ErrorCode::inconsistent, "the design has no `scenarios`");
        return std::nullopt;
    }
    std::vector<std::string_view> known(scenarios.names.begin(), scenarios.names.end());
    if (!one) known.insert(known.end(), std::begin(several), std::end(several));
    return node.choice(known);
}

int number_of(const std::string& name, const ScenarioNames& scenarios) {
    return static_cast<int>(std::find(scenarios.names.begin(), scenarios.names.end(), name) - scenarios.names.begin());
}

}  // namespace

bool is_scenario_word(std::string_view name) { return std::find(std::begin(several), std::end(several), name) != std::end(several); }

std::vector<ScenarioQuantity> in_scenarios(const JsonNode& entry, const std::shared_ptr<const description::Quantity>& quantity,
                                           const ScenarioNames& scenarios) {
    const std::optional<std::string> choice = chosen(entry, scenarios, false);
    if (scenarios.names.empty() || quantities::has_scenario(*quantity)) return {{quantity, ""}};
    if (choice && !is_scenario_word(*choice))
        return {{quantities::in_scenario(quantity, number_of(*choice, scenarios)), " [" + *choice + "]"}};
    if (!choice && quantity->is_at_rest() && !scenarios.parts_differ) return {{quantities::in_scenario(quantity, 0), ""}};
    std::vector<ScenarioQuantity> all;
    for (const std::string& name : scenarios.names) all.push_back({quantities::in_scenario(quantity, count_of(all)), " [" + name + "]"});
    return all;
}

std::shared_ptr<const description::Quantity> in_named_scenario(const JsonNode& entry,
                                                               const std::shared_ptr<const description::Quantity>& quantity,
                                                               const ScenarioNames& scenarios) {
    const std::optional<std::string> choice = chosen(entry, scenarios, true);
    return choice ? quantities::in_scenario(quantity, number_of(*choice, scenarios)) : quantity;
}

}  // namespace fettle::design::reading
