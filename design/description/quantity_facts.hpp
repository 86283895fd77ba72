// SPDX-License-Identifier: MIT
/// What a quantity says of itself (Quantity::facts), for those that treat some quantities in a way of their own: the parts of a formula are
/// looked at one by one, a clearance has a pair of bodies, a curve is drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/units.hpp"
#include "core/expression/formula.hpp"
#include "design/description/clearance_range.hpp"

namespace fettle::design::description {

class Quantity;

struct NamedQuantity {
    std::string name;
    std::shared_ptr<const Quantity> quantity;
};

/// The defaults are true of a number that nobody has to know more about. Pointers are valid as long as the quantity.
struct QuantityFacts {
    /// How it is made from its parts.
    enum class Kind {
        measured,      ///< it has none
        formula,       ///< by `formula` from their values (quantities/expression.hpp)
        step_formula,  ///< by `formula` from their numbers at each instant (quantities/step_expression.hpp)
        worst,         ///< the greatest or the least of them (quantities/worst.hpp)
        in_scenario    ///< the only one, in `scenario` (quantities/in_scenario.hpp)
    };
    Kind kind = Kind::measured;
    std::vector<NamedQuantity> parts{};  ///< by the names that the formula has for them; else the names are empty
    const core::expression::Formula* formula = nullptr;
    int scenario = 0;

    const ClearanceRange* clearance = nullptr;  ///< it is the certified distance that this says; null: it is none
    bool is_number = false;                     ///< without bounds of its own, so that a formula over the steps may name it
    std::optional<Dimension> curve{};           ///< of Quantity::curve(); none: there is nothing to draw
};

}  // namespace fettle::design::description
