// SPDX-License-Identifier: MIT
/// The files that commands take: which kind a file is, and a model from a scene or a design.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

enum class FileKind { scene, design, trajectory, mesh, certificate };
/// Meshes by extension, the rest by the keys in the file; what cannot be read counts as a scene, whose reader then says why.
FileKind file_kind(const std::string& path);

/// A model to simulate, and for how many steps (negative: the model's own end time).
struct LoadedModel {
    core::model::Model model;
    std::string scene_path;
    int steps = -1;
    std::vector<std::string> warnings;
};
/// From a scene, or from a design at its parameters' values.
/// @param check_start  false: a scene whose bodies intersect at the start is taken all the same.
Result<LoadedModel> load_model(const std::string& path, const CommonOptions& common, bool check_start = true);

/// Same, with the warnings told.
void tell_warnings(Console& console, const std::vector<std::string>& warnings);

}  // namespace fettle::design::cli
