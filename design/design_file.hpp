// SPDX-License-Identifier: MIT
/// Reads and rewrites design files (*.design.json), described by design.schema.json beside this file.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/design.hpp"

namespace fettle::design {

struct DesignReadOptions {
    std::vector<std::string> mesh_dirs;  ///< also looked in for meshes
};

/// Reads a design and its scene. @return the design, or every fault of both files, each with its file and JSON pointer; bodies, dimensions
/// and keys that do not exist come with the nearest that does.
Result<Design> read_design(const std::string& path, const DesignReadOptions& options = {});

/// Is this file a design (has it the key `fettle_design`), rather than a scene? False if it cannot be read.
bool is_design_file(const std::string& path);

/// The design file with other parameter values (SI), to be written in folder `directory` (for the relative path of the scene). All else is
/// as it was, comments of `description` included. Values that are representable (parameter_units.hpp)
/// read back as the same bits.
std::string design_text(const Design& design, const VectorX& values, const std::string& directory);

/// Hash of all that an evaluation's numbers depend on: the program's version, the design without optimiser and output, the scene and its
/// meshes.
std::string design_hash(const Design& design);

}  // namespace fettle::design
