// SPDX-License-Identifier: MIT
/// Clearance that a manufacturing process needs between two parts that move, per side (the distance between two faces; twice that on a
/// diameter):
///   required = minimum + t(part a) + t(part b)
/// minimum: the gap below which faces fuse, powder or resin stays, or parts bind, even when made to size. t: how far a face of a part may
/// lie off its drawing, by the part's size. Published tolerances are +-T on a dimension, which has two faces: t = T / 2.
/// Size of a part: the longest side of its bounding box in the frame of its mesh file.
///
/// Sources differ by two to three times and rarely say per side or diametral; each figure here names its own (process_presets.cpp). They
/// are a start for a first print: measure the printer, then say --minimum.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::design::quantities {

struct SizeBand {
    double up_to;      ///< largest part size [m], inclusive
    double tolerance;  ///< t of one part, per side [m]
    const char* source;
};

struct ProcessPreset {
    std::string_view name;  ///< as on the command line
    const char* description;
    double minimum;  ///< per side [m]
    const char* source;
    std::array<SizeBand, 3> bands;
};

/// fdm, sla, sls, mjf.
const std::array<ProcessPreset, 4>& process_presets();

/// Errors: unknown; the nearest, or all of them.
Result<ProcessPreset> process_preset(std::string_view name, const std::string& where);

/// t of one part [m]. Errors (out_of_range): larger than the last band; the sources end there.
Result<double> part_tolerance(const ProcessPreset& preset, double size, const std::string& where);

/// [m], per side. Errors: as part_tolerance.
Result<double> required_clearance(const ProcessPreset& preset, double size_a, double size_b, const std::string& where);

/// The table for people, millimetres, per side, with the sources.
std::string process_table();

}  // namespace fettle::design::quantities
