// SPDX-License-Identifier: MIT
/// A profile whose edges are moved into the material, curve for curve: chamfers and drafts of extrusions. Corners stay corners (offset, of
/// profile_booleans.hpp, rounds them and lets curves vanish).
#pragma once

#include "core/base/result.hpp"
#include "core/parts/profile.hpp"

namespace fettle::core::parts {

/// Each curve at the distance `inset` to its left; neighbours are drawn out or cut back to where they meet.
/// Errors: an arc whose radius is used up, a curve that is shorter than what is cut from it.
Result<Profile> inset(const Profile& profile, const Number& distance);

}  // namespace fettle::core::parts
