// SPDX-License-Identifier: MIT
#include "core/files/text_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <system_error>

namespace fettle::core::files {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

void split(std::string_view line, std::vector<std::string_view>& words) {
    for (std::size_t first = 0; first < line.size();) {
        while (first < line.size() && is_blank(line[first])) ++first;
        std::size_t last = first;
        while (last < line.size() && !is_blank(line[last])) ++last;
        if (last > first) words.push_back(line.substr(first, last - first));
        first = last;
    }
}

std::string_view without_plus(std::string_view word) {
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
    return plus ? word.substr(1) : word;
}

}  // namespace

bool TextLines::next(std::vector<std::string_view>& words) {
    words.clear();
    bool continued = false;
    while (!rest_.empty() && (words.empty() || continued)) {
        const std::size_t length = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, length);
        rest_.remove_prefix(std::min(length + 1, rest_.size()));
        ++lines_read_;
        if (!continued) line_number_ = lines_read_;
        line = line.substr(0, line.find('#'));
        while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
        continued = !line.empty() && line.back() == '\\';
        if (continued) line.remove_suffix(1);
        split(line, words);
    }
    return !words.empty();
}

std::string_view TextWords::next() {
    for (; at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '\n'); ++at_)
        if (text_[at_] == '\n') ++line_number_;
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') ++at_;
    return text_.substr(first, at_ - first);
}

std::string_view TextWords::rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view rest = text_.substr(at_, end - at_);
    at_ = end;
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
}

std::optional<double> parsed_number(std::string_view word) {
    word = without_plus(word);
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, code] = std::from_chars(word.data(), end, value);
    if (stop != end || code == std::errc::invalid_argument) return std::nullopt;
    // Too large or too small for a double: strtod says infinity or the nearest subnormal, from_chars says nothing.
    if (code == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
    return value;
}

std::optional<int> parsed_integer(std::string_view word) {
    word = without_plus(word);
    int value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, code] = std::from_chars(word.data(), end, value);
    if (stop != end || code != std::errc()) return std::nullopt;
    return value;
}

}  // namespace fettle::core::files
