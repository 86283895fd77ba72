// SPDX-License-Identifier: MIT
/// The parts that come with the program: the files of library/, which it carries and which are installed to share/fettle/parts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/part_files/part_file.hpp"

namespace fettle::design::shapes {

struct LibraryPart {
    std::string_view name;  ///< "geneva_wheel"
    std::string_view text;  ///< of its file
};

/// All, by name.
const std::vector<LibraryPart>& part_library();

/// The library's part of this name, or the file where `part` ends in ".part.json", or a file's text, which begins with `{`. Errors: none of
/// them, with the nearest name; those of PartFile::read.
Result<core::part_files::PartFile> find_part(const std::string& part, const core::part_files::Counts& counts = {});

}  // namespace fettle::design::shapes
