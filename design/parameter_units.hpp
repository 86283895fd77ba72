// SPDX-License-Identifier: MIT
/// Units of design parameters: what a parameter measures, and SI per unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::design {

enum class UnitKind { length, angle, speed, angular_speed, density, number };

struct ParameterUnit {
    std::string name;
    UnitKind kind = UnitKind::number;
    double factor = 1;  ///< SI value of one unit: m, rad, m/s, rad/s, kg/m^3, 1
};

/// um mm cm m in ft, deg rad, mm/s m/s, deg/s rad/s rpm, kg/m^3 g/cm^3, 1.
const std::vector<ParameterUnit>& parameter_units();
std::optional<ParameterUnit> find_parameter_unit(std::string_view name);
std::vector<std::string_view> parameter_unit_names();

/// Power of ten units are divided by, not multiplied with: 14.7 mm is 14.7 / 1000, the double nearest to 0.0147.
double to_si(double value, const ParameterUnit& unit);
/// value / factor, or one of its neighbours: one that to_si maps back to the same bits, if there is one (not every SI value is some number
/// of millimetres; representable() gives the nearest that is).
double from_si(double value, const ParameterUnit& unit);
/// The SI value nearest to `value`, to a few units of rounding, that a file in this unit can hold exactly: to_si(from_si(value)).
double representable(double value, const ParameterUnit& unit);

}  // namespace fettle::design
