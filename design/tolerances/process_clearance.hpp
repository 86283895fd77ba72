// SPDX-License-Identifier: MIT
/// Clearance that a process of manufacturing needs between two parts that move, per side (the distance between two faces; twice that on a
/// diameter):
///   required = minimum + t(part a) + t(part b)
/// minimum: the gap below which faces fuse, powder or resin stays, or parts bind, even when made to size. t: how far a face of a part may
/// lie off its drawing, by the part's size. Published tolerances are +-T on a dimension, which has two faces: t = T / 2.
///   known processes   T by bands of size, of whole parts (known_processes.cpp)
///   a user's own      T = the larger limit of a length of the part's size (process.hpp), where the profile has lengths of its own
/// Size of a part: the longest side of its bounding box in the frame of its mesh file.
///
/// Sources differ by two to three times and rarely say per side or diametral; each figure names its own. They are a start for a first
/// print: measure the printer, then say --minimum.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "design/tolerances/process.hpp"

namespace fettle::design::tolerances {

/// t of one part [m]. Errors (out_of_range): larger than the last band; the sources end there. Contract: it says what parts need; size >=
/// 0.
Result<double> part_tolerance(const Process& process, double size, const std::string& where);

/// [m], per side. Errors: as part_tolerance; unsupported: a process that says nothing of clearances.
Result<double> required_clearance(const Process& process, double size_a, double size_b, const std::string& where);

/// Names the figures of the clearance that a user's process asks for which are another's: "the smallest gap (0.3 mm) and what faces may be
/// off by are those of fdm: nothing of a coupon shows them; ...", with what to do. Empty: none.
std::string borrowed_clearance(const Process& process);

/// The known processes' table for people, millimetres, per side, with the sources.
std::string clearance_table();

}  // namespace fettle::design::tolerances
