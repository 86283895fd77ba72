// SPDX-License-Identifier: MIT
/// Single precision that is surely below or above.
#pragma once

#include <cmath>

namespace fettle::core::base {

/// What single precision is off by at x is less than |x| float_room_relative + float_room_absolute.
inline constexpr double float_room_relative = 0x1p-22, float_room_absolute = 1e-37;

[[gnu::always_inline]] inline double float_room(double x) { return std::abs(x) * float_room_relative + float_room_absolute; }

/// No more than x; -infinity below single precision's range. NaN stays.
[[gnu::always_inline]] inline float float_below(double x) { return static_cast<float>(x - float_room(x)); }
/// No less than x; infinity above single precision's range. NaN stays.
[[gnu::always_inline]] inline float float_above(double x) { return static_cast<float>(x + float_room(x)); }

}  // namespace fettle::core::base
