// SPDX-License-Identifier: MIT
/// How far the numbers of a mechanism as made lie from those of its design: `fettle tolerance` varies these deviations
/// (studies/tolerance_study.hpp).
///
/// A design as made has a parameter for each toleranced number, its value the nominal one: the design's own parameter, the scene's
/// variable, or, for a place of the scene, the deviation from what the place has as designed (add_deviation). So y as a function of the
/// deviations, and its derivative, are what every design has of its parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/description/design.hpp"
#include "design/tolerances/distribution.hpp"

namespace fettle::design::description {

/// One of the limits that a tolerance may be given: a grade of ISO 286.
struct ToleranceChoice {
    std::string name;             ///< "H8", "IT8"
    double lower = 0, upper = 0;  ///< SI
    double cost = 0;
};

/// What a tolerance costs, for `fettle tolerance --allocate` (studies/allocation.hpp).
struct ToleranceCost {
    double as_it_stands = 1;  ///< at its limits as they stand; of limits that are f times as wide, 1/f times that
    /// In place of that: of the input `t`, half of the width between the limits, SI.
    std::optional<core::expression::Formula> formula = {};
    std::vector<ToleranceChoice> choices = {};  ///< in place of both, the tightest first: these, and nothing between
};

struct Tolerance {
    std::string of;                      ///< a parameter, a variable of the scene, or a place as the file has it
    int parameter = 0;                   ///< of the design as made
    tolerances::Distribution deviation;  ///< of that parameter from its value [SI]
    std::string stated;                  ///< as people wrote it: "+-0.05 mm", "H7"
    std::string group = {};              ///< of tolerances that vary together; empty: it varies by itself
    double correlation = 1;              ///< with the group's common number, squared, with its sign: -1 to 1 (independent_inputs.hpp)
    ToleranceCost cost = {};
    bool is_fixed = false;  ///< an allocation leaves it as it stands
};

/// Gives the design a parameter of value 0 that is added to the number at a place, in the scene and in all scenarios.
/// @param place  Errors: none of the scene, or one that a scenario leaves to its default (core::scene::value_at).
/// @param unit   In which people read it; of the place's dimension.
/// @return its index
Result<int> add_deviation(Design& design, const std::string& place, const Unit& unit);

/// Where the parameters are with these deviations, one per tolerance.
VectorX with_deviations(const Design& as_made, const std::vector<Tolerance>& tolerances, const VectorX& deviations);

}  // namespace fettle::design::description
