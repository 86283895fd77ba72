// SPDX-License-Identifier: MIT
/// Reads the `tolerances` of a design file: for a parameter, a variable of the scene, or a place of it, how far what is made may lie from
/// it.
///     "pin_radius": "+-0.05 mm"                                 normal, three standard deviations to each limit
///     "bore": { "lower": "-0.02 mm", "upper": "0.05 mm", "distribution": "uniform" }
///     "shaft": { "class": "h6" }                                ISO 286, of a diameter; "of": "radius": the value is half of it
///     "/bodies/crank/shape/dimensions/length": { "general": "m" }      ISO 2768-1
///     "pin": { ..., "group": "print", "correlation": 0.7 }       varies with others of its group
/// Part of design_reader.hpp. Names are looked up before the scene is read, since variables with a tolerance become parameters of the
/// design as made; places after it.
#pragma once

#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/description/tolerance.hpp"

namespace fettle::design::reading {

/// One entry, and where it stands, for faults that are found later.
struct ToleranceEntry {
    description::Tolerance tolerance;
    core::files::JsonNode node;
    bool is_place = false;  ///< its number is read by read_place_tolerances, and `tolerance.deviation` until then is nothing
};

/// Those of parameters and variables are complete; a variable with a tolerance is added to the parameters.
/// @param length_unit  The file's. @param parameters  As read. Faults go to the node's document.
std::vector<ToleranceEntry> read_tolerances(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                            const Unit& length_unit, std::vector<description::Parameter>& parameters);

/// Gives the design, whose scene and scenarios are read, a parameter for each place.
void read_place_tolerances(std::vector<ToleranceEntry>& entries, const Unit& length_unit, description::Design& design);

}  // namespace fettle::design::reading
