// SPDX-License-Identifier: MIT
#include "design/reading/over_tolerances_reader.hpp"

namespace fettle::design::reading {

using core::files::JsonNode;
using description::OverTolerances;

std::optional<OverTolerances> read_over_tolerances(const JsonNode& node, const std::optional<OverTolerances>& otherwise,
                                                   bool is_clearance) {
    if (!node.exists()) return otherwise;
    if (node.is_string()) {
        std::vector<std::string_view> words{"as_drawn", "worst_case"};
        if (is_clearance) words.emplace_back("proven");
        const auto word = node.choice(words);
        if (word && *word == "worst_case") return OverTolerances{OverTolerances::Kind::worst_case, 0};
        if (word && *word == "proven") return OverTolerances{OverTolerances::Kind::proven, 0};
        return std::nullopt;
    }
    if (!node.is_object()) {
        node.fail(ErrorCode::wrong_type, "this is {\"sigma\": 3}, \"worst_case\", of a clearance \"proven\", or \"as_drawn\"");
        return std::nullopt;
    }
    node.allow_keys({"sigma"});
    const auto sigmas = node.require("sigma").number(core::files::not_negative);
    if (!sigmas) return std::nullopt;
    return OverTolerances{OverTolerances::Kind::sigma, *sigmas};
}

std::optional<OverTolerances> read_over_tolerances_of(const JsonNode& requirement, const description::Bounds& bounds,
                                                      const std::optional<OverTolerances>& otherwise, bool is_clearance) {
    const auto over = read_over_tolerances(requirement["over_tolerances"], otherwise, is_clearance);
    if (!over || bounds.lower != bounds.upper) return over;
    requirement.fail(ErrorCode::inconsistent,
                     "it asks for one number exactly, which nothing has over its tolerances: give it a lower and an upper bound, or say "
                     "\"over_tolerances\": \"as_drawn\"");
    return std::nullopt;
}

}  // namespace fettle::design::reading
