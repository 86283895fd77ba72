// SPDX-License-Identifier: MIT
/// Over what a clearance is asked: a path of the bodies, or a tree of joints. What certifies, measures and tells takes a Domain and need
/// not know which it is.
///   path   one coordinate, the time: as stored, or where joints have the bodies at all times (jointed_clearance.hpp)
///   tree   all positions of the joints within their ranges (range_clearance.hpp); within tolerances besides, of bodies as they are made
///          (toleranced_clearance.hpp), as which loops and prescribed motions are looked at too
///
///     const auto over = core::clearance::over_joints(model);
///     if (!over) return 3;
///     const std::vector<core::clearance::PairRequest> pairs{{.a = 0, .b = 1, .minimum = 0.3e-3}};
///     for (const auto& pair : core::clearance::certify(model, *over, pairs, core::clearance::usual_options(pairs)))
///         std::printf("%s: from %g to %g m\n", core::clearance::to_string(pair.status), pair.lower, pair.upper);
#pragma once

#include <optional>
#include <vector>

#include "core/clearance/jointed_clearance.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

class Domain {
public:
    /// Nowhere: to be assigned to.
    Domain() = default;
    explicit Domain(stepper::Trajectory path, std::optional<JointedPath> joints = std::nullopt)
        : path_(std::move(path)), joints_(std::move(joints)) {}
    /// @param start  as_assembled() of the model
    Domain(stepper::Trajectory start, JointRanges ranges, std::optional<certificate::Toleranced> made = std::nullopt)
        : path_(std::move(start)), ranges_(std::move(ranges)), made_(std::move(made)) {}

    bool is_tree() const { return ranges_.has_value(); }
    /// Does the path have steps? One without is a start alone.
    bool has_steps() const { return !path_.steps.empty(); }
    bool has_deviations() const { return made_ && !made_->deviations.empty(); }

    const stepper::Trajectory& path() const { return path_; }                    ///< of a tree: the start, without steps
    const JointedPath* joints() const { return joints_ ? &*joints_ : nullptr; }  ///< of a path that joints hold; else null
    const JointRanges* ranges() const { return ranges_ ? &*ranges_ : nullptr; }  ///< of a tree; else null
    const certificate::Toleranced* made() const {
        return made_ ? &*made_ : nullptr;
    }  ///< of a tree whose bodies deviate, or that closes
       ///< loops, or that motors drive; else null

private:
    stepper::Trajectory path_;
    std::optional<JointedPath> joints_;
    std::optional<JointRanges> ranges_;
    std::optional<certificate::Toleranced> made_;
};

/// The model's start alone.
Domain as_started(const model::Model& model);

/// All positions of the model's own joints, of which some may close loops. Errors: those of joint_ranges, or of looped_ranges.
base::Result<Domain> over_joints(const model::Model& model);

/// Bounds for each pair asked for, in their order, of a path with `options.motion` over its steps.
std::vector<PairClearance> certify(const model::Model& model, const Domain& over, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options);

/// The same with its certificate, which leaves out what could not be measured.
ProvenClearances certify_with_proof(const model::Model& model, const Domain& over, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options);

/// Pose of a body, of any, at a pair's witness: what does not matter for the pair is where it starts.
kinematics::Pose pose_at_witness(const model::Model& model, const Domain& over, const PairClearance& pair, int body);

}  // namespace fettle::core::clearance
