// SPDX-License-Identifier: MIT
/// Files that a command line names: none that is read is written to, and none is written twice. Known before anything is read or written.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/cli/command_line.hpp"

namespace fettle::design::cli {

struct NamedFile {
    std::string option;  ///< "--junit"; for a positional argument "FILE"; of what a file names that file (read_files.hpp)
    std::string file;
    bool is_written = false;
};

/// What a command was given, and where meshes are looked for.
struct GivenFiles {
    std::string command;
    std::vector<NamedFile> named;
    std::vector<std::string> mesh_dirs;
};

/// Those of the given options that name files.
std::vector<NamedFile> named_files_of(const std::string& command, const std::vector<GivenValue>& given);

/// The same, of a command line that cannot be read: the words after `written`'s options; all others count as read.
std::vector<NamedFile> named_files_in(const std::vector<std::string>& words, const std::vector<std::string>& written);

/// Those that are written and named by another option too, by whatever path. Devices, pipes and folders are nobody's.
/// Errors: inconsistent, with both options; `where` is the file as the one that would write it names it.
Errors named_twice(const std::vector<NamedFile>& files);

}  // namespace fettle::design::cli
