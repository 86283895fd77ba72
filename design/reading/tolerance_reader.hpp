// SPDX-License-Identifier: MIT
/// Reads the `tolerances` of a design file: for a parameter, a variable of the scene, or a place of it, how far what is made may lie from
/// it, by entries (tolerance_entry.hpp), and
///     "*": { "general": "m" }, "*": "length"                     every length and angle without an entry of its own
///     (add_default_tolerances)
/// Part of design_reader.hpp. Names are looked up before the scene is read, since variables with a tolerance become parameters of the
/// design as made; places after it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/description/tolerance.hpp"
#include "fettle/design/reading/tolerance_entry.hpp"

namespace fettle::design::reading {

/// One entry, and where it stands, for faults that are found later.
struct ToleranceEntry {
    description::Tolerance tolerance;
    core::files::JsonNode node;
    bool is_place = false;  ///< its number is read by read_place_tolerances, and `tolerance.deviation` until then is nothing
};

/// What of a design's parameters and variables "*" does not give a tolerance, though it has no other.
struct Untoleranced {
    std::string name, why;
};

/// Those of parameters and variables are complete; a variable with a tolerance is added to the parameters.
/// @param parameters  As read. Faults go to the node's document.
std::vector<ToleranceEntry> read_tolerances(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                            const ToleranceUnits& units, std::vector<description::Parameter>& parameters);

/// What "*" says, for each parameter and variable that is a number of its own (nothing that follows from others) and has no entry: sizes
/// are taken without their sign. Nothing without a "*".
/// @param why_fixed  Of a variable: why it cannot be a parameter, and is left out; empty: it can.
/// @return what is left out: numbers that are no lengths or angles, of size 0, or not covered.
std::vector<Untoleranced> add_default_tolerances(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                 const ToleranceUnits& units,
                                                 const std::function<std::string(const std::string&)>& why_fixed,
                                                 std::vector<description::Parameter>& parameters, std::vector<ToleranceEntry>& entries);

/// Gives the design, whose scene and scenarios are read, a parameter for each place.
void read_place_tolerances(std::vector<ToleranceEntry>& entries, const ToleranceUnits& units, description::Design& design);

}  // namespace fettle::design::reading
