// SPDX-License-Identifier: MIT
/// A subject (subject.hpp) from files: a scene or design and a source of motion, a trajectory, meshes as they lie.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/stepper/simulate.hpp"
#include "design/clearance/subject.hpp"
#include "design/reading/model_file.hpp"
#include "design/reading/step_wishes.hpp"

namespace fettle::design::clearance {

/// As the options of `fettle clearance`, by whose names errors call them.
struct SubjectOptions {
    std::string path;               ///< scene, design, trajectory, mesh or folder of meshes
    std::vector<std::string> more;  ///< meshes beside it
    std::string unit;               ///< of meshes that state none
    bool split = false;             ///< of meshes: each solid is a body of its own
    reading::StepWishes step = {};  ///< of STEP files among the meshes
    std::string poses, poses_unit;  ///< file of poses, and the unit of its lengths where it does not say; empty: none
    bool motion = false;            ///< simulate a scene or design
    bool kinematic = false;         ///< follow scripts, no dynamics
    bool ranges = false;            ///< all positions of the joints, in place of a path
    bool tolerances = false;        ///< all parts within the design's tolerances; beside `ranges` over these together
    std::string process;            ///< within tolerances: what makes the parts, in place of the design's; empty: the design's
    int steps = -1;                 ///< of the motion; negative: the scene's
    double time = -1;               ///< [s], instead of steps
};

struct SubjectWatch {
    std::function<void(const std::vector<std::string>&)> on_warnings;  ///< of the files, before anything is simulated
    std::function<void(const core::stepper::Progress&)> on_step;       ///< of a simulation
    std::function<bool()> should_stop = [] { return false; };          ///< the same
};

/// Errors: of the files and options, all with their places.
Result<Subject> read_subject(const SubjectOptions& options, const reading::InputOptions& input, const SubjectWatch& watch = {});

}  // namespace fettle::design::clearance
