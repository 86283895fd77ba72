// SPDX-License-Identifier: MIT
/// Reads scene files: our own (*.scene.json, described by scene.schema.json and README.md beside this file) and, detected by their keys,
/// the source paper's (paper_scenes/fixture_reader.hpp). Everything in the returned Scene is SI. Whether the bodies can be simulated:
/// setup/build_model.hpp.
///
///     const auto options = design::reading::scene_read_options();  // makes the parts that the file names; else meshes alone
///     const auto scene = core::scene_files::read_scene("hinge.scene.json", options);
///     for (const auto& error : scene.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!scene) return 3;
///     for (const auto& body : scene->bodies) std::printf("%s\n", body.name.c_str());
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/scene/read_options.hpp"

namespace fettle::core::scene_files {

/// @return the scene, or every fault of the file (not of its meshes' geometry), each with file and JSON pointer.
base::Result<scene::Scene> read_scene(const std::string& path, const scene::ReadOptions& options = {});

/// The same of a document in hand, which reads numbers for the scene while this runs.
base::Result<scene::Scene> read_scene(files::JsonDocument& document, const scene::ReadOptions& options = {});

/// The `variables` of a scene's document, as the file and the inputs have them; those that have faults are left out: reading the scene
/// reports them.
std::vector<scene::Variable> variables_of(files::JsonDocument& document, const std::vector<scene::FormulaInput>& inputs = {});

/// The same from text; `path` stands in messages, and meshes are looked for as if the text came from there.
base::Result<scene::Scene> parse_scene(const std::string& text, const std::string& path, const scene::ReadOptions& options = {});

}  // namespace fettle::core::scene_files
