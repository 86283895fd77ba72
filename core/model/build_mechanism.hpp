// SPDX-License-Identifier: MIT
/// Joints, springs, motors and loads of a scene -> measures, rows and terms of a model whose bodies are known; and the start: bodies are
/// put where their joints are met (constraint/assembly.hpp), and their velocities are made to agree.
/// docs/method/joints.md#assembly-the-start.
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"

namespace fettle::core::model {

/// What terms take of the bodies besides their frames. A design's trials have those of the design as written, so that they are no hidden
/// function of its parameters.
struct TermScales {
    std::optional<double> stop_stiffness;  ///< [N/m]; else choose_stop_stiffness's
    std::vector<double> radii;             ///< per body [m]: the lever of angles in stops and friction; empty: the bodies' own
};

/// Adds Model::mechanism; moves pose_start and velocity_start of dynamic bodies as little as their masses allow, with a warning of each
/// body that had to. Rows that follow from others are left out, with a warning.
/// Contract: bodies, masses, dhat and diagonal of the model are set. Stops have no stiffness yet (stiffen_stops): they take it from kappa,
/// which depends on the springs that this adds (choose_kappa.hpp).
///
/// Errors: names that are not there, branches that cannot be said so (branch_of_joint.hpp) or on which a loop does not close, joints of a
/// body with itself, axes of length 0, motors that turn by half a turn in a time step (inconsistent, out_of_range); loops that cannot be
/// closed, with the joints and the gaps that remain; joints that contradict one another; what starts beyond its limits (limits.hpp);
/// Newmark, which has no rows (unsupported).
base::Errors build_mechanism(const scene::Scene& scene, Model& model, const TermScales& scales = {});

/// Gives the stops of joints and springs their stiffness: that of the scales, else choose_stop_stiffness's.
/// Contract: kappa of the model is set.
void stiffen_stops(Model& model, const TermScales& scales = {});

}  // namespace fettle::core::model
