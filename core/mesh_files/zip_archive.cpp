// SPDX-License-Identifier: MIT
// Names and numbers of fields: APPNOTE.TXT (PKWARE), sections 4.3.7, 4.3.12 to 4.3.16 and 4.5.3.
#include "fettle/core/mesh_files/zip_archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace fettle::core::mesh_files {
namespace {

constexpr std::size_t end_size = 22, end64_locator_size = 20, end64_size = 56, central_size = 46, local_size = 30;
constexpr std::uint32_t end_mark = 0x06054b50, end64_locator_mark = 0x07064b50, end64_mark = 0x06064b50, central_mark = 0x02014b50,
                        local_mark = 0x04034b50;
constexpr std::uint64_t in_zip64 = 0xffffffffu;  // a field of 32 bits that says: look in the zip64 extra field

/// Little-endian numbers; 0 beyond the end, so that a cut archive fails a test further on instead of being read out of bounds.
class Fields {
public:
    explicit Fields(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t number(std::uint64_t at, unsigned size) const {
        std::uint64_t out = 0;
        for (unsigned i = size; i-- > 0;) out = out << 8 | (at + i < bytes_.size() ? static_cast<unsigned char>(bytes_[at + i]) : 0);
        return out;
    }
    bool holds(std::uint64_t at, std::uint64_t size) const { return at <= bytes_.size() && size <= bytes_.size() - at; }
    std::string_view part(std::uint64_t at, std::uint64_t size) const {
        return holds(at, size) ? bytes_.substr(at, size) : std::string_view{};
    }

private:
    std::string_view bytes_;
};

struct Directory {
    std::uint64_t offset = 0, entries = 0;
};

/// From the end record, which stands last but for a comment of at most 65535 bytes, or the zip64 one that a locator before it points to.
std::optional<Directory> find_directory(std::string_view bytes) {
    const Fields fields(bytes);
    if (bytes.size() < end_size) return std::nullopt;
    const std::size_t last = bytes.size() - end_size, lowest = last > 65535 ? last - 65535 : 0;
    for (std::size_t at = last + 1; at-- > lowest;) {
        if (fields.number(at, 4) != end_mark) continue;
        Directory out{fields.number(at + 16, 4), fields.number(at + 10, 2)};
        if (at < end64_locator_size || fields.number(at - end64_locator_size, 4) != end64_locator_mark) return out;
        const std::uint64_t end64 = fields.number(at - end64_locator_size + 8, 8);
        if (!fields.holds(end64, end64_size) || fields.number(end64, 4) != end64_mark) return std::nullopt;
        return Directory{fields.number(end64 + 48, 8), fields.number(end64 + 32, 8)};
    }
    return std::nullopt;
}

/// Inflates a raw deflate stream to exactly `size` bytes.
std::optional<std::string> inflated(std::string_view packed, std::uint64_t size) {
    if (packed.size() > std::numeric_limits<uInt>::max() || size >= std::numeric_limits<uInt>::max()) return std::nullopt;
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string out, chunk(65536, '\0');  // memory is taken as bytes come, not as the directory claims
    int code = Z_OK;
    while (code == Z_OK && out.size() <= size) {
        stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
        stream.avail_out = static_cast<uInt>(chunk.size());
        code = inflate(&stream, Z_NO_FLUSH);
        out.append(chunk, 0, chunk.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (code != Z_STREAM_END || out.size() != size) return std::nullopt;
    return out;
}

Error damaged(const std::string& where, std::string_view what) {
    return {ErrorCode::parse, where, "is damaged: " + std::string(what) + "; export or download it again"};
}

}  // namespace

Result<ZipArchive> ZipArchive::open(std::string_view bytes, const std::string& where) {
    const auto directory = find_directory(bytes);
    if (!directory) return Error{ErrorCode::parse, where, "is not a zip archive"};
    const Fields fields(bytes);
    ZipArchive archive;
    archive.bytes_ = bytes;
    archive.where_ = where;
    std::uint64_t at = directory->offset;
    for (std::uint64_t i = 0; i < directory->entries; ++i) {
        if (!fields.holds(at, central_size) || fields.number(at, 4) != central_mark) return damaged(where, "its directory is cut short");
        Entry entry;
        entry.flags = static_cast<unsigned>(fields.number(at + 8, 2));
        entry.method = static_cast<unsigned>(fields.number(at + 10, 2));
        entry.checksum = static_cast<std::uint32_t>(fields.number(at + 16, 4));
        entry.packed_size = fields.number(at + 20, 4);
        entry.size = fields.number(at + 24, 4);
        entry.offset = fields.number(at + 42, 4);
        const std::uint64_t name = fields.number(at + 28, 2), extra = fields.number(at + 30, 2), comment = fields.number(at + 32, 2);
        entry.name = std::string(fields.part(at + central_size, name));
        const Fields extras(fields.part(at + central_size + name, extra));
        for (std::uint64_t field = 0; field + 4 <= extra; field += 4 + extras.number(field + 2, 2)) {
            if (extras.number(field, 2) != 1) continue;  // zip64: only what did not fit, in this order
            std::uint64_t value = field + 4;
            for (std::uint64_t* number : {&entry.size, &entry.packed_size, &entry.offset}) {
                if (*number != in_zip64) continue;
                *number = extras.number(value, 8);
                value += 8;
            }
        }
        at += central_size + name + extra + comment;
        archive.index_of_.try_emplace(entry.name, archive.entries_.size());
        archive.entries_.push_back(std::move(entry));
    }
    return archive;
}

std::vector<std::string> ZipArchive::names() const {
    std::vector<std::string> out;
    for (const Entry& entry : entries_) out.push_back(entry.name);
    return out;
}

bool ZipArchive::has(std::string_view name) const { return index_of_.find(name) != index_of_.end(); }

Result<std::string_view> ZipArchive::packed(const Entry& entry) const {
    const Fields fields(bytes_);
    if (!fields.holds(entry.offset, local_size) || fields.number(entry.offset, 4) != local_mark)
        return damaged(where_, "its part " + entry.name + " is not where the directory says");
    const std::uint64_t start = entry.offset + local_size + fields.number(entry.offset + 26, 2) + fields.number(entry.offset + 28, 2);
    if (!fields.holds(start, entry.packed_size)) return damaged(where_, "its part " + entry.name + " is cut short");
    return fields.part(start, entry.packed_size);
}

Result<std::string> ZipArchive::unpacked(std::string_view name, std::uint64_t largest) const {
    const auto found = index_of_.find(name);
    if (found == index_of_.end()) return Error{ErrorCode::file_not_found, where_, "has no part " + std::string(name)};
    const Entry* entry = &entries_[found->second];
    if (entry->flags & 1) return Error{ErrorCode::unsupported, where_, "its part " + entry->name + " is encrypted"};
    if (entry->method != 0 && entry->method != Z_DEFLATED)
        return Error{ErrorCode::unsupported, where_, "its part " + entry->name + " is packed by another method than deflate"};
    if (entry->size > largest) {
        return Error{ErrorCode::out_of_range, where_,
                     "its part " + entry->name + " unpacks to " + std::to_string(entry->size) + " bytes, at most " +
                         std::to_string(largest) + " are read"};
    }
    const auto bytes = packed(*entry);
    if (!bytes) return bytes.errors();
    std::optional<std::string> text;
    if (entry->method == Z_DEFLATED) text = inflated(*bytes, entry->size);
    if (entry->method == 0 && bytes->size() == entry->size) text = std::string(*bytes);
    const auto checksum = [](const std::string& of) {
        return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(of.data()), of.size()));
    };
    if (!text || checksum(*text) != entry->checksum) return damaged(where_, "its part " + entry->name + " does not unpack to what it was");
    return std::move(*text);
}

}  // namespace fettle::core::mesh_files
