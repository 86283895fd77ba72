// SPDX-License-Identifier: MIT
/// A point fixed to a body, and the seed of its position.
#pragma once

#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

/// Point X of the body's file frame, relative to its reference point, in the configuration t [m], world.
Vector3 marker_position(const description::Simulated& simulated, int t, int body, const Vector3& point_in_file_frame);

/// Adds the seed of  gradient . (marker position at configuration t):  pose_bar[t] += gradient [X; 1]^T, X = point - c, and, where the
/// point follows from parameters, R^T gradient . dX. What the position owes to the shape is nothing: a marker is a point of the frame, not
/// of the mesh.
void add_marker_seed(const description::Simulated& simulated, int t, int body, const OwnPoint& point_in_file_frame, const Vector3& gradient,
                     description::Seeds& seeds);

}  // namespace fettle::design::quantities
