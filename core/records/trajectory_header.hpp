// SPDX-License-Identifier: MIT
/// Reads the first line of a trajectory file: bodies with their meshes, and where they start. Faults are added to the document's errors.
#pragma once

#include <cstddef>
#include <vector>

#include "core/files/json_document.hpp"
#include "core/records/stored_trajectory.hpp"

namespace fettle::core::records {

/// The range of every number in these files.
inline constexpr files::NumberRange stored_numbers{-1e30, 1e30, false};

/// Bodies without the parts that follow from their meshes (model::complete_geometry), and poses[0].
void read_trajectory_header(const files::JsonNode& root, StoredTrajectory& out);

/// Does `list` have `count` entries? If not, a fault.
bool has_entries(const std::vector<files::JsonNode>& list, std::size_t count, const files::JsonNode& node, const char* what);

/// `count` numbers within stored_numbers; empty, with a fault, if they are not that.
std::vector<double> read_row(const files::JsonNode& node, std::size_t count, const char* what);

/// One pose per body: a rotation to rounding and a position.
std::vector<kinematics::Pose> read_pose_list(const files::JsonNode& node, std::size_t count);

}  // namespace fettle::core::records
