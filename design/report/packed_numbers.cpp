// SPDX-License-Identifier: MIT
#include "design/report/packed_numbers.hpp"

#include <bit>
#include <nlohmann/json.hpp>

#include "design/exports/base64.hpp"

namespace fettle::design::report {

namespace {

template <class Word, class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    std::string bytes;
    bytes.reserve(numbers.size() * sizeof(Word));
    for (const Number number : numbers) {
        auto word = std::bit_cast<Word>(number);
        for (std::size_t i = 0; i < sizeof(Word); ++i, word >>= 8) bytes += static_cast<char>(word & 255);
    }
    return bytes;
}

}  // namespace

nlohmann::ordered_json packed(const std::vector<float>& numbers) { return {{"f32", exports::base64(bytes_of<std::uint32_t>(numbers))}}; }
nlohmann::ordered_json packed(const std::vector<double>& numbers) { return {{"f64", exports::base64(bytes_of<std::uint64_t>(numbers))}}; }
nlohmann::ordered_json packed(const std::vector<std::uint32_t>& numbers) {
    return {{"u32", exports::base64(bytes_of<std::uint32_t>(numbers))}};
}

}  // namespace fettle::design::report
