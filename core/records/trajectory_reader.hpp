// SPDX-License-Identifier: MIT
/// Reads a trajectory file line by line, and checks it. What is checked: trajectory_io.hpp.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.hpp"
#include "core/records/stored_trajectory.hpp"

namespace fettle::core::records {

/// @param path  of the file, for messages; `text` is what it holds.
base::Result<StoredTrajectory> parse_trajectory(const std::string& path, std::string_view text);

}  // namespace fettle::core::records
