// SPDX-License-Identifier: MIT
#include "fettle/design/report/packed_numbers.hpp"

#include <bit>
#include <nlohmann/json.hpp>

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

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

nlohmann::ordered_json packed(const std::vector<float>& numbers) { return {{"f32", base64(bytes_of<std::uint32_t>(numbers))}}; }
nlohmann::ordered_json packed(const std::vector<double>& numbers) { return {{"f64", base64(bytes_of<std::uint64_t>(numbers))}}; }
nlohmann::ordered_json packed(const std::vector<std::uint32_t>& numbers) { return {{"u32", base64(bytes_of<std::uint32_t>(numbers))}}; }

}  // namespace fettle::design::report
