// SPDX-License-Identifier: MIT
/// Box, pin, plate with a hole: all centred at the origin, axis z.
#pragma once

#include "fettle/design/shapes/shape_definition.hpp"

namespace fettle::design::shapes {

ShapeDefinition box_definition();
ShapeDefinition pin_definition();
ShapeDefinition plate_with_hole_definition();

}  // namespace fettle::design::shapes
