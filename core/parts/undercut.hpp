// SPDX-License-Identifier: MIT
/// Whether a roller whose centre runs along a figure's outline touches all of what it would cut: cams for rollers. Where the outline bends
/// more sharply than the roller, the offset (profile_booleans.hpp) crosses itself, and what is left after its loops are cut away does not
/// lead the roller's centre along the outline any more.
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/parts/profile.hpp"

namespace fettle::core::parts {

/// Each curve or corner that bends towards the side of the offset with a radius below |distance|, once, at its sharpest:
/// "`rise` is undercut at 37 deg, (12 mm, 9 mm): there it bends with a radius of 4.1 mm, the offset is 5 mm". The angle is that about the
/// origin. The radius of curvature is 1 / |c' x c''| for a parameter of arc length. It is looked at in at least 64 places of each curve,
/// and between two of them where the curve turns by more than they say, as at a kink. What comes near the outline from elsewhere, across a
/// narrow neck, is not looked for.
/// @param distance  As for offset: > 0 outwards, < 0 inwards [m].
Errors undercuts(const Profile& profile, double distance);

}  // namespace fettle::core::parts
