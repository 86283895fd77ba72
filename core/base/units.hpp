// SPDX-License-Identifier: MIT
/// Lengths with units, at the border of the program: everything inside is in metres. Units: um mm cm m in ft.
#pragma once

#include <string>
#include <string_view>

#include "fettle/core/base/result.hpp"

namespace fettle::core::base {

/// Metres in one `unit`, correctly rounded: "mm" -> 0.001.
/// Errors: an unknown unit (out_of_range), the message lists those allowed; `where` is copied into it.
Result<double> metres_per_unit(std::string_view unit, const std::string& where = {});

/// "0.3mm", "0.3 mm", "-1e-2 in" -> metres; the decimal point is '.' in every locale.
/// Errors: no number (parse), a missing or unknown unit (out_of_range), infinity or NaN (not_finite).
Result<double> parse_length(std::string_view text, const std::string& where = {});

/// 0.0003, "mm" -> "0.3 mm", with up to `digits` significant digits. Contract: a known unit, digits >= 1.
std::string format_length(double metres, std::string_view unit, int digits = 6);

}  // namespace fettle::core::base
