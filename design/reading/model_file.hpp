// SPDX-License-Identifier: MIT
/// The files that people bring: which kind a file is, and a model from a scene or a design.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "core/scene/read_options.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::reading {

enum class FileKind { scene, design, trajectory, mesh, certificate };
/// Meshes by extension, the rest by the keys in the file; what cannot be read counts as a scene, whose reader then says why.
FileKind file_kind(const std::string& path);

/// A scene; of a part file (NAME.part.json) that of the part alone, at its defaults, called NAME, which stands still.
Result<core::scene::Scene> read_scene_or_part(const std::string& path, const core::scene::ReadOptions& options);

/// That the file is a trajectory or a certificate, where a `wanted` ("scene") is: empty, if it is neither.
Errors not_wanted(const std::string& path, FileKind kind, const std::string& wanted);

struct InputOptions {
    std::vector<std::string> mesh_dirs;     ///< also looked in for meshes
    Programs programs = Programs::refused;  ///< may parts be made by the programs that a scene names?
    bool strict = false;                    ///< faults of meshes that are warnings else are errors
    bool check_start = true;                ///< false: a scene whose bodies intersect at the start is taken all the same
    std::function<bool()> should_stop;      ///< optional, asked often
    std::string scenario;                   ///< of a design: which is taken; empty: the first
    bool as_made = false;                   ///< of a design: numbers with tolerances are parameters (DesignReadOptions)
    std::string process = {};               ///< as made: in place of the design's
};

/// A scene or a design, opened once: a model to simulate, and for how many steps (negative: the model's own end time).
struct LoadedModel {
    FileKind kind = FileKind::scene;
    core::model::Model model;
    std::string scene_path;
    int steps = -1;
    std::vector<std::string> warnings;                      ///< of the files, the meshes and the start
    std::shared_ptr<const problem::DesignProblem> problem;  ///< of a design; else null
    std::vector<description::Choice> choices = {};          ///< of a design
    std::vector<description::ChoiceCondition> conditions = {};
};

/// From a scene, or from a design at its parameters' values, in one of its scenarios. Errors: a file that is neither (a mesh, a table,
/// another program's file) is named with what is read instead; with `strict` its warnings too. @param kind  of the file
Result<LoadedModel> load_model(const std::string& path, FileKind kind, const InputOptions& options);
Result<LoadedModel> load_model(const std::string& path, const InputOptions& options);

/// The same of a design in hand, at these values of its parameters. Errors: no such scenario, what cannot be made there.
Result<LoadedModel> loaded_design(DesignFile file, const VectorX& values, const std::string& scenario = {});

/// Which of the design's scenarios is called so; "": the first. Errors (unknown_key): none is. @param path  of the file, for messages
Result<int> scenario_of(const description::Design& design, const std::string& name, const std::string& path);

/// Opens a design, for commands that take nothing else, with all of its scenarios. Errors: one is asked for; a file that is something else
/// by its name and first character is named with what is read instead; with `strict` also faults of its meshes, and doubts about its scene.
Result<DesignFile> open_design(const std::string& path, const InputOptions& options);

/// What `strict` makes of warnings.
Errors as_errors(const std::vector<std::string>& warnings, const std::string& file);

}  // namespace fettle::design::reading
