// SPDX-License-Identifier: MIT
/// How large a number from outside may be, in every reader: files, meshes, poses, options. Far beyond any mechanism, and small enough that
/// squares, and products of a few such numbers, stay finite: the proofs further down never meet an infinity that a file has put there.
#pragma once

#include <cmath>
#include <limits>

namespace fettle::core::base {

/// Largest absolute value that a reader takes, in the unit of the file and in SI alike.
inline constexpr double largest_magnitude = 1e30;

/// Largest number of teeth, of copies of a repeat, of anything that parts count.
inline constexpr int most_copies = 10'000;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Finite and at most largest_magnitude; false for NaN.
inline bool is_usable_number(double x) { return std::abs(x) <= largest_magnitude; }

}  // namespace fettle::core::base
