// SPDX-License-Identifier: MIT
/// One entry of a design's `tolerances`:
///     "pin_radius": "+-0.05 mm"                                 normal, three standard deviations to each limit
///     "bore": { "lower": "-0.02 mm", "upper": "0.05 mm", "distribution": "uniform" }
///     "shaft": { "class": "h6" }                                ISO 286, of a diameter; "of": "radius": the value is half of it
///     "/bodies/crank/shape/dimensions/length": { "general": "m" }      ISO 2768-1; of an angle, with its shorter "leg"
///     "eye": "hole", "pin": { "feature": "pin", "of": "radius" }       as the design's process makes it (tolerances/process.hpp), or
///                                                                      "process": "sla" here
///     "pin": { ..., "group": "print", "correlation": 0.7 }       varies with others of its group; a number of a process does with
///                                                                others of its print
/// Part of tolerance_reader.hpp, which says what entries there are.
#pragma once

#include <optional>
#include <string>

#include "core/files/json_document.hpp"
#include "design/description/tolerance.hpp"
#include "design/tolerances/process.hpp"

namespace fettle::design::reading {

/// Which processes the entries of a file name.
struct ProcessChoice {
    std::optional<tolerances::Process> usual;  ///< of entries that name none
    bool is_missing = false;                   ///< one is named, and cannot be read, which is told
    std::string folder = {};                   ///< of the file, where names of other files are relative to
};

/// The file's unit of lengths, and its processes.
struct ToleranceUnits {
    Unit length;
    ProcessChoice processes = {};
};

/// What a tolerance is of.
struct Nominal {
    double value = 0;  ///< SI
    Unit unit;
};

/// All but its name and parameter. Faults go to the node's document.
void read_entry(const core::files::JsonNode& node, const Nominal& nominal, const ToleranceUnits& units, description::Tolerance& tolerance);

/// Why such a number has no tolerance of "*"; empty: it has. Contract: the entry is without faults.
std::string why_no_tolerance(const core::files::JsonNode& node, const Nominal& nominal, const ToleranceUnits& units);

}  // namespace fettle::design::reading
