// SPDX-License-Identifier: MIT
#include "core/expression/dimension_powers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fettle::core::expression {

namespace {

constexpr double close_enough = 1e-9;  // exponents such as 1/3 are rounded

constexpr std::array all_dimensions{Dimension::number,
                                    Dimension::length,
                                    Dimension::area,
                                    Dimension::volume,
                                    Dimension::angle,
                                    Dimension::time,
                                    Dimension::mass,
                                    Dimension::force,
                                    Dimension::torque,
                                    Dimension::energy,
                                    Dimension::speed,
                                    Dimension::angular_speed,
                                    Dimension::acceleration,
                                    Dimension::density,
                                    Dimension::stiffness,
                                    Dimension::angular_stiffness,
                                    Dimension::angular_acceleration,
                                    Dimension::power,
                                    Dimension::impulse,
                                    Dimension::angular_impulse};

}  // namespace

bool DimensionPowers::is_number() const { return same(*this, {}); }

DimensionPowers powers_of(Dimension dimension) {
    switch (dimension) {
        case Dimension::number:
            return {};
        case Dimension::length:
            return {{1, 0, 0, 0}};
        case Dimension::area:
            return {{2, 0, 0, 0}};
        case Dimension::volume:
            return {{3, 0, 0, 0}};
        case Dimension::angle:
            return {{0, 0, 0, 1}};
        case Dimension::time:
            return {{0, 0, 1, 0}};
        case Dimension::mass:
            return {{0, 1, 0, 0}};
        case Dimension::force:
            return {{1, 1, -2, 0}};
        case Dimension::torque:
        case Dimension::energy:
            return {{2, 1, -2, 0}};
        case Dimension::speed:
            return {{1, 0, -1, 0}};
        case Dimension::angular_speed:
            return {{0, 0, -1, 1}};
        case Dimension::acceleration:
            return {{1, 0, -2, 0}};
        case Dimension::density:
            return {{-3, 1, 0, 0}};
        case Dimension::stiffness:
            return {{0, 1, -2, 0}};
        case Dimension::angular_stiffness:
            return {{2, 1, -2, -1}};
        case Dimension::angular_acceleration:
            return {{0, 0, -2, 1}};
        case Dimension::power:
            return {{2, 1, -3, 0}};
        case Dimension::impulse:
            return {{1, 1, -1, 0}};
        case Dimension::angular_impulse:
            return {{2, 1, -1, 0}};
    }
    return {};
}

bool same(const DimensionPowers& a, const DimensionPowers& b) {
    return std::equal(a.exponents.begin(), a.exponents.end(), b.exponents.begin(),
                      [](double x, double y) { return std::abs(x - y) <= close_enough; });
}

DimensionPowers product(const DimensionPowers& x, const DimensionPowers& y, double n) {
    DimensionPowers result = x;
    for (size_t k = 0; k < result.exponents.size(); ++k) result.exponents[k] += n * y.exponents[k];
    return result;
}

std::optional<Dimension> named_dimension(const DimensionPowers& powers) {
    const auto found =
        std::find_if(all_dimensions.begin(), all_dimensions.end(), [&](Dimension dimension) { return same(powers_of(dimension), powers); });
    return found == all_dimensions.end() ? std::nullopt : std::optional(*found);
}

std::string described(const DimensionPowers& powers) {
    if (const auto named = named_dimension(powers)) {
        const std::string name(dimension_name(*named));
        return (std::string_view("aeiou").find(name.front()) == std::string_view::npos ? "a " : "an ") + name;
    }
    constexpr std::array units{"m", "kg", "s", "rad"};
    std::string text = "a quantity in";
    for (size_t k = 0; k < units.size(); ++k) {
        const double exponent = powers.exponents[k];
        if (std::abs(exponent) <= close_enough) continue;
        char power[40] = "";
        if (std::abs(exponent - 1) > close_enough) std::snprintf(power, sizeof power, "^%.4g", exponent);
        text += std::string(" ") + units[k] + power;
    }
    return text;
}

}  // namespace fettle::core::expression
