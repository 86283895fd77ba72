// SPDX-License-Identifier: MIT
/// A requirement on a simulated design: lower <= quantity <= upper. The optimiser aims at bounds narrowed by a margin and sees the
/// quantity's `value`; whether a design meets the requirement is judged by the quantity's bounds alone: measured.lower >= lower and
/// measured.upper <= upper. Where these are proven (Measurement::is_proven), that it is met is proven. (A clearance's `value` is the
/// certificate's upper bound, which its witness attains up to rounding.) Where the value has come to an end short of a bound, the optimiser
/// sees its continuation (quantity.hpp) instead.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "design/description/over_tolerances.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::description {

struct Bounds {
    double lower = -std::numeric_limits<double>::infinity();  ///< SI
    double upper = std::numeric_limits<double>::infinity();
    double margin = 0;  ///< by which the optimiser keeps away from both; less than half their distance
    double unit = 1;    ///< SI value of the unit that violations are counted in
    /// What is bounded is the quantity with its reserve for the tolerances; nothing: as drawn. Such bounds have one side (made_design.hpp).
    std::optional<OverTolerances> over_tolerances = {};
};
inline double target_lower(const Bounds& bounds) { return bounds.lower + bounds.margin; }
inline double target_upper(const Bounds& bounds) { return bounds.upper - bounds.margin; }

struct Constraint {
    std::string name;
    Bounds bounds;
    std::shared_ptr<const Quantity> quantity;
};

/// max(0, lower - measured.lower, measured.upper - upper) in `unit`s; at least 1 if the measurement has a fault, infinity if it is no
/// number. 0: the requirement is met.
double violation(const Bounds& bounds, const Measurement& measured);

}  // namespace fettle::design::description
