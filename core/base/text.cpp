// SPDX-License-Identifier: MIT
#include "core/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdio>

namespace fettle::core::base {
namespace {

constexpr unsigned replaced = 0xFFFFFFFF;  // bytes that are no character

struct Character {
    unsigned code = replaced;
    std::size_t bytes = 1;
};

// RFC 3629, section 3: no longer form than needed, no surrogates, at most U+10FFFF.
Character character_at(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return {first, 1};
    const std::size_t bytes = first >= 0xF0 && first < 0xF8 ? 4 : first >= 0xE0 && first < 0xF0 ? 3 : first >= 0xC0 && first < 0xE0 ? 2 : 0;
    if (bytes == 0 || at + bytes > text.size()) return {};
    unsigned code = first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return {};
        code = code << 6U | (byte(i) & 0x3FU);
    }
    constexpr std::array<unsigned, 5> least{0, 0, 0x80, 0x800, 0x10000};
    if (code < least[bytes] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
    return {code, bytes};
}

bool is_control(unsigned code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

// Unicode 15, bidirectional formatting characters (UAX 9, 2.1 to 2.3), and the separators of lines: they would order or break the text
// beside them anew.
bool is_direction(unsigned code) {
    return code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

// \x1b for a byte's worth, \u202e for more.
std::string hexadecimal(unsigned code) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out = code < 0x100 ? "\\x" : "\\u";
    for (unsigned shift = code < 0x100 ? 8 : 16; shift > 0; shift -= 4) out += digits[code >> (shift - 4) & 15U];
    return out;
}

// Calls `kept(character's bytes, its code)` for each, `other(shown)` for what no terminal is to have.
template <class Kept, class Other>
void walk(std::string_view text, const Kept& kept, const Other& other) {
    for (std::size_t at = 0; at < text.size();) {
        const Character c = character_at(text, at);
        if (c.code == replaced) {
            other(hexadecimal(static_cast<unsigned char>(text[at])));
        } else if (is_direction(c.code) || (is_control(c.code) && c.code != '\n' && c.code != '\t')) {
            other(hexadecimal(c.code));
        } else {
            kept(text.substr(at, c.bytes), c.code);
        }
        at += c.bytes;
    }
}

// A spreadsheet makes a formula of a name that begins like this.
bool begins_formula(std::string_view word) {
    const std::size_t at = word.find_first_not_of('\'');
    return at != std::string_view::npos && std::string_view("=+-@\t\r").find(word[at]) != std::string_view::npos;
}

}  // namespace

std::string shown(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    walk(
        text, [&](std::string_view bytes, unsigned) { out += bytes; }, [&](const std::string& escaped) { out += escaped; });
    return out;
}

std::string shown_on_one_line(std::string_view text) {
    std::string out = shown(text);
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
    return out;
}

std::string name_fault(std::string_view name) {
    for (std::size_t at = 0; at < name.size();) {
        const Character c = character_at(name, at);
        if (c.code == replaced) return "is not UTF-8: byte " + hexadecimal(static_cast<unsigned char>(name[at]));
        if (is_control(c.code)) return "holds the control character " + hexadecimal(c.code);
        at += c.bytes;
    }
    return {};
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const Character c = character_at(text, at);
        if (c.code == replaced) return false;
        at += c.bytes;
    }
    return true;
}

std::string xml_text(std::string_view text) {
    std::string out;
    const auto keep = [&](std::string_view bytes, unsigned code) {
        switch (code) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\n':
                out += "&#10;";
                break;
            case '\t':
                out += "&#9;";
                break;
            case 0xFFFE:
            case 0xFFFF:
                out += "\xEF\xBF\xBD";
                break;
            default:
                out += bytes;
        }
    };
    walk(text, keep, [&](const std::string& escaped) { out += escaped; });
    return out;
}

std::string csv_cell(std::string_view word) {
    const std::string begun = begins_formula(word) ? "'" + std::string(word) : std::string(word);
    if (begun.find_first_of(",\"\n\r") == std::string::npos) return begun;
    std::string text = "\"";
    for (const char c : begun) text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + "\"";
}

std::string csv_word(std::string_view field) {
    if (field.starts_with('\'') && begins_formula(field)) field.remove_prefix(1);
    return std::string(field);
}

std::string percent(double share) {
    char text[32];
    const double hundredths = 100 * share;
    std::snprintf(text, sizeof text, std::abs(hundredths) < 10 || !(std::abs(hundredths) < 1e9) ? "%.2g%%" : "%.0f%%", hundredths);
    return text;
}

std::string counted(std::size_t count, const std::string& thing) { return std::to_string(count) + " " + thing + (count == 1 ? "" : "s"); }

std::string unit_name(Dimension dimension, double si) {
    constexpr double rounding = 1e-12;  // of products of units
    if (dimension == Dimension::number) return {};
    for (const Unit& unit : units())
        if (unit.dimension == dimension && std::abs(to_si(1, unit) - si) <= rounding * si) return std::string(unit.name);
    return {};
}

std::string length_text(double metres, double length_unit, int digits) {
    const std::string unit = unit_name(Dimension::length, length_unit);
    return format_length(metres, unit.empty() ? "m" : unit, digits);
}

bool matches_pattern(std::string_view pattern, std::string_view text) {
    std::size_t p = 0, t = 0, star = std::string_view::npos, taken = 0;  // by the last star
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            taken = t;
        } else if (p < pattern.size() && pattern[p] == text[t]) {
            ++p;
            ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++taken;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::string formatted(const char* format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, arguments);
    va_end(arguments);
    std::string text(static_cast<std::size_t>(std::max(0, length)) + 1, '\0');
    std::vsnprintf(text.data(), text.size(), format, again);
    va_end(again);
    text.pop_back();
    return text;
}

}  // namespace fettle::core::base
