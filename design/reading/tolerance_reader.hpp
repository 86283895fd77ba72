// SPDX-License-Identifier: MIT
/// Reads the `tolerances` of a design file: for a parameter, a variable of the scene, or a place of it, how far what is made may lie from
/// it.
///     "pin_radius": "+-0.05 mm"                                 normal, three standard deviations to each limit
///     "bore": { "lower": "-0.02 mm", "upper": "0.05 mm", "distribution": "uniform" }
///     "shaft": { "class": "h6" }                                ISO 286, of a diameter; "of": "radius": the value is half of it
///     "/bodies/crank/shape/dimensions/length": { "general": "m" }      ISO 2768-1
///     "pin": { ..., "group": "print", "correlation": 0.7 }       varies with others of its group
/// Part of design_reader.hpp. Names are looked up before the scene is read, since the scene's numbers follow from the deviations of
/// variables; sizes, and places, after it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/description/tolerance.hpp"
#include "fettle/design/reading/design_formulas.hpp"

namespace fettle::design::reading {

/// One entry, and where it stands, for faults that are found later.
struct ToleranceEntry {
    enum class Kind { parameter, variable, place };
    description::Tolerance tolerance;
    core::files::JsonNode node;
    Kind kind = Kind::parameter;
};

/// What names may be given a tolerance, besides parameters.
struct VariableNames {
    std::vector<std::string> scene, design;
};

/// What they are of. Each variable with a tolerance gets a parameter, its deviation (its unit is not known yet).
/// @param parameters  As read. Faults go to the node's document.
std::vector<ToleranceEntry> find_tolerances(const core::files::JsonNode& node, const VariableNames& variables,
                                            std::vector<description::Parameter>& parameters);

/// The deviations of variables, by their names.
std::map<std::string, std::string> deviations_of(const std::vector<ToleranceEntry>& entries,
                                                 const std::vector<description::Parameter>& parameters);

/// How wide they are. Gives the design, whose scene and scenarios are read, a parameter for each place, and those of variables their units.
/// @param formulas  What variables of the design and of the scene mean. @param length_unit  The file's.
void read_tolerances(std::vector<ToleranceEntry>& entries, const DesignFormulas& formulas, const Unit& length_unit,
                     description::Design& design);

}  // namespace fettle::design::reading
