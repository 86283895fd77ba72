// SPDX-License-Identifier: MIT
/// What `fettle clearance` judges: bodies and the path that they take, from any of the sources of motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/clearance/jointed_clearance.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"
#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

struct SubjectOptions {
    std::string path;               ///< scene, design, trajectory, mesh or folder of meshes
    std::vector<std::string> more;  ///< meshes beside it
    std::string unit;               ///< of meshes that state none
    std::string poses, poses_unit;  ///< file of poses, and the unit of its lengths where it does not say; empty: none
    bool motion = false;            ///< simulate a scene or design
    bool kinematic = false;         ///< follow scripts, no dynamics
    int steps = -1;                 ///< of the motion; negative: the scene's
    double time = -1;               ///< [s], instead of steps
};

enum class SubjectSource { as_assembled, simulated, scripted, poses, trajectory };
const char* to_string(SubjectSource source);

struct Subject {
    core::model::Model model;  ///< its start poses are those of the trajectory; bodies moved by poses or scripts alone are kinematic
    core::stepper::Trajectory trajectory;
    SubjectSource source = SubjectSource::as_assembled;
    std::string scene_path;
    std::optional<core::clearance::JointedPath> joints;  ///< that hold the bodies at all times, without dynamics; nothing: the path is all
    std::string incomplete;                              ///< why the motion is not whole; empty: it is, or there is none
    std::vector<std::string> notes;                      ///< what the reader of a report should know
    std::vector<std::string> warnings;                   ///< of the input, told on stderr when it was read
    std::vector<std::string> files;                      ///< the meshes, where nothing else was read

    /// Without steps there is none, wherever the poses come from.
    bool motion() const { return source != SubjectSource::as_assembled && !trajectory.steps.empty(); }
};

/// Certified bounds: of the path, or of the joints beside it. `certify.certificate` gets the joints, too.
std::vector<core::clearance::PairClearance> certified(const Subject& subject, const std::vector<core::clearance::PairRequest>& pairs,
                                                      const core::clearance::ClearanceOptions& certify);

/// By how much joints widen the bounds of two bodies [m].
double joint_charge(const Subject& subject, int a, int b);

/// Errors: of the files and options, all with their places.
Result<Subject> load_subject(const SubjectOptions& options, const CommonOptions& common, Console& console);

/// Are these two judged over a motion when no pairs are named? Those that may collide; where nothing is dynamic, those of which one moves;
/// where nothing moves, all; but never those of one group, nor what a joint joins.
bool judged_by_default(const core::model::Model& model, int a, int b);

/// In a motion with dynamics, can these two push each other? Then coming close is what they are for, unless someone asks for more.
bool may_push(const Subject& subject, int a, int b);

}  // namespace fettle::design::cli
