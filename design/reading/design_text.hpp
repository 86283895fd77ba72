// SPDX-License-Identifier: MIT
/// What is done with the text of a design file: rewritten with other values, and hashed.
#pragma once

#include <string>
#include <vector>

#include "core/model/branch_of_joint.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::reading {

/// How a design in folder `directory` names the file's scene. Errors: bytes that are no UTF-8, which JSON cannot have.
Result<std::string> scene_from(const DesignFile& file, const std::string& directory);

/// The design file with other parameter values (SI), to be written in folder `directory` (for the relative path of the scene). All else is
/// as it was, comments of `description` included. Values that are representable (description/parameter.hpp)
/// read back as the same bits.
std::string design_text(const DesignFile& file, const VectorX& values, const std::string& directory);

/// The design's file with other options, all else as it was. Contract: an option for each of its choices.
/// @param values  The parameters' other values, SI; empty: they are as they were.
std::string text_with_choices(const DesignFile& file, const description::Combination& combination, const VectorX& values = {});

/// The text of the design file with closed linkages assembled on these sides, in its `set` and in no scenario's. Contract: the scene has
/// these joints.
std::string text_with_sides(const DesignFile& file, const std::vector<core::model::JointSide>& sides);

/// Hash of all that an evaluation's numbers depend on: the program's version, the design without optimiser and output, how it was read,
/// every file that was read for it (the scene, parts, meshes, processes, programs: DesignFile::files), and the meshes that came of them.
std::string design_hash(const DesignFile& file);

}  // namespace fettle::design::reading
