// SPDX-License-Identifier: MIT
#include "fettle/core/base/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace fettle::core::base {
namespace {

constexpr const char* allowed_units = "um, mm, cm, m, in, ft";

/// One unit is numerator/denominator metres, both whole: a length in um, mm or cm is rounded once only.
struct Unit {
    std::string_view name;
    double numerator, denominator;
};
constexpr std::array<Unit, 6> units{
    {{"um", 1, 1'000'000}, {"mm", 1, 1000}, {"cm", 1, 100}, {"m", 1, 1}, {"in", 254, 10'000}, {"ft", 3048, 10'000}}};

const Unit* find_unit(std::string_view name) {
    for (const Unit& unit : units) {
        if (unit.name == name) return &unit;
    }
    return nullptr;
}

Error unknown_unit(std::string_view unit, const std::string& where) {
    const std::string found = unit.empty() ? "a length without a unit" : "unknown unit \"" + std::string(unit) + "\"";
    return {ErrorCode::out_of_range, where, found + "; allowed units: " + allowed_units};
}

std::string_view without_spaces_in_front(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

}  // namespace

Result<double> metres_per_unit(std::string_view unit, const std::string& where) {
    const Unit* found = find_unit(unit);
    if (found == nullptr) return unknown_unit(unit, where);
    return found->numerator / found->denominator;
}

Result<double> parse_length(std::string_view text, const std::string& where) {
    std::string_view rest = without_spaces_in_front(text);
    if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
    double number = 0;
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (code == std::errc::invalid_argument) {
        return Error{
            ErrorCode::parse, where,
            "\"" + std::string(text) + "\" is not a length; write a number and a unit, such as 0.3mm (units: " + allowed_units + ")"};
    }
    if (code == std::errc::result_out_of_range || !std::isfinite(number)) {
        return Error{ErrorCode::not_finite, where, "\"" + std::string(text) + "\" is not a finite length"};
    }
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    std::string_view name = without_spaces_in_front(rest);
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
    const Unit* unit = find_unit(name);
    if (unit == nullptr) return unknown_unit(name, where);
    return number * unit->numerator / unit->denominator;
}

std::string format_length(double metres, std::string_view unit, int digits) {
    const Unit* found = find_unit(unit);
    FETTLE_ASSERT(found != nullptr && digits >= 1, "unknown unit " + std::string(unit));
    std::array<char, 64> text{};
    const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), metres * found->denominator / found->numerator,
                                           std::chars_format::general, std::min(digits, 17));
    FETTLE_ASSERT(code == std::errc(), "a number longer than its buffer");
    return std::string(text.data(), end) + " " + std::string(unit);
}

}  // namespace fettle::core::base
