// SPDX-License-Identifier: MIT
/// Reads design files (*.design.json), described by design.schema.json beside this file. Rewriting: design_text.hpp.
///
///     const auto file = design::reading::read_design("hinge.design.json");
///     for (const auto& error : file.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!file) return 3;
///     for (const auto& p : file->design.parameters) std::printf("%s: %g, from %g to %g\n", p.name.c_str(), p.value, p.lower, p.upper);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/read_record.hpp"
#include "core/base/result.hpp"
#include "core/files/json_document.hpp"
#include "design/description/choice.hpp"
#include "design/description/design.hpp"
#include "design/description/tolerance.hpp"
#include "design/quantities/expression.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/reading/tolerance_reader.hpp"

namespace fettle::design::reading {

/// A design and what its file says besides.
struct DesignFile {
    description::Design design;
    std::string path, text;  ///< of the file, and its contents
    std::string scene_path;
    Unit length_unit;    ///< of the file
    std::string output;  ///< folder, absolute or relative to the working directory, below that of the file; empty: not said
    std::vector<std::string> warnings;
    std::vector<quantities::NamedQuantity> quantities = {};     ///< of its `quantities`
    std::vector<description::Tolerance> tolerances = {};        ///< of a design read as made
    std::vector<Untoleranced> untoleranced = {};                ///< what "*" of its tolerances leaves out
    std::vector<description::Choice> choices = {};              ///< of the file, by name
    std::vector<description::ChoiceCondition> conditions = {};  ///< relations that follow from them alone
    std::string process = {};                                   ///< that makes what entries say no other of; empty: none
    core::base::ReadRecord::Files files = {};                   ///< that it was read from, besides its own
    std::string read_as = {};                                   ///< what of the options its numbers depend on
};

/// How many times as fine as the files say. Contract: both at least 1.
struct Resolution {
    int facets = 1;  ///< along what is round, of parts that are files
    int steps = 1;   ///< in time
};

struct DesignReadOptions {
    std::vector<std::string> mesh_dirs = {};  ///< also looked in for meshes
    Programs programs = Programs::refused;    ///< scene_shapes.hpp
    Resolution resolution = {};
    /// Each number with a tolerance becomes a parameter, after the design's own (description/tolerance.hpp).
    bool as_made = false;
    std::string process = {};  ///< in place of the design's: a name, or a file, from the working directory; empty: the design's
    /// Parts that need not be made again; gets those that are made. Null: there are none.
    std::shared_ptr<std::vector<MadePart>> made = {};
};

/// Reads a design and its scene. @return the design, or every fault of both files, each with its file and JSON pointer; bodies, dimensions
/// and keys that do not exist come with the nearest that does.
Result<DesignFile> read_design(const std::string& path, const DesignReadOptions& options = {});
/// The same of a text in hand; `path` is the file's name in messages, and says where the scene is looked for.
Result<DesignFile> parse_design(const std::string& text, const std::string& path, const DesignReadOptions& options = {});

/// Is this file a design (has it the key `fettle_design`), rather than a scene? False if it cannot be read.
bool is_design_file(const std::string& path);
bool is_design(core::files::JsonDocument& document);

}  // namespace fettle::design::reading
