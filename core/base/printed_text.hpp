// SPDX-License-Identifier: MIT
/// Text as a program may print it, whoever wrote what stands in it.
#pragma once

#include <string>
#include <string_view>

namespace fettle::core::base {

/// shown() of text.hpp, for a terminal; and where a runner of checks reads along no line is one of its commands. GitHub's obeys
/// "::error::x" behind any blanks at the start of a line, and "##[error]x" anywhere; their first character is shown as "\\x3a", "\\x23".
std::string printed(std::string_view text);

}  // namespace fettle::core::base
