// SPDX-License-Identifier: MIT
/// Reads files out of a zip archive that may come from anywhere: stored or deflated entries, with zip64 sizes; what an entry claims is
/// checked (place, size, checksum) and bounded. For 3MF. No encryption, no archives in several parts.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::core::mesh_files {

class ZipArchive {
public:
    /// @param bytes  The whole archive; outlives this object. @param where  The path, for messages.
    /// Errors: parse (not a zip archive, or its directory is damaged).
    static Result<ZipArchive> open(std::string_view bytes, const std::string& where);

    /// In the order of the directory.
    std::vector<std::string> names() const;
    bool has(std::string_view name) const;

    /// The contents of the entry of this name. Errors: file_not_found, unsupported (encrypted, another method), out_of_range (unpacks to
    /// more than `largest` bytes), parse (damaged: does not inflate to the size and checksum that the directory states).
    Result<std::string> unpacked(std::string_view name, std::uint64_t largest) const;

private:
    struct Entry {
        std::string name;
        unsigned flags = 0, method = 0;
        std::uint32_t checksum = 0;
        std::uint64_t packed_size = 0, size = 0, offset = 0;
    };
    Result<std::string_view> packed(const Entry& entry) const;

    std::string_view bytes_;
    std::string where_;
    std::vector<Entry> entries_;
    std::map<std::string, std::size_t, std::less<>> index_of_;  ///< by name; of several the first
};

}  // namespace fettle::core::mesh_files
