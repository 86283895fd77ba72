// SPDX-License-Identifier: MIT
/// Trajectories as files that can be certified again without anything else: they hold the bodies' meshes and the continuous path, every
/// number as the shortest decimal that reads back to the same double, bit for bit. What they do not hold is mass: to go on with a
/// simulation takes its scene too.
///
/// One JSON object (*.trajectory.json), lengths in metres, times in seconds, angles in radians:
///   fettle_trajectory  1, the version of this format
///   scene              path of the scene as it was given, "" if there was none
///   geometry_hash      FNV-1a, 64 bits, hexadecimal, over names and meshes (geometry_hash below): tells whether a scene's meshes are those
///                      that this trajectory was computed with; checked against `bodies` when read
///   length_unit, dhat, dmin        of the scene file [m], the contact model's activation distance and minimum separation [m]
///   time_start, timestep
///   times      only where the steps are not even: of each of `poses`, increasing; timestep is then their mean
///   bodies  list of { name, type "dynamic" | "static" | "kinematic", group, reference_point [3], mesh { name, vertices, triangles, edges }
///   },
///           vertices x y z after x y z, relative to the reference point; triangles three indices after three; edges those of no triangle
///   poses   [t][body]: 12 numbers, rotation matrix row by row, then the position of the reference point; t = 0 .. number of steps
///   steps   [t][node][body]: 6 numbers px py pz rx ry rz. Between two nodes of step t, at s in [0, 1], a body point X is at
///           exp([r0 + s (r1 - r0)]) R X + p0 + s (p1 - p0), with R the rotation of poses[t][body]. The k-th of n segments covers
///           [t + k/n, t + (k+1)/n] time steps.
///   checkpoint  optional; what going on with the simulation takes: checkpoint_io.hpp
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/records/path_hash.hpp"
#include "fettle/core/stepper/simulation.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::records {

struct StoredTrajectory {
    stepper::Trajectory trajectory;
    model::Model model;  ///< geometry, names, groups and contact distances; no density, moments, velocities, prescribed motion or loads
    std::string scene_path;
    std::string path;  ///< of the trajectory file
    std::optional<stepper::Checkpoint> checkpoint;
};

/// FNV-1a over names, vertices (their bits, relative to the reference point), triangles and edges of all bodies.
std::uint64_t geometry_hash(const model::Model& model);

/// Written whole or not at all (base/atomic_file.hpp). Contract: the trajectory is the model's, all numbers finite.
[[nodiscard]] base::Errors write_trajectory(const std::filesystem::path& path, const stepper::Trajectory& trajectory,
                                            const model::Model& model, const std::string& scene_path = {},
                                            const stepper::Checkpoint* checkpoint = nullptr);

/// What SimulationOptions::resume takes, from a stored trajectory of `model`. Reports and outputs of its steps are not stored.
/// Errors (inconsistent): other meshes, another time step or integrator, no checkpoint.
base::Result<stepper::Simulation> resumable(const StoredTrajectory& stored, const model::Model& model);

/// Is this file a trajectory, as far as its keys tell? False for anything that cannot be read.
bool is_trajectory_file(const std::filesystem::path& path);

/// Checked: version, shapes of all lists, finite numbers, indices, rotations orthonormal to 1e-9, every step starting at its chart's origin
/// and ending at the next pose to 1e-9 of the bodies' size, the hash. Errors: place (file and JSON pointer) of every fault found.
base::Result<StoredTrajectory> read_trajectory(const std::filesystem::path& path);

}  // namespace fettle::core::records
