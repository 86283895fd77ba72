// SPDX-License-Identifier: MIT
/// What was probably meant: for messages about unknown keys, names and commands.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::core::files {

/// The entry of `known` nearest to `word` in edit distance (insert, delete, replace, swap neighbours; a change of case counts a quarter),
/// if it is near enough to be a slip: at most a third of the longer word's letters, at least 1.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string_view>& known);

/// The end of such a message: `did you mean "crank"?`, or, if nothing is near, `there are block, crank, rod` (`there are none`).
/// @param quote  put round the word that was found.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known, char quote = '"');

}  // namespace fettle::core::files
