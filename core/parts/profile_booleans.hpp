// SPDX-License-Identifier: MIT
/// Union, difference and intersection of profiles, and offsets, on the true curves. Where two curves meet is a closed form for lines and
/// arcs; else a root found on plain numbers, and one step of Newton's method from it that is recorded: to first order in the dimensions
/// that is the implicit function theorem, so the derivative is exact.
///
/// Curves within 1e-9 of the figure's size of each other count as touching: pieces that coincide are one.
#pragma once

#include "core/parts/profile.hpp"

namespace fettle::core::parts {

/// Empty results are an empty profile: no error here, but nothing that can be extruded.
/// Errors: a result that cannot be put together because curves touch without crossing in a way that rounding decides; `where` names both.
Result<Profile> united(const Profile& a, const Profile& b);
Result<Profile> united(const std::vector<Profile>& profiles);
Result<Profile> difference(const Profile& a, const Profile& b);
Result<Profile> difference(const Profile& a, const std::vector<Profile>& cut);
Result<Profile> intersection(const Profile& a, const Profile& b);

/// Copies as one figure, united where they meet; by a full turn / count, by k * step. Features as in profile.hpp, polar_copies.
Result<Profile> polar_repeat(const Profile& profile, int count, const Point2& about = {});
Result<Profile> linear_repeat(const Profile& profile, int count, const Point2& step);

/// Everything within `distance` of the figure (> 0, corners become arcs), or what is left when everything within -distance of its outside
/// is taken away (< 0). Exact for lines and arcs. The offset of another curve is the curve through the offset points, whose tangents are
/// exact. Parts that vanish are left out: a figure that vanishes altogether is empty.
/// Errors: as above.
Result<Profile> offset(const Profile& profile, const Number& distance);

}  // namespace fettle::core::parts
