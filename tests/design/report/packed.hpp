// SPDX-License-Identifier: MIT
/// Reading a report's page back.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fettle::tests::report_support {

/// The reverse of report::packed(), written for itself.
template <class Number, class Json>
std::vector<Number> unpacked(const Json& value, const char* key) {
    const std::string text = value.at(key).template get<std::string>(),
                      digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int held = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c));
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 255);
    }
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    if (!numbers.empty())
        std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));  // of a machine with the lowest byte first
    return numbers;
}

/// What stands in a page between its script element's ends.
inline nlohmann::ordered_json data_of(const std::string& page) {
    const std::string begin = "id=\"fettle-report\">";
    const std::size_t at = page.find(begin) + begin.size();
    return nlohmann::ordered_json::parse(page.substr(at, page.find("</script>", at) - at));
}

}  // namespace fettle::tests::report_support
