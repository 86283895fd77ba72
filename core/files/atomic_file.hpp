// SPDX-License-Identifier: MIT
/// Whole files: read, and written so that a reader, or a machine that loses power, finds the old contents or the new, never a part.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fettle/core/base/result.hpp"

namespace fettle::core::files {

/// Writes a temporary file beside `path`, flushes it to the disk, and renames it over `path`. Missing folders are made.
/// Permissions are those of a new file. @return nothing, or why not (file_unreadable); then `path` is as it was.
[[nodiscard]] base::Errors write_file_atomically(const std::filesystem::path& path, std::string_view contents);

/// Errors: file_not_found, file_unreadable (a folder, no permission).
base::Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace fettle::core::files
