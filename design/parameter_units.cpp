// SPDX-License-Identifier: MIT
#include "fettle/design/parameter_units.hpp"

#include <cmath>

namespace fettle::design {

const std::vector<ParameterUnit>& parameter_units() {
    static const double pi = std::acos(-1.0);
    static const std::vector<ParameterUnit> units{{"um", UnitKind::length, 1e-6},
                                                  {"mm", UnitKind::length, 1e-3},
                                                  {"cm", UnitKind::length, 1e-2},
                                                  {"m", UnitKind::length, 1},
                                                  {"in", UnitKind::length, 0.0254},
                                                  {"ft", UnitKind::length, 0.3048},
                                                  {"deg", UnitKind::angle, pi / 180},
                                                  {"rad", UnitKind::angle, 1},
                                                  {"mm/s", UnitKind::speed, 1e-3},
                                                  {"m/s", UnitKind::speed, 1},
                                                  {"deg/s", UnitKind::angular_speed, pi / 180},
                                                  {"rad/s", UnitKind::angular_speed, 1},
                                                  {"rpm", UnitKind::angular_speed, pi / 30},
                                                  {"kg/m^3", UnitKind::density, 1},
                                                  {"g/cm^3", UnitKind::density, 1000},
                                                  {"1", UnitKind::number, 1}};
    return units;
}

std::optional<ParameterUnit> find_parameter_unit(std::string_view name) {
    for (const ParameterUnit& unit : parameter_units()) {
        if (unit.name == name) return unit;
    }
    return std::nullopt;
}

std::vector<std::string_view> parameter_unit_names() {
    std::vector<std::string_view> names;
    for (const ParameterUnit& unit : parameter_units()) names.push_back(unit.name);
    return names;
}

double to_si(double value, const ParameterUnit& unit) {
    const double inverse = std::round(1 / unit.factor);
    return inverse * unit.factor == 1 ? value / inverse : value * unit.factor;
}

double from_si(double value, const ParameterUnit& unit) {
    const double guess = value / unit.factor;
    if (to_si(guess, unit) == value) return guess;
    double below = guess, above = guess;
    for (int k = 0; k < 4; ++k) {
        below = std::nextafter(below, -INFINITY);
        above = std::nextafter(above, INFINITY);
        if (to_si(below, unit) == value) return below;
        if (to_si(above, unit) == value) return above;
    }
    return guess;
}

double representable(double value, const ParameterUnit& unit) { return to_si(from_si(value, unit), unit); }

}  // namespace fettle::design
