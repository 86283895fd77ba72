// SPDX-License-Identifier: MIT
/// Makes zip archives: every entry deflated, no zip64. Reading: zip_archive.hpp. For 3MF.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::core::mesh_files {

struct ZipEntry {
    std::string name, contents;
};

/// The archive's bytes, entries in the order given. All times are 1980-01-01, the format's first, so that equal entries make equal
/// archives. Errors: out_of_range (4 GiB or more in all, or more than 65534 entries).
Result<std::string> zipped(const std::vector<ZipEntry>& entries);

}  // namespace fettle::core::mesh_files
