// SPDX-License-Identifier: MIT
/// What a clearance is asked of: bodies, and where they go: along a path, whatever it comes from, or to all positions of their joints.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/jointed_clearance.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/clearance/pairs.hpp"

namespace fettle::design::clearance {

enum class SubjectSource { as_assembled, simulated, scripted, poses, trajectory, ranges, prescribed };
const char* to_string(SubjectSource source);

struct Subject {
    core::model::Model model;  ///< its start poses are those of the trajectory; bodies moved by poses or scripts alone are kinematic
    core::stepper::Trajectory trajectory;  ///< over ranges: as assembled
    SubjectSource source = SubjectSource::as_assembled;
    std::string scene_path;
    std::optional<core::clearance::JointedPath> joints;  ///< that hold the bodies at all times, without dynamics; nothing: the path is all
    std::optional<core::clearance::JointRanges> ranges;  ///< in place of a path
    /// Within tolerances, in place of a path; `ranges` has the coordinates, none as assembled. Where joints close loops over their ranges
    /// it is there too, without a deviation.
    std::optional<core::certificate::Toleranced> toleranced;
    BodyPairs wanted;                   ///< of a design: those that it is about, which are judged whatever joins them
    std::vector<PairMinimum> required;  ///< of a design: what it requires of pairs, for its certificate
    std::string incomplete;             ///< why the motion is not whole; empty: it is, or there is none
    std::vector<std::string> warnings;  ///< of the files
    std::vector<std::string> notes;     ///< what the reader of a report should know
    std::vector<std::string> files;     ///< the meshes, where nothing else was read

    bool has_deviations() const { return toleranced && !toleranced->deviations.empty(); }
    bool moves_over_ranges() const { return source == SubjectSource::ranges || source == SubjectSource::prescribed; }
    /// Without steps there is none, wherever the poses come from.
    bool motion() const { return source != SubjectSource::as_assembled && !trajectory.steps.empty(); }
};

/// What is told of closed loops over ranges.
extern const char* const follow_note;

/// "over the ranges of the joints, within tolerances".
std::string source_text(const Subject& subject);

/// As assembled, or along a path of the model's bodies.
Subject subject_of(core::model::Model model, std::optional<core::stepper::Trajectory> trajectory = std::nullopt);
/// Over all positions of the joints.
Subject subject_over(core::model::Model model, core::clearance::JointRanges ranges);
/// Over all positions of the model's own joints, of which some may close loops. Errors: those of joint_ranges, or of looped_ranges.
Result<Subject> subject_over_joints(core::model::Model model);

/// A deviation where a pair is worst.
struct WorstDeviation {
    std::string of;
    double value = 0, lower = 0, upper = 0;  ///< [SI]
    std::string unit;                        ///< as Deviation::unit
};
/// Those that matter for the pair, and the names of the others, which are proven to have no influence on it. Contract: within tolerances.
std::vector<WorstDeviation> worst_deviations(const Subject& subject, const core::clearance::PairClearance& pair);
std::vector<std::string> deviations_without_influence(const Subject& subject, const core::clearance::PairClearance& pair);

/// Certified bounds: of the path, of the joints beside it, or over the ranges.
std::vector<core::clearance::PairClearance> certify(const Subject& subject, const std::vector<core::clearance::PairRequest>& pairs,
                                                    const core::clearance::ClearanceOptions& options);
/// The same with its certificate.
core::clearance::ProvenClearances certify_with_proof(const Subject& subject, const std::vector<core::clearance::PairRequest>& pairs,
                                                     const core::clearance::ClearanceOptions& options);

/// By how much joints widen the bounds of two bodies [m].
double joint_charge(const Subject& subject, int a, int b);

/// In a motion with dynamics, can these two push each other? Then coming close is what they are for, unless someone asks for more.
bool may_push(const Subject& subject, int a, int b);

/// Where a pair is nearest: the pose of a body, of any, as its file's frame has it.
core::kinematics::Pose pose_where_nearest(const Subject& subject, const core::clearance::PairClearance& pair, int body);

/// Calls visit(joint, value, coordinate) for each joint that moves one of the two against the other, with its own coordinate where the pair
/// is nearest: geared joints, too.
void for_joints(
    const core::clearance::JointRanges& ranges, const core::clearance::PairClearance& pair,
    const std::function<void(const core::certificate::JointCoordinate&, double, const core::certificate::LinkageCoordinate&)>& visit);

}  // namespace fettle::design::clearance
