// SPDX-License-Identifier: MIT
/// What the readers of files of poses (poses_file.hpp, which documents the formats) share: a table of poses by time and body, and one
/// pose from its numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"

namespace fettle::core::records {

enum class RotationForm { quaternion, rotation_vector, matrix };
const std::vector<std::string_view>& rotation_form_names();  ///< in the order of RotationForm
int number_count(RotationForm form);                         ///< 4, 3, 9

struct PoseEntry {
    kinematics::Pose pose;  ///< of the file's frame [m]
    std::string where;
};

struct PosesTable {
    std::vector<double> times;                                   ///< [s]
    std::vector<std::string> time_where;                         ///< place of each
    std::vector<std::vector<std::optional<PoseEntry>>> entries;  ///< [t][body of the model]
    double largest_rotation_error = 0;                           ///< poses_file.hpp
};

/// The nearest rotation to what the numbers say (angles in radians). Errors: it is none to 1e-4 (`where`); then nothing.
std::optional<Matrix3> rotation_from_numbers(RotationForm form, const std::vector<double>& numbers, const std::string& where,
                                             PosesTable& table, base::Errors& errors);

/// Index of a body by name. Errors: there is none; the nearest, or all of them.
std::optional<int> body_by_name(const model::Model& model, const std::string& name, const std::string& where, base::Errors& errors);

/// Reads the CSV format. `name` is the file's in messages.
base::Result<PosesTable> read_poses_csv(std::string_view text, const std::string& name, const model::Model& model,
                                        std::optional<double> length_unit);

}  // namespace fettle::core::records
