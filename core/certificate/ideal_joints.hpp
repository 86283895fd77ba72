// SPDX-License-Identifier: MIT
/// Joints and motors as data, for a certificate about bodies that they hold at all times. A stored path meets them at its nodes; between
/// nodes it is straight in each body's chart, and joints part a little there. Where joints and motors would have the bodies, exactly and at
/// every time, is then not the path as stored, but near it: `deviations` claims how near, and joint_prover.hpp decides whether that is so.
/// Charged with it, bounds of distances along the path as stored are bounds for the mechanism itself:
///   lower - (d_a + d_b) <= least distance <= upper + (d_a + d_b).
/// Made from a model by clearance/jointed_clearance.hpp.
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/constraint/row.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_writer.hpp"
#include "core/measure/measure.hpp"

namespace fettle::core::certificate {

struct IdealJoints {
    measure::MeasureSet set;            ///< of bodies of the model; offsets, products and angles
    std::vector<constraint::Row> rows;  ///< as many as the bodies have coordinates; at the times of the trajectory
    std::vector<int> bodies;            ///< that the rows move, all six coordinates of each, increasing; the others are where the path is
    std::vector<double> deviations;     ///< of each of `bodies`: no point of its mesh is farther from where the joints have it [m]
};

/// What bounds of two bodies' distance are charged with, d_a + d_b [m]; nothing for a body that the joints do not move.
double joint_charge(const IdealJoints& joints, int a, int b);

/// Indices of what is there, kinds of measure, numbers finite, counts. `where` is below /joints.
base::Errors check_joints(const IdealJoints& joints, std::size_t bodies);

/// Everything but the deviations alike?
bool same_joints(const IdealJoints& x, const IdealJoints& y);

/// {frames [{body, point, axes (columns)}], measures [{kind, a, b, axis_a, axis_b, along}],
///  rows [{parts [{measure, factor}], constant, curve {kind, rate, times, values, stop_time (optional)}}], bodies, deviations}
void write_joints(files::JsonWriter& out, const IdealJoints& joints);
IdealJoints read_joints(const files::JsonNode& node);

}  // namespace fettle::core::certificate
