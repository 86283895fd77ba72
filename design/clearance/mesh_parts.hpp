// SPDX-License-Identifier: MIT
/// Mesh files as a scene: parts where the files have them, nothing moves. For checks of a CAD project without a scene file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/files/unique_names.hpp"
#include "core/model/model.hpp"
#include "design/reading/model_file.hpp"
#include "design/reading/step_wishes.hpp"

namespace fettle::design::clearance {

/// The trajectory of a run's folder, a killed run's too; nothing where the path is none.
std::optional<std::string> trajectory_in(const std::string& path);

/// Meshes by their extension, or a folder that has no trajectory. In a list the first decides.
bool are_meshes(const std::vector<std::string>& paths);

/// What is to be said of a part of a mesh file whose longest side is hardly meant; empty: nothing. Files without a unit are nearly always
/// in mm, and parts that are printed below 300 mm: of a longer one in another unit its size in mm is told.
/// @param side  Longest side of its box [m].
/// @param unit  That of --unit; empty: the file states its own.
std::string doubted_side(double side, const std::string& unit);

/// What lists of pairs can name, and no other body has: the name of a file or an item as a body's.
std::string body_name(const std::string& of_file, core::files::UniqueNames& names);

/// Where a body comes from.
struct MeshSource {
    std::string file, item;  ///< item: of a file that has several, as core::mesh_files::item_called takes it; else empty
    int solid = 0;           ///< of a mesh that was split: counted from 1; 0: all of it
};

struct MeshParts {
    core::model::Model model;         ///< all static; length_unit is --unit, else of 3MF the millimetre
    std::vector<MeshSource> sources;  ///< [body]
    std::vector<std::string> files;
    std::vector<std::string> warnings;
};

/// What `--unit auto` stands for: mm, m or um, in which the largest part of the files is of a size that people print or cut (0.3 mm to 3
/// m); a warning tells it, with that size. Empty: every file states its own.
std::string proposed_unit(const std::vector<std::string>& files, std::vector<std::string>& warnings);

/// Bodies: one for each file, called as it without its extension; of a 3MF one for each item of its build, where the build places it,
/// called as its object; of a STEP file one for each solid. A name that is taken gets " 2", " 3"; `:` and `,`, which lists of pairs are
/// written with, become `_`. A folder stands for the meshes in it, in the order of their names; a warning says that those in folders below
/// it are left out. Meshes are mended and judged as those of a scene.
/// @param unit  of files that state none: "mm"; "auto": proposed by the size of the largest part, which a warning tells; empty: not given.
/// @param split  each solid of a mesh is a body of its own, with its cavities: "box#1", "box#2", in the order of their first triangles
/// Errors: of the files; missing_key (--unit is needed), out_of_range (no unit, or fewer than one part), inconsistent (a path that is
/// neither a mesh nor a folder among meshes).
Result<MeshParts> load_meshes(const std::vector<std::string>& paths, const std::string& unit, const reading::InputOptions& input,
                              bool split = false, const reading::StepWishes& step = {});

}  // namespace fettle::design::clearance
