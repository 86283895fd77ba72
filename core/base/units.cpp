// SPDX-License-Identifier: MIT
#include "core/base/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <system_error>

#include "core/base/limits.hpp"

namespace fettle::core::base {
namespace {

constexpr double degree = std::numbers::pi / 180, turn_per_minute = std::numbers::pi / 30;

constexpr std::array table{Unit{"1", Dimension::number, 1, 1},
                           Unit{"um", Dimension::length, 1, 1'000'000},
                           Unit{"mm", Dimension::length, 1, 1000},
                           Unit{"cm", Dimension::length, 1, 100},
                           Unit{"m", Dimension::length, 1, 1},
                           Unit{"in", Dimension::length, 254, 10'000},
                           Unit{"ft", Dimension::length, 3048, 10'000},
                           Unit{"mm^2", Dimension::area, 1, 1'000'000},
                           Unit{"cm^2", Dimension::area, 1, 10'000},
                           Unit{"m^2", Dimension::area, 1, 1},
                           Unit{"mm^3", Dimension::volume, 1, 1'000'000'000},
                           Unit{"cm^3", Dimension::volume, 1, 1'000'000},
                           Unit{"m^3", Dimension::volume, 1, 1},
                           Unit{"deg", Dimension::angle, degree, 1},
                           Unit{"rad", Dimension::angle, 1, 1},
                           Unit{"us", Dimension::time, 1, 1'000'000},
                           Unit{"ms", Dimension::time, 1, 1000},
                           Unit{"s", Dimension::time, 1, 1},
                           Unit{"min", Dimension::time, 60, 1},
                           Unit{"mg", Dimension::mass, 1, 1'000'000},
                           Unit{"g", Dimension::mass, 1, 1000},
                           Unit{"kg", Dimension::mass, 1, 1},
                           Unit{"oz", Dimension::mass, 28'349'523'125, 1e12},
                           Unit{"lb", Dimension::mass, 45'359'237, 1e8},
                           Unit{"mN", Dimension::force, 1, 1000},
                           Unit{"N", Dimension::force, 1, 1},
                           Unit{"kN", Dimension::force, 1000, 1},
                           Unit{"N mm", Dimension::torque, 1, 1000},
                           Unit{"N m", Dimension::torque, 1, 1},
                           Unit{"Nmm", Dimension::torque, 1, 1000},
                           Unit{"Nm", Dimension::torque, 1, 1},
                           Unit{"mJ", Dimension::energy, 1, 1000},
                           Unit{"J", Dimension::energy, 1, 1},
                           Unit{"mm/s", Dimension::speed, 1, 1000},
                           Unit{"cm/s", Dimension::speed, 1, 100},
                           Unit{"m/s", Dimension::speed, 1, 1},
                           Unit{"deg/s", Dimension::angular_speed, degree, 1},
                           Unit{"rad/s", Dimension::angular_speed, 1, 1},
                           Unit{"rpm", Dimension::angular_speed, turn_per_minute, 1},
                           Unit{"mm/s^2", Dimension::acceleration, 1, 1000},
                           Unit{"m/s^2", Dimension::acceleration, 1, 1},
                           Unit{"kg/m^3", Dimension::density, 1, 1},
                           Unit{"g/cm^3", Dimension::density, 1000, 1},
                           Unit{"N/m", Dimension::stiffness, 1, 1},
                           Unit{"N/mm", Dimension::stiffness, 1000, 1},
                           Unit{"N m/rad", Dimension::angular_stiffness, 1, 1},
                           Unit{"N mm/rad", Dimension::angular_stiffness, 1, 1000},
                           Unit{"N mm/deg", Dimension::angular_stiffness, 1, 1000 * degree},
                           Unit{"deg/s^2", Dimension::angular_acceleration, degree, 1},
                           Unit{"rad/s^2", Dimension::angular_acceleration, 1, 1},
                           Unit{"mW", Dimension::power, 1, 1000},
                           Unit{"W", Dimension::power, 1, 1},
                           Unit{"kW", Dimension::power, 1000, 1},
                           Unit{"N s", Dimension::impulse, 1, 1},
                           Unit{"N mm s", Dimension::angular_impulse, 1, 1000},
                           Unit{"N m s", Dimension::angular_impulse, 1, 1}};

std::string allowed_text(Dimension dimension) { return "allowed units: " + unit_names(dimension); }

std::string with_article(Dimension dimension) {
    const std::string_view name = dimension_name(dimension);
    return (std::string_view("aeiou").find(name.front()) == std::string_view::npos ? "a " : "an ") + std::string(name);
}

Result<Unit> unit_of(std::string_view name, Dimension dimension, const std::string& where) {
    if (name.empty() && dimension == Dimension::number) return Unit{};
    const Unit* found = find_unit(name);
    if (found != nullptr && found->dimension == dimension) return *found;
    if (found != nullptr) {
        return Error{ErrorCode::wrong_type, where,
                     "\"" + std::string(name) + "\" is a unit of " + std::string(dimension_name(found->dimension)) + ", " +
                         with_article(dimension) + " is expected; " + allowed_text(dimension)};
    }
    const std::string what = name.empty() ? with_article(dimension) + " without a unit" : "unknown unit \"" + std::string(name) + "\"";
    return Error{ErrorCode::out_of_range, where, what + "; " + allowed_text(dimension)};
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string example_of(Dimension dimension) {
    switch (dimension) {
        case Dimension::number:
            return "0.3";
        case Dimension::length:
            return "0.3mm";
        default:
            return "0.3 " + std::string(si_unit(dimension));
    }
}

}  // namespace

std::span<const Unit> units() { return table; }

const Unit* find_unit(std::string_view name) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Unit& unit) { return unit.name == name; });
    return found == table.end() ? nullptr : &*found;
}

std::string_view dimension_name(Dimension dimension) {
    constexpr std::array<std::string_view, 20> names{"number",
                                                     "length",
                                                     "area",
                                                     "volume",
                                                     "angle",
                                                     "time",
                                                     "mass",
                                                     "force",
                                                     "torque",
                                                     "energy",
                                                     "speed",
                                                     "angular speed",
                                                     "acceleration",
                                                     "density",
                                                     "stiffness",
                                                     "angular stiffness",
                                                     "angular acceleration",
                                                     "power",
                                                     "impulse",
                                                     "angular impulse"};
    return names.at(static_cast<std::size_t>(dimension));
}

std::string unit_names(Dimension dimension) {
    std::string names;
    for (const Unit& unit : table) {
        if (unit.dimension == dimension) names += (names.empty() ? "" : ", ") + std::string(unit.name);
    }
    return names;
}

std::string_view si_unit(Dimension dimension) {
    for (const Unit& unit : table) {
        if (unit.dimension == dimension && unit.numerator == 1 && unit.denominator == 1) return unit.name;
    }
    return "";
}

Result<double> si_per_unit(std::string_view unit, Dimension dimension, const std::string& where) {
    const Result<Unit> found = unit_of(unit, dimension, where);
    if (!found) return found.errors();
    return to_si(1, *found);
}

Result<double> parse_quantity(std::string_view text, Dimension dimension, const std::string& where) {
    std::string_view rest = trimmed(text);
    if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
    double number = 0;
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    const std::string shown = "\"" + std::string(text) + "\" is not ";
    if (code == std::errc::invalid_argument) {
        const bool plain = dimension == Dimension::number;
        return Error{ErrorCode::parse, where,
                     shown + with_article(dimension) + "; write a number" + (plain ? "" : " and a unit") + ", such as " +
                         example_of(dimension) + (plain ? "" : " (units: " + unit_names(dimension) + ")")};
    }
    if (code == std::errc::result_out_of_range || !std::isfinite(number)) {
        return Error{ErrorCode::not_finite, where, shown + "a finite " + std::string(dimension_name(dimension))};
    }
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    const Result<Unit> unit = unit_of(trimmed(rest), dimension, where);
    if (!unit) return unit.errors();
    const double si = to_si(number, *unit);
    if (is_usable_number(number) && is_usable_number(si)) return si;
    return Error{ErrorCode::out_of_range, where,
                 "\"" + std::string(text) + "\" is out of range: at most 1e30 in absolute value is allowed"};
}

Result<double> metres_per_unit(std::string_view unit, const std::string& where) { return si_per_unit(unit, Dimension::length, where); }

Result<double> parse_length(std::string_view text, const std::string& where) { return parse_quantity(text, Dimension::length, where); }

std::string format_quantity(double si, std::string_view unit, int digits) {
    const Unit* found = find_unit(unit);
    FETTLE_ASSERT(found != nullptr && digits >= 1, "unknown unit " + std::string(unit));
    std::array<char, 64> text{};
    const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), si * found->denominator / found->numerator,
                                           std::chars_format::general, std::min(digits, 17));
    FETTLE_ASSERT(code == std::errc(), "a number longer than its buffer");
    return std::string(text.data(), end) + " " + std::string(unit);
}

std::string format_length(double metres, std::string_view unit, int digits) { return format_quantity(metres, unit, digits); }

}  // namespace fettle::core::base
