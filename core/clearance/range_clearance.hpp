// SPDX-License-Identifier: MIT
/// Certified clearance over all positions of the joints: for pairs of bodies,
///   lower <= min over every combination of the coordinates in their ranges of dist(A(u), B(u)) <= upper,
/// rounding charged to `lower`. A theorem about the meshes as stored and the joints as the linkage has them, not about samples.
/// docs/method.md section 8.
#pragma once

#include <vector>

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/clearance/joint_ranges.hpp"
#include "fettle/core/clearance/pair_clearance.hpp"

namespace fettle::core::clearance {

struct RangeClearanceOptions {
    double tolerance = 1e-6;      ///< between the bounds, of pairs with one or two coordinates [m]
    double coarse = 0;            ///< the same of pairs with more, as a share of the bodies' radii; 0: `tolerance`
    long max_bounds = 4'000'000;  ///< per pair of bodies; beyond it: undecided with true bounds
    std::function<void(int done, int of)> on_pair;
    std::function<bool()> should_stop;
    certificate::Certificate* certificate = nullptr;  ///< optional: the proofs are recorded here; `lower` is what they claim
};

/// Where nothing is asked for: 10 um, or 1% of the least minimum that is required; with more than two coordinates 1% of the bodies' radii.
RangeClearanceOptions usual_options(const std::vector<PairRequest>& pairs);

/// A verdict as over a path (pair_clearance.hpp), judged by the same function. The witness attains `upper`, in the world, with what moves
/// both bodies at its start; its step is -1. Nothing is told of overlap, touch, times, nodes and margins: these are of a path.
struct RangeClearance : PairClearance {
    double tolerance = 0;          ///< that was asked for, of this pair
    std::vector<int> coordinates;  ///< of the linkage: those that move one body against the other
    std::vector<double> at;        ///< their values at the witness
    long bounds = 0;               ///< computed
};

/// Bounds for each pair asked for, in their order; PairRequest::far counts for nothing.
std::vector<RangeClearance> certify_ranges(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                           const RangeClearanceOptions& options);

/// Pose of a body, of any, at a pair's witness: what moves both of the pair stays where it is at the start.
kinematics::Pose pose_at_witness(const model::Model& model, const JointRanges& ranges, const RangeClearance& pair, int body);

}  // namespace fettle::core::clearance
