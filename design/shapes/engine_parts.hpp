// SPDX-License-Identifier: MIT
/// The four parts of the printed slider-crank engine, all printed in place and joined by contact alone.
///
/// Layout. Crank axis = z through the origin, piston slides along x, z is up through the stack, z = 0 is the rod's mid-plane, which
/// also holds the cylinder's axis. With crank angle a, r = crank_radius, L = rod_length the frames stand, unrotated at a = 0, at
///   block  (0, 0, 0)
///   crank  (0, 0, 0), turned by a about z
///   rod    (r cos a, r sin a, 0), turned by -asin(r sin a / L) about z
///   piston (r cos a + sqrt(L^2 - r^2 sin^2 a), 0, 0)
/// Stack at the crank, from below: collar, [0.4 mm gap], block's plate with the journal in its bore, [0.4], shoulder, disc, [0.4], rod's
/// big end about the crank pin, [0.4], pin head. At the piston: lug, [0.4], rod's small end about the wrist pin, [0.4], pin head.
///
///                     ___ head                        ___ head        ______________
///      rod  =========| | |===========================| | |=====      |  tall part   |
///          __________| |___                       ___| |_____|=======|====piston====|===
///         |______ disc ____|                     |___lug_____|       |              |
///              |__| shoulder                                         |              |
///      ________|  |_____________________________________________ ____|              |
///      plate   |  | journal                                                         |
///      ________|  |_________________________________________________________________|
///             |____| collar                                                          --> x
#pragma once

#include "fettle/design/shapes/shape_definition.hpp"

namespace fettle::design::shapes {

ShapeDefinition crank_definition();
ShapeDefinition rod_definition();
ShapeDefinition piston_definition();
ShapeDefinition block_definition();

}  // namespace fettle::design::shapes
