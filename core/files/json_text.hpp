// SPDX-License-Identifier: MIT
/// Checks of a text before anything reads it as JSON. json_document.hpp applies them to what it reads; whoever gives a text to the JSON
/// library directly asks here: the library takes a NUL for the end of the text, whatever follows, and takes lists in lists without end,
/// which copying and writing then go into by recursion.
#pragma once

#include <cstddef>
#include <string_view>

namespace fettle::core::files {

/// Lists and objects in one another, at most. Files of ours need a dozen.
inline constexpr std::size_t deepest_json = 100;

/// Is there no NUL in it, and nothing nested deeper than deepest_json?
bool is_safe_json_text(std::string_view text);

}  // namespace fettle::core::files
