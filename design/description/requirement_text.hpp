// SPDX-License-Identifier: MIT
/// Requirements and what was measured in words, for people: each number with its unit.
#pragma once

#include <string>

#include "core/base/bound_text.hpp"
#include "design/description/design.hpp"

namespace fettle::design::description {

using core::base::Towards;

/// The unit in which numbers of the requirement are shown: "mm"; empty: plain numbers.
std::string unit_name(const Constraint& constraint);
/// Likewise; empty too where its expression is of a dimension without a name, whose numbers are SI, and where a program made it.
std::string unit_name(const Relation& relation);

/// The unit of the whole objective: that of its one quantity where the weight is 1 or -1; empty where it is a sum, or weighed.
std::string objective_unit(const Design& design);

/// The unit that a number is counted in: its SI value, and its name as above.
struct CountedUnit {
    double si = 1;
    std::string name = {};
};
inline CountedUnit counted_unit(const Constraint& constraint) { return {constraint.bounds.unit, unit_name(constraint)}; }

/// 3e-4 in 1e-3, "mm" -> "0.3 mm".
std::string amount_text(double si, double unit, const std::string& unit_name, int digits = 7);

/// "at least 0.3 mm", "at most 2 N", "29.95 to 30.05 mm", "exactly 1", "at least 0.3 mm at 3 sigma of the tolerances".
std::string required_text(const Bounds& bounds, const std::string& unit_name);

/// A bound, rounded to its safe side: 0.30199996 mm downwards -> "0.3019999 mm".
std::string bound_text(double si, Towards towards, double unit, const std::string& unit_name);

/// The value that a requirement is judged by, with its standing (Measurement::is_proven): "proven 0.302 to 0.304 mm", the lower bound
/// rounded down and the upper one up; "computed 29.996 mm", the one that is nearer to its limit, where the two do not differ in the digits
/// that are shown.
std::string known_text(const Measurement& measured, const Bounds& bounds, const std::string& unit_name);

}  // namespace fettle::design::description
