// SPDX-License-Identifier: MIT
/// Certified clearance over all positions of the joints: for pairs of bodies,
///   lower <= min over every combination of the coordinates in their ranges of dist(A(u), B(u)) <= upper,
/// rounding charged to `lower`. A theorem about the meshes as stored and the joints as the linkage has them, not about samples.
/// docs/method/clearance.md#ranges-of-joints.
///
///     const auto ranges = core::clearance::joint_ranges(model);
///     for (const auto& error : ranges.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!ranges) return 3;
///     const std::vector<core::clearance::PairRequest> pairs{{.a = 0, .b = 1, .minimum = 0.3e-3}};
///     for (const auto& pair : core::clearance::certify(model, *ranges, pairs, core::clearance::usual_options(pairs)))
///         std::printf("%s: from %g to %g m\n", core::clearance::to_string(pair.status), pair.lower, pair.upper);
#pragma once

#include <memory>
#include <vector>

#include "core/clearance/joint_ranges.hpp"
#include "core/clearance/pair_clearance.hpp"

namespace fettle::core::clearance {

class BoxCertification;

/// Bounds for each pair asked for, in their order; judged as over a path, by the same function. The witness attains `upper`, in the world,
/// with what moves both bodies at its start; its step is -1. PairRequest::far has no effect, and nothing is reported about overlap, touch,
/// times, nodes and margins: these are of a path.
std::vector<PairClearance> certify(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options);

/// The same over one part of the ranges after another: what is made of the bodies' meshes is made once.
class RangeClearances {
public:
    /// @param pairs  All that will be asked for. Contract: the model stays where it is.
    RangeClearances(const model::Model& model, JointRanges ranges, std::vector<PairRequest> pairs, ClearanceOptions options);
    ~RangeClearances();
    RangeClearances(const RangeClearances&) = delete;
    RangeClearances& operator=(const RangeClearances&) = delete;

    JointRanges& ranges() { return ranges_; }  ///< their low and high may be changed, beyond the start as well
    ClearanceOptions& options() { return options_; }
    std::vector<PairClearance> over(std::vector<PairRequest> pairs);

private:
    JointRanges ranges_;
    std::vector<PairRequest> pairs_;
    ClearanceOptions options_;
    std::unique_ptr<BoxCertification> certification_;
};

/// The same with its certificate, which leaves out what could not be measured.
ProvenClearances certify_with_proof(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options);

/// Where two bodies are nearest in each part of their ranges, which are divided into about so many equal boxes (at least two along each
/// coordinate), of the parts in which they come within `reach` [m] of each other. The counterpart of nearest_by_window (clearance.hpp):
/// found to within `tolerance` [m], `lower` and the verdict are not filled in. Nothing where no coordinate moves one against the other, or
/// too many do.
std::vector<PairClearance> nearest_by_part(const model::Model& model, const JointRanges& ranges, const PairRequest& pair, int parts,
                                           double reach, double tolerance);

/// Poses of all bodies where the linkage's coordinates are `at`, within their ranges or not. Contract: a number for each coordinate.
std::vector<kinematics::Pose> poses_at(const model::Model& model, const JointRanges& ranges, const std::vector<double>& at);

/// Pose of a body, of any, at a pair's witness: what moves both of the pair stays where it is at the start.
kinematics::Pose pose_at_witness(const model::Model& model, const JointRanges& ranges, const PairClearance& pair, int body);

}  // namespace fettle::core::clearance
