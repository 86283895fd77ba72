// SPDX-License-Identifier: MIT
/// Where in a text of JSON a value stands.
#pragma once

#include <string_view>

namespace fettle::core::files {

/// The line, counted from 1, of the key or the entry that a JSON pointer ("/bodies/0/mass") leads to. Where the text has no such value, or
/// is no JSON from there on: that of the last one on the way that it has.
int line_of_pointer(std::string_view text, std::string_view pointer);

}  // namespace fettle::core::files
