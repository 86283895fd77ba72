// SPDX-License-Identifier: MIT
#include "core/part_files/shape_reader.hpp"

namespace fettle::core::part_files {

using base::ErrorCode;
using files::JsonNode;

Error out_of_reach(const std::string& feature, const std::string& where) {
    return {ErrorCode::not_finite, where,
            (feature.empty() ? "this" : "`" + feature + "`") +
                " has points that are no finite numbers, or farther away than 1e30 m: a dimension of it is too large, or too small to "
                "divide by"};
}

std::optional<std::string> verb_of(const JsonNode& node, const std::vector<std::string_view>& known, std::string_view what) {
    std::vector<std::string> found;
    for (const std::string_view verb : known)
        if (node[verb].exists()) found.emplace_back(verb);
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
        node.fail(ErrorCode::inconsistent,
                  "one thing at a time: this has `" + found[0] + "` and `" + found[1] + "`; put one into the other");
        return std::nullopt;
    }
    std::string near;
    for (const auto& [key, value] : node.members()) {
        const auto nearest = key.starts_with('#') ? std::nullopt : files::nearest_word(key, known);
        if (nearest) near = "; did you mean `" + *nearest + "`, where `" + key + "` stands?";
    }
    std::string all;
    for (const std::string_view verb : known) all += (all.empty() ? "" : ", ") + std::string(verb);
    node.fail(ErrorCode::missing_key, std::string(what) + " has one of the keys " + all + near);
    return std::nullopt;
}

}  // namespace fettle::core::part_files
