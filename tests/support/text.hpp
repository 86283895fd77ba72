// SPDX-License-Identifier: MIT
/// What tests ask of messages and files, and make of samples.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace fettle::tests::support {

/// Whether part stands somewhere in text.
inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// All of a file; empty if it cannot be read.
inline std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// `text` with the first `from` replaced; empty if it is not there, so that a test that replaces nothing fails.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return {};
    return text.replace(at, from.size(), to);
}

}  // namespace fettle::tests::support
