// SPDX-License-Identifier: MIT
/// How far the numbers of a made mechanism lie from those of its design: what `fettle tolerance` varies (studies/tolerance_study.hpp).
///
/// A design as made has a parameter for each toleranced number, its value the nominal one: the design's own parameter, the scene's
/// variable, or, for a place of the scene, the deviation from what the place has as designed (add_deviation). So y as a function of the
/// deviations, and its derivative, are what every design has of its parameters.
#pragma once

#include <string>
#include <vector>

#include "fettle/design/description/design.hpp"
#include "fettle/design/tolerances/distribution.hpp"

namespace fettle::design::description {

struct Tolerance {
    std::string of;                      ///< a parameter, a variable of the scene, or a place as the file has it
    int parameter = 0;                   ///< of the design as made
    tolerances::Distribution deviation;  ///< of that parameter from its value [SI]
    std::string stated;                  ///< as people wrote it: "+-0.05 mm", "H7"
    std::string group = {};              ///< of tolerances that vary together; empty: it varies by itself
    double correlation = 1;  ///< with the group's common number, squared, with its sign: -1 to 1 (studies/independent_inputs.hpp)
};

/// Gives the design a parameter of value 0 that is added to the number at a place, in the scene and in all scenarios.
/// @param place  Errors: none of the scene, or one that a scenario leaves to its default (core::scene::value_at).
/// @param unit   In which people read it; of the place's dimension.
/// @return its index
Result<int> add_deviation(Design& design, const std::string& place, const Unit& unit);

/// Where the parameters are with these deviations, one per tolerance.
VectorX with_deviations(const Design& as_made, const std::vector<Tolerance>& tolerances, const VectorX& deviations);

}  // namespace fettle::design::description
