// SPDX-License-Identifier: MIT
/// Quantities with units, at the border of the program: everything inside is SI (m, kg, s, rad, N). One table; a unit has a dimension, and
/// a length where a mass is expected is an error, not a number.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/result.hpp"

namespace fettle::core::base {

enum class Dimension {
    number,  ///< without a unit; `1` may be written
    length,
    area,
    volume,
    angle,
    time,
    mass,
    force,
    torque,
    energy,
    speed,
    angular_speed,
    acceleration,
    density,
    stiffness,
    angular_stiffness,  ///< of a spring about an axis
    angular_acceleration,
    power,
    impulse,         ///< of a force; momentum
    angular_impulse  ///< of a torque; angular momentum
};

/// One unit is numerator/denominator in SI, both whole where that is possible: such a quantity is rounded once only.
struct Unit {
    std::string_view name;
    Dimension dimension = Dimension::number;
    double numerator = 1, denominator = 1;
};

/// Every unit; no name stands twice.
std::span<const Unit> units();
const Unit* find_unit(std::string_view name);  ///< null: none

/// "length"; for messages.
std::string_view dimension_name(Dimension dimension);
/// "um, mm, cm, m, in, ft"; for messages.
std::string unit_names(Dimension dimension);
/// "m", "kg", "1": what a number of this dimension is in inside the program.
std::string_view si_unit(Dimension dimension);

/// number * numerator / denominator.
inline double to_si(double number, const Unit& unit) { return number * unit.numerator / unit.denominator; }

/// SI value of one `unit`, correctly rounded where the table is whole: "mm" -> 0.001.
/// Errors: an unknown unit (out_of_range), one of another dimension (wrong_type); the message lists those allowed; `where` is copied.
Result<double> si_per_unit(std::string_view unit, Dimension dimension, const std::string& where = {});

/// "0.3mm", "0.3 mm", "-1e-2 in", "12 g/cm^3" -> SI; the decimal point is '.' in every locale. A Dimension::number may leave its unit out.
/// Errors: no number (parse), a missing or unknown unit, or a value beyond base::largest_magnitude (out_of_range), a unit of another
/// dimension (wrong_type), infinity or NaN (not_finite).
Result<double> parse_quantity(std::string_view text, Dimension dimension, const std::string& where = {});

/// The same of lengths.
Result<double> metres_per_unit(std::string_view unit, const std::string& where = {});
Result<double> parse_length(std::string_view text, const std::string& where = {});

/// 0.0003, "mm" -> "0.3 mm", with up to `digits` significant digits. Contract: a known unit, digits >= 1.
std::string format_quantity(double si, std::string_view unit, int digits = 6);
/// The same of lengths [m].
std::string format_length(double metres, std::string_view unit, int digits = 6);

}  // namespace fettle::core::base
