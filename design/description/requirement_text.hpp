// SPDX-License-Identifier: MIT
/// Requirements and what was measured in words, for people: each number with its unit.
#pragma once

#include <string>

#include "fettle/design/description/constraint.hpp"

namespace fettle::design::description {

/// What numbers of the requirement are told in: "mm"; empty: plain numbers.
std::string unit_name(const Constraint& constraint);

/// 3e-4 in 1e-3, "mm" -> "0.3 mm".
std::string amount_text(double si, double unit, const std::string& unit_name, int digits = 7);

/// "at least 0.3 mm", "at most 2 N", "29.95 to 30.05 mm", "exactly 1".
std::string required_text(const Bounds& bounds, const std::string& unit_name);

/// What is proven of it: "0.302 mm", or "0.302 to 0.304 mm" where the two differ in the digits that are told.
std::string proven_text(const Measurement& measured, const Bounds& bounds, const std::string& unit_name);

}  // namespace fettle::design::description
