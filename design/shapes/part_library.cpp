// SPDX-License-Identifier: MIT
#include "design/shapes/part_library.hpp"

#include "core/files/nearest_word.hpp"

namespace fettle::design::shapes {

using core::part_files::PartFile;

const std::vector<LibraryPart>& part_library() {
    static const std::vector<LibraryPart> all{
#include <part_library.inc>  // made by CMake of the files
    };
    return all;
}

Result<PartFile> find_part(const std::string& part, const core::part_files::Counts& counts) {
    if (part.starts_with('{')) return PartFile::parse(part, "shape", counts);
    if (part.ends_with(core::part_files::part_file_ending)) return PartFile::read(part, counts);
    std::vector<std::string_view> known;
    for (const LibraryPart& each : part_library()) {
        if (each.name == part) return PartFile::parse(std::string(each.text), part, counts);
        known.push_back(each.name);
    }
    return Error{ErrorCode::unknown_key, part,
                 "there is no part '" + part + "' in the library; " + core::files::did_you_mean(part, known) +
                     "; a part of your own is named by its file, " + part + ".part.json"};
}

}  // namespace fettle::design::shapes
