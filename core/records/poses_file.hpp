// SPDX-License-Identifier: MIT
/// Poses from any other program (CAD, multibody dynamics, motion capture, a spreadsheet) as a trajectory that can be certified. The scene
/// supplies bodies and meshes; the file says where their file frames are: a point x of the mesh file is at R x + p in the world.
///
/// The path between two poses of a body is straight in the chart of docs/method/kinematics.md#charts: the body's reference point
/// (model/model.hpp: its centre of mass, unless the scene names another) moves straight, and R(s) = exp(s [theta]) R_t with theta the
/// rotation vector of R_{t+1} R_t^T: a turn at constant rate about one direction. Certificates are about that path. What turns about an
/// axis elsewhere, such as a crank, cuts the corner: by |dq|/2 tan(|theta|/4), which falls with the square of the number of poses
/// (PosesFile::largest_cut). A file that is too coarse should be written with more poses; a turn of more than 170 degrees between two of
/// them, which could have gone either way, is refused.
///
/// Bodies that the file does not name stay where the scene puts them. Formats (length unit: um, mm, cm, m, in, ft; times in seconds,
/// strictly increasing, not necessarily even; `#` begins a comment line in CSV):
///
///   CSV   one header row, then one row per time and body; rows of one time stand together.
///             time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz
///             0,crank,0,0,12.5,1,0,0,0
///         Rotation: qw qx qy qz (unit quaternion), or rx ry rz (rotation vector [rad]; rx[deg] ry[deg] rz[deg]), or r11 r12 r13 r21 ..
///         r33 (matrix, row by row). Columns in any order. A name with a comma stands in double quotes. The unit stands in brackets after
///         px, py and pz, or is handed in by the caller.
///   JSON  { "fettle_poses": 1, "units": "mm", "rotation": "quaternion" | "rotation_vector" | "matrix",
///           "times": [0, 0.01, ...],
///           "bodies": { "crank": [[px, py, pz, qw, qx, qy, qz], ...one per time], ... } }
///         Angles in radians. Numbers of a pose: 3 + 4, 3 + 3 or 3 + 9.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

struct PosesFile {
    stepper::Trajectory trajectory;      ///< one straight segment per step; `times` set unless they are even
    std::vector<std::string> still;      ///< bodies of the model that the file does not name
    double largest_rotation_error = 0;   ///< what was taken off the worst rotation to make it one: max |R^T R - I| or ||q| - 1|
    std::optional<double> largest_turn;  ///< between two poses of a body [rad]; nothing if there is one time only
    double largest_cut = 0;  ///< how far a reference point would leave the path between two poses if it went round an axis instead [m]
};

/// Rotations are checked (orthonormal and right-handed to 1e-4; quaternions of length 1 to 1e-4) and replaced by the nearest rotation
/// where they are not one to rounding.
/// @param length_unit  [m]; for a CSV that names none. It must not contradict one that the file names.
/// Errors: place (file and line, or file and JSON pointer) of every fault: columns, numbers, unknown bodies with the nearest name, bodies
/// missing at a time or twice, times that do not increase, rotations that are none, turns near pi.
base::Result<PosesFile> read_poses(const std::filesystem::path& path, const model::Model& model, std::optional<double> length_unit = {});

/// The configurations at the ends of the steps, of all bodies: CSV with matrices, or JSON if `path` ends in .json; lengths in
/// `unit` (um, mm, cm, m, in, ft). What stands between (nodes of a step's path that is not straight) is not written.
[[nodiscard]] base::Errors write_poses(const std::filesystem::path& path, const stepper::Trajectory& trajectory, const model::Model& model,
                                       const std::string& unit);

/// Is this a JSON file of poses, as far as its keys show?
bool is_poses_file(const std::filesystem::path& path);

}  // namespace fettle::core::records
