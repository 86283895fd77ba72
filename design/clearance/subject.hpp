// SPDX-License-Identifier: MIT
/// What a clearance is asked of: bodies, and their domain (core/clearance/domain.hpp), wherever these come from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/domain.hpp"
#include "core/model/model.hpp"
#include "design/clearance/pairs.hpp"

namespace fettle::design::clearance {

enum class SubjectSource { as_assembled, simulated, scripted, poses, trajectory, ranges, prescribed };
const char* to_string(SubjectSource source);

struct Subject {
    core::model::Model model;  ///< its start poses are those of the domain; bodies moved by poses or scripts alone are kinematic
    core::clearance::Domain domain;
    SubjectSource source = SubjectSource::as_assembled;
    std::string scene_path;
    BodyPairs wanted;                   ///< of a design: those that it is about, which are judged whatever joins them
    std::vector<PairMinimum> required;  ///< of a design: what it requires of pairs, for its certificate
    std::string incomplete;             ///< why the motion is not whole; empty: it is, or there is none
    std::vector<std::string> warnings;  ///< of the files
    std::vector<std::string> notes;     ///< what the reader of a report should know
    std::vector<std::string> files;     ///< the meshes, where nothing else was read

    bool moves_over_ranges() const { return source == SubjectSource::ranges || source == SubjectSource::prescribed; }
    /// Without steps there is none, wherever the poses come from.
    bool motion() const { return source != SubjectSource::as_assembled && domain.has_steps(); }
};

/// What is told of closed loops over ranges.
extern const char* const follow_note;

/// "over the ranges of the joints, within tolerances".
std::string source_text(const Subject& subject);

/// As assembled, or along a path of the model's bodies.
Subject subject_of(core::model::Model model, std::optional<core::stepper::Trajectory> trajectory = std::nullopt);
/// Over a tree of joints of the model.
Subject subject_over(core::model::Model model, core::clearance::Domain tree);
/// Over all positions of the model's own joints, of which some may close loops. Errors: those of over_joints.
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
