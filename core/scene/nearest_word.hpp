// SPDX-License-Identifier: MIT
/// What was probably meant: for messages about unknown keys, names and commands.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::core::scene {

/// The entry of `known` nearest to `word` in edit distance (insert, delete, replace, swap neighbours; a change of case counts a quarter),
/// if it is near enough to be a slip: at most a third of the longer word's letters, at least 1.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace fettle::core::scene
