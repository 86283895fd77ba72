// SPDX-License-Identifier: MIT
/// Certified clearance over a box of tolerances: for pairs of bodies,
///   lower <= min over every combination of deviations within their limits, and of the joints' positions, of dist(A, B) <= upper.
/// A theorem about the bodies as made (certificate/toleranced.hpp): with the triangles of the meshes at hand, and vertices and joints that
/// move with the deviations by their formulas. docs/method/clearance.md#within-tolerances.
#pragma once

#include <vector>

#include "core/certificate/toleranced.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// Bounds for each pair asked for, in their order; judged as over a path, by the same function. The witness attains `upper`, in the world,
/// with everything that has no influence on the pair where it is at the base; its step is -1. As over ranges of joints
/// (range_clearance.hpp) nothing is reported about overlap, touch, times, nodes and margins.
/// Contract: the model's meshes and start poses are those of the base; `toleranced` is checked.
std::vector<PairClearance> certify(const model::Model& model, const certificate::Toleranced& toleranced,
                                   const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

/// The same with its certificate, which leaves out what could not be measured.
ProvenClearances certify_with_proof(const model::Model& model, const certificate::Toleranced& toleranced,
                                    const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

/// Pose of a body, of any, at a pair's witness: what does not matter for the pair is where it is at the base.
kinematics::Pose pose_at_witness(const certificate::Toleranced& toleranced, const PairClearance& pair, int body);

}  // namespace fettle::core::clearance
