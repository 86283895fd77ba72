// SPDX-License-Identifier: MIT
/// The files that commands take, read as the command line says (reading/model_file.hpp).
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/cli/command.hpp"
#include "design/reading/model_file.hpp"

namespace fettle::design::cli {

/// As the user allows.
reading::Programs programs_of(const CommonOptions& common);

/// What all commands have in common for reading files.
reading::InputOptions input_options(const CommonOptions& common, bool check_start = true);

/// While the file is read other threads are made, and memory for what it becomes.
void begin_to_read(const std::string& path);

using reading::file_kind;
using reading::FileKind;
using reading::LoadedModel;

/// reading/model_file.hpp, as the command line says.
Result<LoadedModel> load_model(const std::string& path, const CommonOptions& common, bool check_start = true);
Result<reading::DesignFile> open_design(const std::string& path, const CommonOptions& common);

/// On stderr, and as remarks among the checks, about `file` if there is one.
void tell_warnings(Console& console, const std::vector<std::string>& warnings, const std::string& file = {});

}  // namespace fettle::design::cli
