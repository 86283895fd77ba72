// SPDX-License-Identifier: MIT
/// Formulas as people write them: `2 * crank_radius + 0.5 mm`, `max(a, b)`, `if(gap < 0.2 mm, a, b)`, `'long name' ^ 2`:
///   + - * / ^ ( )   as usual: -a^2 is -(a^2), a^b^c is a^(b^c)
///   min(a, b, ...)  max(a, b, ...)  hypot(a, b, ...)  abs(a)  sqrt(a)
///   sin(a)  cos(a)  tan(a)      of an angle, or of a number, which is in radians
///   asin(a)  acos(a)  atan(a)  atan2(y, x)      angles
///   exp(a)  log(a)  of numbers; log is the natural logarithm
///   floor(a)        of a value that no input changes
///   if(a < b, x, y) x where a < b, else y; also > <= >=
///   pi
///   numbers         with a unit where they have a dimension: `2 mm`, `30deg`; the longest unit that fits is read: 2 mm^2 is two
///                   square millimetres, (2 mm)^2 are four. A number without a unit that is added to or compared with a quantity counts in
///                   the file's unit of that dimension: `gap + 0.1` in a file in mm
///   names           of inputs and variables; in single quotes where the name is not a word (letters, digits, _ and .)
/// A `=` at the beginning is ignored. Dimensions are checked: what is added or compared has one dimension, and an exponent is a number
/// (a constant one, unless its base is a number too). By hand: libraries of formulas neither check dimensions nor differentiate, nor say
/// where in the text a fault is.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/units.hpp"
#include "core/expression/formula.hpp"

namespace fettle::core::expression {

/// The names that a text may use.
struct Scope {
    struct Name {
        std::string name;
        DimensionPowers dimension;
        std::optional<Formula> meaning = {};  ///< a variable's formula over inputs; none: an input itself
    };
    std::vector<Name> names;
    std::string what = "variable";  ///< what they are, for messages
    /// The SI value of the unit in which a number without a unit counts; 0: there is none, and a unit is required. Empty: SI.
    std::function<double(base::Dimension)> plain_unit = {};

    const Name* find(std::string_view name) const;
};

/// Errors, as many as can be found, each with the place in the text: syntax (parse), names and functions that do not exist, with the
/// nearest one (out_of_range), dimensions that do not go together (wrong_type). `where` is copied into each.
base::Result<Formula> parse_formula(std::string_view text, const Scope& scope, const std::string& where = {});

/// The same where a quantity of this dimension is expected: a number (one that no input changes) counts in `si_per_number`.
/// Errors: another dimension (wrong_type).
base::Result<Formula> parse_formula_of(std::string_view text, const Scope& scope, base::Dimension dimension, double si_per_number,
                                       const std::string& where = {});

/// Adds variables to a scope, each after those that it names, whatever their order. `define` says what each becomes in the scope: a name
/// with a meaning, or an input. @param texts  Their names and formulas.
/// @return faults, `where` the variable's name; one that has faults, or follows from itself, is there as a number.
base::Errors define_variables(const std::map<std::string, std::string>& texts, Scope& scope,
                              const std::function<Scope::Name(const std::string& name, Formula formula)>& define);

/// Units of numbers without one in a file (Scope::plain_unit): lengths, speeds and areas by `length_unit` [m], angles in degrees, masses in
/// `mass_unit` [kg], others SI.
std::function<double(base::Dimension)> plain_units(double length_unit, double mass_unit = 1);

/// The words of a text that may be names of inputs and variables; functions are among them, units behind numbers are not.
std::vector<std::string> names_in(std::string_view text);

/// `name`, in single quotes if it is not a word; the text of a formula that is this input.
std::string quoted_if_needed(std::string_view name);

/// Can formulas name it? Not empty, no single quote.
bool is_possible_name(std::string_view name);

}  // namespace fettle::core::expression
