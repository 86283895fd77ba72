// SPDX-License-Identifier: MIT
#include "core/files/json_writer.hpp"

#include <charconv>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"

namespace fettle::core::files {

void JsonWriter::number(double x) {
    FETTLE_ASSERT(std::isfinite(x), "a number that is not finite has no JSON");
    char buffer[32];
    const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
    FETTLE_ASSERT(code == std::errc(), "a number longer than its buffer");
    const std::string_view digits(buffer, static_cast<std::size_t>(end - buffer));
    text += digits == "-0" ? "-0.0" : digits;  // readers take "-0" for a whole number, which has no sign
}

void JsonWriter::string(std::string_view value) {
    if (!base::is_utf8(value)) return string(base::shown(value));
    text += '"';
    for (const char c : value) {
        if (c == '"' || c == '\\') text += '\\';
        if (static_cast<unsigned char>(c) < 0x20) {
            text += "\\u00";
            text += "0123456789abcdef"[c >> 4];
            text += "0123456789abcdef"[c & 15];
        } else {
            text += c;
        }
    }
    text += '"';
}

void JsonWriter::key(std::string_view name) {
    if (text.back() != '{') text += ",\n ";
    string(name);
    text += ": ";
}

}  // namespace fettle::core::files
