// SPDX-License-Identifier: MIT
/// Simulated motion and proven clearances, in the order in which one meets them: a scene is read or made, a model built from it, its motion
/// simulated, clearances certified. Everything else under core/ is what these are made of.
#pragma once

// A scene: as data, and read from its file.
#include "core/scene/scene.hpp"
#include "core/scene_files/scene_reader.hpp"
// The model that is built from it, const from then on.
#include "core/setup/build_model.hpp"
// Its motion: by dynamics, or where scripts or joints and motors say everything.
#include "core/stepper/jointed_motion.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "core/stepper/simulate.hpp"
// Certified clearances over a domain: a motion, joints met at all times, ranges of joints, tolerances; where joints are free; and who does
// not trust us checks them.
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/domain.hpp"
#include "core/clearance/free_ranges.hpp"
// Files: trajectories and meshes, and whether a mesh is what it should be.
#include "core/solids/mesh_judgement.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/records/trajectory_io.hpp"
// Results and their errors, units, threads.
#include "core/base/parallel.hpp"
#include "core/base/result.hpp"
#include "core/base/units.hpp"
#include "core/base/version.hpp"
