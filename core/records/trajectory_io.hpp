// SPDX-License-Identifier: MIT
/// Trajectories as files that can be certified again without anything else: they hold the bodies' meshes and the continuous path, every
/// number as the shortest decimal that reads back to the same double, bit for bit. What they do not hold is mass: to go on with a
/// simulation takes its scene too (continuation.hpp).
///
/// JSON objects, one per line (*.trajectory.json), so that a file can be appended to step by step; lengths in metres, times in seconds,
/// angles in radians. The first line:
///   fettle_trajectory  2, the version of this format (version 1 was one object over many lines; it is refused)
///   scene              path of the scene as it was given, "" if there was none
///   geometry_hash      FNV-1a, 64 bits, hexadecimal, over names, meshes and mass_per (geometry_hash.hpp): shows whether a scene has
///                      the meshes that this trajectory was computed with; checked against `bodies` when read
///   length_unit, dhat, dmin        of the scene file [m], the contact model's activation distance and minimum separation [m]
///   time_start, timestep
///   bodies  list of { name, type "dynamic" | "static" | "kinematic", group, reference_point [3], mass_per (where it is not "volume":
///           then an open mesh is meant to have no inside, unless it is suggested by the mesh alone: mass_per_given false), mesh { name,
///           vertices, triangles, edges } }, vertices x y z after x y z, relative to the reference point; triangles three indices after
///           three; edges those of no triangle
///   time    only where the steps are not even: at the start; timestep is then their mean
///   poses   [body], at the start: 12 numbers, rotation matrix row by row, then the position of the reference point
/// Then a line for each time step:
///   nodes      [node][body]: 6 numbers px py pz rx ry rz. Between two nodes, at s in [0, 1], a body point X is at
///              exp([r0 + s (r1 - r0)]) R X + p0 + s (p1 - p0), with R the body's rotation at the start of the step
///   fractions  optional, [node]: which share of the step's time has passed there, from 0 to 1; without it node k of n + 1 is at k/n
///   time       at the step's end, if the first line has one
///   poses      [body], at the step's end, as above
///   hash       optional: path_hash (path_hash.hpp) of the path up to here, hexadecimal; checked when read
/// and anywhere between them
///   checkpoint  optional, the last one counts; what going on with the simulation takes: checkpoint_io.hpp
///
/// The path is one: each step's first node is the pose before it, bit for bit, with rotation vector 0; its last node has the position of
/// the pose after it, bit for bit, and its rotation to the rounding of exp, u (80 + 10 |r|), u = 2^-53. Every certified bound is charged
/// more than that for rounding, so that what is certified of the segments is certified of the whole path.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.hpp"
#include "core/files/atomic_file.hpp"
#include "core/model/model.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/path_hash.hpp"
#include "core/records/stored_trajectory.hpp"
#include "core/stepper/simulation.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

/// Written whole or not at all (files/atomic_file.hpp). Line by line: trajectory_lines.hpp.
/// Contract: the trajectory is the model's, all numbers finite.
[[nodiscard]] base::Errors write_trajectory(const std::filesystem::path& path, const stepper::Trajectory& trajectory,
                                            const model::Model& model, const std::string& scene_path = {},
                                            const stepper::Checkpoint* checkpoint = nullptr);

/// The same as one of a set of files, line by line as it is made.
[[nodiscard]] base::Errors add_trajectory(files::FilesTogether& files, const std::filesystem::path& path,
                                          const stepper::Trajectory& trajectory, const model::Model& model,
                                          const std::string& scene_path = {}, const stepper::Checkpoint* checkpoint = nullptr);

/// Is this file a trajectory, as far as its keys show? False for anything that cannot be read.
bool is_trajectory_file(const std::filesystem::path& path);

/// Checked: version, shapes of all lists, numbers finite and at most 1e30, indices, rotations orthonormal to 1e-14, that the path is one
/// (as above), the hashes. A last line that is cut off (no line feed, and no whole object) is left out with a warning. Errors: place (file,
/// line and JSON pointer) of every fault of the first line that has any.
base::Result<StoredTrajectory> read_trajectory(const std::filesystem::path& path);

}  // namespace fettle::core::records
