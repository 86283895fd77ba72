// SPDX-License-Identifier: MIT
/// Folders and files that results go to: tried before the work, and never at the cost of a longer run that is there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

namespace fettle::design::answers {

/// Can files be made in `folder`? It is made if it is not there; a file is written in it and taken away again.
/// Errors: file_unwritable, with the reason. Call it when the input has been read, before minutes of work.
[[nodiscard]] Errors try_output_folder(const std::filesystem::path& folder);

/// The same of a folder for the results of a run, in which nothing of another program may be replaced (answers/run_folder.hpp).
/// @param more  names of files that this run writes beside what every run does.
[[nodiscard]] Errors try_run_folder(const std::filesystem::path& folder, const std::vector<std::string>& more = {});

/// The same of a file that is to be written, by its folder, or by itself where a pipe or a device stands there. A folder in its place is a
/// fault too, and so is a scene, a design or a mesh: nobody wants these replaced by a table or a log.
[[nodiscard]] Errors try_output_file(const std::filesystem::path& file);

/// If `file` is a trajectory of more than `steps` steps: the name to keep it under when it is replaced, the first of trajectory.1.json,
/// trajectory.2.json, ... that is free. Else empty.
std::string name_for_longer_run(const std::filesystem::path& file, std::size_t steps);

}  // namespace fettle::design::answers
