// SPDX-License-Identifier: MIT
/// The two moving parts of the eccentric that lifts a follower. Guide and stop: plate_with_hole (simple_shapes.hpp).
///
/// Layout. The eccentric turns about x through its origin; the follower slides along z, its tip's lowest point at its origin, straight
/// above the eccentric's axis. With eccentricity e, disc radius R, tip radius r and the disc's centre at angle t above the horizontal, the
/// tip's lowest point stands ideally (round disc, round tip, touching) at
///   z(t) = e sin t + sqrt((R + r)^2 - e^2 cos^2 t) - r,     lowest R - e, highest R + e: the rise is 2 e.
///
///         ______ head
///        |______|
///          |  |         stop: the head must not reach it
///      ____|  |____
///      guide  |____     shank
///      ____|  |____
///          |  |
///          '--'         tip
///        .-''''-.
///       /        \      disc
///      |    + <---------- its centre
///       \   o    /      axis of the shaft: x
///        '-....-'
#pragma once

#include "fettle/design/shapes/shape_definition.hpp"

namespace fettle::design::shapes {

ShapeDefinition eccentric_definition();
ShapeDefinition follower_definition();

}  // namespace fettle::design::shapes
