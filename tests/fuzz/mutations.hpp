// SPDX-License-Identifier: MIT
/// Damages samples as hostile and broken files are damaged: bytes, words, numbers, lines and blocks, brackets within brackets, and pieces
/// of other samples. The same seed makes the same bytes on every machine.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fettle::tests::fuzz {

/// What stands in corpus/NAME, sorted by file name.
std::vector<std::string> samples(const std::string& name);

class Mutator {
public:
    /// Contract: there is a sample.
    Mutator(std::vector<std::string> samples, std::uint64_t seed) : samples_(std::move(samples)), random_(seed) {}

    /// The next input; at most 64 kB.
    std::string next();

private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }
    void change(std::string& text);
    void replace_number(std::string& text);
    void repeat_block(std::string& text);
    void nest(std::string& text);
    void splice(std::string& text);
    void replace_word(std::string& text);

    std::vector<std::string> samples_;
    std::mt19937_64 random_;
};

}  // namespace fettle::tests::fuzz
