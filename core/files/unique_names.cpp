// SPDX-License-Identifier: MIT
#include "core/files/unique_names.hpp"

#include <algorithm>
#include <cctype>

namespace fettle::core::files {

namespace {

constexpr std::size_t longest_stem = 200;  // bytes: file systems take 255 with what is added to it

}  // namespace

std::string UniqueNames::unique(const std::string& name) {
    const auto key = [&](std::string text) {
        if (one_case_) std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
        return text;
    };
    if (given_.insert(key(name)).second) return name;
    int& number = last_.try_emplace(key(name), 1).first->second;
    std::string numbered;
    do numbered = name + between_ + std::to_string(++number);
    while (!given_.insert(key(numbered)).second);
    return numbered;
}

std::string file_stem(std::string name) {
    for (char& c : name) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.' || c == '+' || c == ' ';
        if (!plain && static_cast<unsigned char>(c) < 0x80) c = '_';
    }
    if (name.size() > longest_stem) {  // not within a character
        std::size_t end = longest_stem;
        while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80) --end;
        name.resize(end);
    }
    if (name.empty() || name[0] == '.') name.insert(0, "_");
    return name;
}

}  // namespace fettle::core::files
