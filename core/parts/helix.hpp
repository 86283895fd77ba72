// SPDX-License-Identifier: MIT
/// Solids from profiles that run along a helix: springs, the ridge of a thread. Whole threads are rather twisted (extrude.hpp): one mesh,
/// without a Boolean.
#pragma once

#include "fettle/core/parts/profile.hpp"
#include "fettle/core/parts/solid.hpp"

namespace fettle::core::parts {

/// The profile stands in the half plane through the z axis, x = distance from the axis, y = z, and is turned counter-clockwise about z by
/// turns * 2 pi while it rises by pitch per turn (falls: left-handed). Plane ends in the half planes.
/// Errors: a profile that is empty or reaches the axis; that meets itself after a turn (taller than the pitch); turns not > 0.
Result<Solid> along_helix(Drawing& drawing, const Profile& profile, const Number& pitch, const Number& turns);

}  // namespace fettle::core::parts
