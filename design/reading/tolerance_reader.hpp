// SPDX-License-Identifier: MIT
/// Reads the `tolerances` of a design file: for a parameter, a variable, or a place of the scene, how far what is made may lie from it, by
/// entries (tolerance_entry.hpp), and
///     "*": { "general": "m" }, "*": "length"                     every length and angle without an entry of its own
///     (add_default_tolerances)
/// Part of design_reader.hpp. Names are looked up before the scene is read, since the scene's numbers follow from the deviations of
/// variables; sizes, and places, after it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/tolerance.hpp"
#include "design/reading/design_formulas.hpp"
#include "design/reading/tolerance_entry.hpp"

namespace fettle::design::reading {

/// One entry, and where it stands, for faults that are found later.
struct ToleranceEntry {
    enum class Kind { parameter, variable, place };
    description::Tolerance tolerance;
    core::files::JsonNode node;
    Kind kind = Kind::parameter;
    bool is_default = false;  ///< of "*"
};

/// What of a design's parameters and variables "*" does not give a tolerance, though it has no other.
struct Untoleranced {
    std::string name, why;
};

/// What names may be given a tolerance, besides parameters.
struct VariableNames {
    std::vector<std::string> scene, design;
};

/// What they are of. Each variable with a tolerance gets a parameter, its deviation (its unit is not known yet).
/// @param parameters  As read. Faults go to the node's document.
std::vector<ToleranceEntry> find_tolerances(const core::files::JsonNode& node, const VariableNames& variables,
                                            std::vector<description::Parameter>& parameters);

/// Entries of what "*" says, for each parameter, and variable of the scene, that is a number of its own (nothing that follows from others)
/// and has none. Nothing without a "*".
/// @param why_fixed  Why a variable has no deviation, and is left out; empty: it can have one.
/// @return what is left out: numbers that are no lengths or angles, of size 0, or not covered.
std::vector<Untoleranced> add_default_tolerances(const core::files::JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                 const ToleranceUnits& units,
                                                 const std::function<std::string(const std::string&)>& why_fixed,
                                                 std::vector<description::Parameter>& parameters, std::vector<ToleranceEntry>& entries);

/// The deviations of variables, by their names.
std::map<std::string, std::string> deviations_of(const std::vector<ToleranceEntry>& entries,
                                                 const std::vector<description::Parameter>& parameters);

/// How wide they are. Gives the design, whose scene and scenarios are read, a parameter for each place, and those of variables their units.
/// Default entries of what the design makes a number that they do not cover go.
/// @param file  The scene's. @param formulas  What variables of the design and of the scene mean. @param left_out  Gets those that went.
void read_tolerances(std::vector<ToleranceEntry>& entries, const core::files::JsonNode& file, const DesignFormulas& formulas,
                     const ToleranceUnits& units, description::Design& design, std::vector<Untoleranced>& left_out);

}  // namespace fettle::design::reading
