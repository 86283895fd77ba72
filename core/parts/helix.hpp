// SPDX-License-Identifier: MIT
/// Solids from profiles that turn about z while they rise: springs and the ridge of a thread along a helix; helical gears, worms and whole
/// threads from their cross section, twisted: one mesh, without a Boolean.
#pragma once

#include "core/parts/profile.hpp"
#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// The profile stands in the half plane through the z axis, x = distance from the axis, y = z, and is turned counter-clockwise about z by
/// turns * 2 pi while it rises by pitch per turn (falls: left-handed). Plane ends in the half planes.
/// Errors: a profile that is empty or reaches the axis; that meets itself after a turn (taller than the pitch); turns not > 0.
Result<Solid> along_helix(Drawing& drawing, const Profile& profile, const Number& pitch, const Number& turns);

/// Turned by `twist` [rad] in all as it rises, about the z axis, counter-clockwise if positive: helical gears; threads and worms from
/// their cross section.
/// @param steps  Number of slices; 0: by the drawing's facets.
Result<Solid> twisted(Drawing& drawing, const Profile& profile, const Number& from, const Number& to, const Number& twist, int steps = 0);

}  // namespace fettle::core::parts
