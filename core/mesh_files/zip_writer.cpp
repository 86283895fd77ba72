// SPDX-License-Identifier: MIT
// Names and numbers of fields: APPNOTE.TXT (PKWARE), sections 4.3.7, 4.3.12 and 4.3.16.
#include "fettle/core/mesh_files/zip_writer.hpp"

#include <zlib.h>

#include <cstdint>

#include "fettle/core/base/contract.hpp"

namespace fettle::core::mesh_files {
namespace {

void append_number(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i, value >>= 8) out += static_cast<char>(value & 255);
}

std::string deflated(const std::string& text) {
    z_stream stream{};
    const int begun = deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    FETTLE_ASSERT(begun == Z_OK, "zlib cannot begin to deflate");
    std::string out(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));  // NOLINT: zlib reads only
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int ended = deflate(&stream, Z_FINISH);
    FETTLE_ASSERT(ended == Z_STREAM_END, "deflateBound is enough for one call");
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

/// What the local header and the directory's entry have in common, from "version needed" to the length of the extra field.
std::string common_fields(const ZipEntry& entry, std::uint64_t packed_size) {
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(entry.contents.data()), static_cast<uInt>(entry.contents.size()));
    std::string out;
    append_number(out, 20, 2);              // version needed
    append_number(out, 1U << 11, 2);        // names are UTF-8
    append_number(out, 8, 2);               // deflated
    append_number(out, 0, 2);               // 00:00
    append_number(out, (1U << 5) + 1U, 2);  // 1980-01-01
    append_number(out, checksum, 4);
    append_number(out, packed_size, 4);
    append_number(out, entry.contents.size(), 4);
    append_number(out, entry.name.size(), 2);
    append_number(out, 0, 2);  // no extra field
    return out;
}

}  // namespace

Result<std::string> zipped(const std::vector<ZipEntry>& entries) {
    constexpr std::uint64_t most = 0xfffffffeU;
    std::uint64_t total = 0;
    for (const ZipEntry& entry : entries) total += entry.contents.size() + 2 * entry.name.size() + 200;
    if (total > most || entries.size() > 65534)
        return Error{ErrorCode::out_of_range, "zip archive", "is more than 4 GiB or 65534 entries; write the parts to files of their own"};
    std::string out, directory;
    for (const ZipEntry& entry : entries) {
        const std::uint64_t offset = out.size();
        const std::string packed = deflated(entry.contents), common = common_fields(entry, packed.size());
        out += "PK\3\4" + common + entry.name + packed;
        directory += "PK\1\2";
        append_number(directory, 20, 2);  // version made by
        directory += common;
        append_number(directory, 0, 2);  // no comment
        append_number(directory, 0, 2);  // first disk
        append_number(directory, 0, 2);  // internal attributes
        append_number(directory, 0, 4);  // external attributes
        append_number(directory, offset, 4);
        directory += entry.name;
    }
    if (out.size() + directory.size() > most)
        return Error{ErrorCode::out_of_range, "zip archive", "is more than 4 GiB; write the parts to files of their own"};
    const std::uint64_t start = out.size();
    out += directory + "PK\5\6";
    append_number(out, 0, 4);  // one disk
    append_number(out, entries.size(), 2);
    append_number(out, entries.size(), 2);
    append_number(out, directory.size(), 4);
    append_number(out, start, 4);
    append_number(out, 0, 2);  // no comment
    return out;
}

}  // namespace fettle::core::mesh_files
