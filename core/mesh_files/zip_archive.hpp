// SPDX-License-Identifier: MIT
/// Zip archives in memory, by libzip. They may come from anywhere: stored or deflated entries, with zip64 sizes; the claims of an entry are
/// checked (place, size, checksum) and bounded. For 3MF. No encryption, no archives in several parts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

struct zip;

namespace fettle::core::mesh_files {

class ZipArchive {
public:
    /// @param bytes  The whole archive; outlives this object. @param where  The path, for messages.
    /// Errors: parse (not a zip archive, or its directory is damaged), file_not_found (libzip is not there).
    static Result<ZipArchive> open(std::string_view bytes, const std::string& where);

    bool has(const std::string& name) const;

    /// The contents of the entry of this name. Errors: file_not_found, unsupported (encrypted, another method), out_of_range (unpacks to
    /// more than `largest` bytes), parse (damaged: does not inflate to the size and checksum that the directory states).
    Result<std::string> unpacked(const std::string& name, std::uint64_t largest) const;

private:
    std::string where_;
    std::shared_ptr<zip> zip_;  ///< libzip's
};

struct ZipEntry {
    std::string name, contents;
};

/// The bytes of an archive, entries deflated, in the order given. All times are 1980-01-01, the format's first, so that equal entries make
/// equal archives. Throws base::MissingLibrary where libzip is not there.
std::string zipped(const std::vector<ZipEntry>& entries);

}  // namespace fettle::core::mesh_files
