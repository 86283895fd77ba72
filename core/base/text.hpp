// SPDX-License-Identifier: MIT
/// Words for messages, and text that others wrote as it stands in what we write: on a terminal, in XML, in a table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/units.hpp"

namespace fettle::core::base {

/// The strings, in their order, with ", " between them.
template <class Strings>
std::string joined(const Strings& strings) {
    std::string text;
    for (const auto& each : strings) (text += text.empty() ? "" : ", ") += each;
    return text;
}

/// As a terminal may have it: control characters but line feed and tab as "\\x1b", what is no UTF-8 as "\\xff", characters that turn the
/// direction of writing as "\\u202e". A name from a file cannot colour, move, turn or overwrite the text beside it.
std::string shown(std::string_view text);

/// The same on one line.
std::string shown_on_one_line(std::string_view text);

/// What makes this a name that cannot be taken: "holds the control character \\x1b", "is not UTF-8"; empty: nothing does.
std::string name_fault(std::string_view name);

/// Is all of it UTF-8?
bool is_utf8(std::string_view text);

/// Between tags and in quotes: what XML 1.0 does not have is shown, line feeds and tabs are character references.
std::string xml_text(std::string_view text);

/// A field of a CSV table: in quotes where commas, quotes or ends of lines are in it; begun with ' where a spreadsheet would take a name
/// that begins with = + - or @ for a formula.
std::string csv_cell(std::string_view word);

/// Without the ' that csv_cell began it with; quotes have been taken off before.
std::string csv_word(std::string_view field);

/// Is the text of this form? `*` stands for any letters, none included.
bool matches_pattern(std::string_view pattern, std::string_view text);

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// 0.0123 -> "1.2%", 1.234 -> "123%": two digits, and whole numbers from ten on.
std::string percent(double share);

/// 1, "step" -> "1 step"; 2, "step" -> "2 steps".
std::string counted(std::size_t count, const std::string& thing);

/// 1e-3 of lengths -> "mm": what so much of this dimension is called. Empty: it has no name, or is a plain number.
std::string unit_name(Dimension dimension, double si);

/// A length in the unit of which one is `length_unit` metres, in metres where that has no name: 6.8e-5, 1e-3 -> "0.068 mm".
std::string length_text(double metres, double length_unit, int digits = 3);

}  // namespace fettle::core::base
