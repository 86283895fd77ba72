// SPDX-License-Identifier: MIT
#include "tests/fuzz/mutations.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "tests/support/text.hpp"

namespace fettle::tests::fuzz {
namespace {

constexpr std::size_t largest = 1 << 16;

constexpr std::array<std::string_view, 30> odd_words = {
    "0",    "-1",          "1e308",      "-1e308",      "1e-320",     "nan",
    "inf",  "2147483647",  "2147483648", "-2147483648", "4294967295", "18446744073709551616",
    "null", "true",        "\"\"",       "[]",          "{}",         "\"0.3mm\"",
    "1.5",  "99999999999", "0.1e",       "\"..\"",      "\xff\xfe",   "\\u0000",
    "1e9",  "1e-9",        "1e30",       "1e-300",      "1e15",       "1e-15"};
constexpr std::array<std::uint32_t, 8> odd_integers = {0, 1, 0x7f, 0xff, 0x7fff, 0x7fffffff, 0x80000000, 0xffffffff};

bool is_of_number(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+' || c == 'e'; }
bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::vector<std::string> samples(const std::string& name) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FETTLE_SOURCE_DIR) / "tests/fuzz/corpus" / name))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::string> out;
    for (const auto& file : files) out.push_back(support::contents(file));
    return out;
}

std::string Mutator::next() {
    std::string text = samples_[below(samples_.size())];
    const std::size_t changes = 1 + below(below(4) == 0 ? 16 : 3);
    for (std::size_t i = 0; i < changes; ++i) change(text);
    if (text.size() > largest) text.resize(largest);
    return text;
}

void Mutator::change(std::string& text) {
    const std::size_t at = below(text.size());
    switch (below(12)) {
        case 0:
            if (!text.empty()) text[at] = static_cast<char>(random_());
            return;
        case 1:
            if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
            return;
        case 2:
            text.insert(at, 1 + below(4), static_cast<char>(random_()));
            return;
        case 3:
            text.erase(at, 1 + below(below(4) == 0 ? text.size() : 8));
            return;
        case 4:
            text.resize(at);
            return;
        case 5: {
            const std::uint32_t value = odd_integers[below(odd_integers.size())];
            if (text.size() >= sizeof value) std::memcpy(&text[below(text.size() - sizeof value + 1)], &value, sizeof value);
            return;
        }
        case 6:
            return repeat_block(text);
        case 7:
            return nest(text);
        case 8:
            return splice(text);
        case 9:
            return replace_word(text);
        default:
            return replace_number(text);
    }
}

void Mutator::replace_number(std::string& text) {
    const auto from = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(below(text.size())), text.end(), is_of_number);
    const auto to = std::find_if_not(from, text.end(), is_of_number);
    const std::string_view word = odd_words[below(odd_words.size())];
    text.replace(from, to, word.begin(), word.end());
}

/// A word takes the place of another of the same text.
void Mutator::replace_word(std::string& text) {
    const auto word_from = [&](std::size_t start) {
        const auto from = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(start), text.end(), is_of_word);
        return std::pair{from, std::find_if_not(from, text.end(), is_of_word)};
    };
    const auto [from, to] = word_from(below(text.size()));
    const std::string word(from, to);
    const auto [other_from, other_to] = word_from(below(text.size()));
    text.replace(other_from, other_to, word);
}

void Mutator::repeat_block(std::string& text) {
    const std::size_t at = below(text.size());
    const std::string block = text.substr(at, 1 + below(200));
    for (std::size_t i = 1 + below(below(8) == 0 ? 200 : 3); i-- > 0 && text.size() < largest;) text.insert(at, block);
}

void Mutator::nest(std::string& text) {
    static constexpr std::array<std::array<std::string_view, 2>, 5> pairs = {
        {{"[", "]"}, {"{\"a\":", "}"}, {"(", ")"}, {"<object id=\"9\">", "</object>"}, {"-", ""}}};
    const auto& [open, close] = pairs[below(pairs.size())];
    const std::size_t depth = 1 + below(below(4) == 0 ? 3000 : 5), at = below(text.size());
    std::string before, after;
    for (std::size_t i = 0; i < depth; ++i) {
        before += open;
        after += close;
    }
    text.insert(at + below(std::min<std::size_t>(20, text.size() - at + 1)), after);
    text.insert(at, before);
}

void Mutator::splice(std::string& text) {
    const std::string& other = samples_[below(samples_.size())];
    const std::size_t from = below(other.size());
    text.replace(below(text.size()), below(40), other.substr(from, 1 + below(200)));
}

}  // namespace fettle::tests::fuzz
