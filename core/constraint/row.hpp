// SPDX-License-Identifier: MIT
/// Rows: equations sum_i factor_i m_i = curve(t) over measures (measure/measure.hpp). Joints, motors and gears are lists of them.
/// docs/method/joints.md#rows.
#pragma once

#include <vector>

#include "core/linear/matrices.hpp"
#include "core/measure/measure.hpp"
#include "core/scene/curve.hpp"

namespace fettle::core::constraint {

using linear::RowGradient;
using linear::RowJacobian;

struct RowPart {
    int measure = 0;
    double factor = 1;
};

struct Row {
    int owner = -1;  ///< the joint or motor that it belongs to; for messages and reports
    std::vector<RowPart> parts;
    double constant = 0;  ///< what the parts come to besides the curve
    scene::Curve curve;   ///< empty: constant
    double length = 1;    ///< [m] that one unit is worth: 1 of offsets, a lever of angles and products
    int number = -1;      ///< its place among all rows of its mechanism, whichever of them are solved for
};

/// What a row's parts are to come to.
double target_at(const Row& row, double time);

/// Angles of measures with their turns, per measure; 0 for other measures. Turns are counted from the value before: less than half a turn a
/// step.
/// @param before  empty: angles in (-pi, pi].
std::vector<double> angles_at(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                              const std::vector<double>& before);

/// Value of a measure, an angle nearest to what it was.
double value_at(const measure::MeasureSet& set, int measure, const std::vector<measure::PlacedFrame>& frames,
                const std::vector<double>& angles);

/// sum_i factor_i m_i per row.
VectorX row_values(const measure::MeasureSet& set, const std::vector<Row>& rows, const std::vector<measure::PlacedFrame>& frames,
                   const std::vector<double>& angles);

/// In tangent coordinates (q, phi).
RowJacobian row_jacobian(const measure::MeasureSet& set, const std::vector<Row>& rows, const std::vector<measure::PlacedFrame>& frames);

/// The same in the chart, dphi = J dtheta. @param left_jacobians  J of each body.
void to_chart(const std::vector<Matrix3>& left_jacobians, RowJacobian& jacobian);

/// Adds sum_i multiplier_i d2(row_i) in the chart. The blocks of every row's bodies are there afterwards, whatever the multipliers.
void add_row_curvature(const measure::MeasureSet& set, const std::vector<Row>& rows, const VectorX& multipliers,
                       const std::vector<measure::PlacedFrame>& frames, const std::vector<Vector3>& rotation_vectors,
                       kinematics::BlockHessian& hessian);

}  // namespace fettle::core::constraint
