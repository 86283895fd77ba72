// SPDX-License-Identifier: MIT
/// Whether a scenario leaves the parts, and where they are at the start, as the design has them: then a mass, or a clearance as assembled,
/// is the same in all scenarios and counts once.
#pragma once

#include <string_view>

#include "core/scene/scene.hpp"

namespace fettle::design::reading {

/// Is what the pointer names neither of a part nor of where it is at the start (gravity, motors, loads, a body's motion ...)? That is not
/// known of variables: have_same_parts.
bool leaves_parts(std::string_view pointer);

/// Have two scenes with the same bodies the same parts at the same places, whatever values the parameters have? Compared are the bodies as
/// they are, and the formulas of all numbers of parts and their places: false where formulas are written in another way, too.
/// Contract: variables that are no parameters are substituted in the formulas.
bool have_same_parts(const core::scene::Scene& a, const core::scene::Scene& b);

}  // namespace fettle::design::reading
