// SPDX-License-Identifier: MIT
/// Certified clearance: proven bounds of the least distance of pairs of bodies, over the continuous curved path.
///   lower <= min over the time range of dist(A(t), B(t)) <= upper,   rounding error charged to `lower`.
/// A theorem about the meshes as stored and the path as stored (docs/method.md section 8), not about samples.
#pragma once

#include <vector>

#include "fettle/core/clearance/pair_clearance.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

/// Bounds for each pair asked for, in their order. The path of `trajectory` must be of the model's bodies.
std::vector<PairClearance> certify_clearance(const model::Model& model, const stepper::Trajectory& trajectory,
                                             const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

/// The start configuration as a trajectory without steps.
stepper::Trajectory as_assembled(const model::Model& model);

}  // namespace fettle::core::clearance
