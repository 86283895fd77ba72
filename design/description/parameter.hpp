// SPDX-License-Identifier: MIT
/// Design parameters: the numbers that an optimiser may change. What follows from them in the scene: Design::numbers (design.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"
#include "core/expression/parse_formula.hpp"

namespace fettle::design::description {

struct Parameter {
    std::string name;
    double value = 0, lower = 0, upper = 0;  ///< SI
    Unit unit = {};                          ///< that people read it in; trial values are those that a file in it can hold exactly
    /// Where what the scene leaves open is chosen (settings of contact, tolerances, facets of parts), the same for all values; none:
    /// `value`. A design that was found keeps what was chosen for the one that the search began with.
    std::optional<double> reference = {};
};

VectorX values_of(const std::vector<Parameter>& parameters);
VectorX references_of(const std::vector<Parameter>& parameters);
/// Faults of a scene at those values, told so where they may come of them.
Errors at_reference(Errors errors);
std::vector<std::string> names_of(const std::vector<Parameter>& parameters);
/// The parameters as what formulas may name; numbers without a unit count in SI.
core::expression::Scope scope_of(const std::vector<Parameter>& parameters);

/// What is wrong with p (SI) as values of these parameters, by name: not one finite number for each, or one that is farther beyond its
/// bounds than they are apart. Within that, differences and searches may look beyond a bound; farther out it is most often a number in
/// another unit. For what is given from outside: nothing here asks it of its own trials.
Errors check_values(const std::vector<Parameter>& parameters, const VectorX& p);

/// The number of `unit`s that is `si`, or one of its neighbours: one that to_si (core/base/units.hpp) maps back to the same bits, if there
/// is one (not every SI value is some number of millimetres; representable() gives the nearest that is).
double from_si(double si, const Unit& unit);

/// The SI value nearest to `si`, to a few units of rounding, that a file in this unit can hold exactly: to_si(from_si(si)).
double representable(double si, const Unit& unit);

}  // namespace fettle::design::description
