// SPDX-License-Identifier: MIT
/// Dimensions as powers of length, mass, time and angle, so that they can be multiplied: a length times a length is an area. They are used
/// for products and powers in an expression (formula.hpp); those that have units of their own are base::Dimension.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/types.hpp"
#include "core/base/units.hpp"

namespace fettle::core::expression {

/// Exponents of m, kg, s and rad. An angle is a dimension of its own here, so that 30 degrees are never taken for the number 30.
struct DimensionPowers {
    std::array<double, 4> exponents{0, 0, 0, 0};

    bool is_number() const;
};

DimensionPowers powers_of(Dimension dimension);
bool same(const DimensionPowers& a, const DimensionPowers& b);
/// The dimension of x y^n.
DimensionPowers product(const DimensionPowers& x, const DimensionPowers& y, double n = 1);

/// The dimension of that name; none for lengths to the fourth, and so on. Torque, not energy, of the two that are one.
std::optional<Dimension> named_dimension(const DimensionPowers& powers);
/// "a length", "an angle", "a quantity in m^4 kg^-1"; for messages.
std::string described(const DimensionPowers& powers);

}  // namespace fettle::core::expression
