// SPDX-License-Identifier: MIT
/// Bounds as text: a bound that is printed in a unit is still a bound.
#pragma once

#include <functional>
#include <string>

namespace fettle::core::base {

enum class Towards { down, up };

/// `x` in units: `text(y)`, which shows a number of units, of the first y from x / unit on whose decimal, compared in extended precision,
/// reads back to x itself or lies on its safe side.
/// @param unit        SI value of the unit
/// @param exact_unit  the same, closer
std::string bound_text(double x, double unit, long double exact_unit, Towards towards, const std::function<std::string(double)>& text);

}  // namespace fettle::core::base
