// SPDX-License-Identifier: MIT
/// All features of two bodies that come as close as a witness does, at its instant. Faces that lie parallel have a whole region of closest
/// points; its corners are vertices against triangles and edges that cross, and a one-sided derivative, which is least at a corner, needs
/// them all. (A search for the least distance is content with one of them per pair of triangles.)
#pragma once

#include <vector>

#include "core/clearance/clearance.hpp"

namespace fettle::adjoint::clearance {

/// Vertex-triangle and edge-edge pairs at most `tolerance` [m] farther apart than the points of `witness`, which is one of them.
/// O(n log n + pairs near each other). Wires and points of codimensional bodies count against triangles and edges only.
std::vector<core::clearance::Witness> tied_features(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int a,
                                                    int b, const core::clearance::Witness& witness, double tolerance);

}  // namespace fettle::adjoint::clearance
