// SPDX-License-Identifier: MIT
/// The parts of the four-bar linkage, printed in place: a base plate with two bores, two arms (crank and rocker), a coupler.
///
/// Layout. z = 0 is the coupler's mid-plane, z is up through the stack, x runs from the crank's axis. An arm has a journal below, in
/// the base's bore, and a pin above, in the coupler's; it rides on the plate with a shoulder about the journal and a foot under the pin.
/// Stack from below: collar, [0.3 mm gap], base with the journal in its bore, [0.3], shoulder and foot, bar, [0.3], coupler about the
/// pin, [0.3], head.
///
///               __ head                                         __ head
///      ________|  |______________________ coupler _____________|  |____
///      ________|  |____________________________________________|  |____
///       _______|__|__________           ________________________|__|__
///      |_______________bar___|         |___________bar________________|
///       |foot|       |    | shoulder        |    |             |foot|
///      ______________|    |_________________|    |__________________________
///      base          |    | journal         |    |
///      ______________|    |_________________|    |__________________________
///                   |______| collar        |______|
///
/// Ideal kinematics, lengths crank a, coupler b, rocker c (from its journal to its pin), directions as complex numbers: with the base's
/// second bore at B, the crank at angle t, the coupler at angle u, the rocker at angle w:   a e^(it) + b e^(iu) = B + c e^(iw);
/// the point that the coupler carries, at (p, q) in its frame:   P = a e^(it) + (p + i q) e^(iu).
#pragma once

#include "fettle/design/shapes/shape_definition.hpp"

namespace fettle::design::shapes {

ShapeDefinition base_plate_definition();
ShapeDefinition arm_definition();
ShapeDefinition coupler_definition();

}  // namespace fettle::design::shapes
