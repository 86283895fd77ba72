// SPDX-License-Identifier: MIT
/// Measures (core/measure/measure.hpp) forwards: value and gradient along changes of poses and of the frames' placement. With z = P [X; 1]
/// of a point and P [A; 0] of an axis, both linear in P (3 x 4), the gradient is G = sum f_z [X; 1]^T, and
///   z_dot = P_dot [X; 1] + P [X_dot; 0],   f_dot = f_z . z_dot,   G_dot = sum (f'' z_dot) [X; 1]^T + f_z [X_dot; 0]^T.
/// No rotation vector, no arm and no curvature enters, so that agreement with the reverse maps checks those.
#pragma once

#include <vector>

#include "core/measure/measure.hpp"

namespace fettle::adjoint::measure {

struct PosesAndChanges {
    const std::vector<core::kinematics::Pose>& poses;
    const std::vector<Matrix34>& poses_dot;                          ///< per body
    const std::vector<core::measure::FrameGradient>& placement_dot;  ///< per frame
};

struct MeasureTangent {
    double value_dot = 0;
    Matrix34 gradient_a = Matrix34::Zero(), gradient_b = Matrix34::Zero();          ///< G in the two bodies' P
    Matrix34 gradient_a_dot = Matrix34::Zero(), gradient_b_dot = Matrix34::Zero();  ///< their changes
};
MeasureTangent measure_tangent(const core::measure::MeasureSet& set, const core::measure::Measure& measure, const PosesAndChanges& at);

}  // namespace fettle::adjoint::measure
