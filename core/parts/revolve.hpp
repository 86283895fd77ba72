// SPDX-License-Identifier: MIT
/// Solids from profiles that are turned about an axis.
#pragma once

#include "core/parts/profile.hpp"
#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// The profile's x is the distance from the z axis, which it may touch but not cross; its y is z. Begins at the direction of x.
/// @param angle  [rad]; a full turn if not given. Else it has two plane ends, and begins at `from`.
/// Lines become planes, cylinders, cones; arcs about a point of the axis spheres, other arcs tori.
/// Errors: a profile that is empty or crosses the axis ("`groove` crosses the axis by 0.3 mm"), an angle not between 0 and a full turn.
Result<Solid> revolved(Drawing& drawing, const Profile& profile);
Result<Solid> revolved(Drawing& drawing, const Profile& profile, const Number& from, const Number& angle);

/// About the origin. Common solids of revolution.
Result<Solid> sphere(Drawing& drawing, const Number& radius, std::string feature = {});
/// About z from its base at z = 0; top_radius 0: pointed.
Result<Solid> cone(Drawing& drawing, const Number& radius, const Number& top_radius, const Number& height, std::string feature = {});
Result<Solid> torus(Drawing& drawing, const Number& ring_radius, const Number& tube_radius, std::string feature = {});

}  // namespace fettle::core::parts
