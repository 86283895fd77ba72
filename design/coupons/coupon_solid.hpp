// SPDX-License-Identifier: MIT
/// A coupon (coupon.hpp) as geometry, made by the kernel of parts.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"
#include "core/parts/profile.hpp"
#include "design/coupons/coupon.hpp"

namespace fettle::design::coupons {

/// The plate with all that stands on it: one closed surface, without self-intersection, round sides within 2 um. Contract: printed.
Result<core::geometry::Mesh> coupon_mesh(const Coupon& coupon);

/// Outline, holes and slots of a cut coupon. Contract: cut.
Result<core::parts::Profile> coupon_outline(const Coupon& coupon);

/// The drawing of the cuts (black) and engravings (blue: the labels, as lines in the middle of their bars), in millimetres. Contract: cut.
Result<std::string> coupon_svg(const Coupon& coupon);

/// [m^3]
double volume_of(const core::geometry::Mesh& mesh);

}  // namespace fettle::design::coupons
