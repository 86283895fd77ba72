// SPDX-License-Identifier: MIT
/// Files that a command reads because of the one that it is given: the scene of a design, meshes of a scene, the trajectory of a
/// certificate, results in a folder. No output replaces one of them (named_files.hpp says so of the files that are named).
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/cli/named_files.hpp"

namespace fettle::design::cli {

/// Through all that is given: each file with, as its option, what names it ("rod.scene.json"). A file that cannot be read names none. In a
/// scene or a design every text that is the name of a file counts.
std::vector<NamedFile> files_read(const GivenFiles& given);

/// Those of `written` that are there and that the command reads: named by its command line, or files_read().
/// Errors: inconsistent, as named_twice().
Errors replaced_inputs(const std::vector<NamedFile>& written, const GivenFiles& given);

}  // namespace fettle::design::cli
