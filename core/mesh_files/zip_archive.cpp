// SPDX-License-Identifier: MIT
// libzip's functions are loaded where they are first called (core/base/shared_library.hpp): it brings a library of encryption with it.
#include "core/mesh_files/zip_archive.hpp"

#include <zip.h>

#include "core/base/contract.hpp"
#include "core/base/shared_library.hpp"

namespace fettle::core::mesh_files {
namespace {

/// Each is called ZIP(x) with its name, without its "zip_".
// clang-format off
#define FETTLE_ZIP_FUNCTIONS(ZIP)                                                                                          \
    ZIP(close) ZIP(discard) ZIP(fclose) ZIP(file_add) ZIP(file_set_dostime) ZIP(fopen_index) ZIP(fread) ZIP(name_locate)    \
    ZIP(open_from_source) ZIP(set_file_compression) ZIP(source_buffer) ZIP(source_buffer_create) ZIP(source_close)          \
    ZIP(source_free) ZIP(source_keep) ZIP(source_open) ZIP(source_read) ZIP(source_stat) ZIP(stat_index)
// clang-format on

struct ZipLibrary {
#define FETTLE_ZIP_MEMBER(function) decltype(&zip_##function) function;
    FETTLE_ZIP_FUNCTIONS(FETTLE_ZIP_MEMBER)
#undef FETTLE_ZIP_MEMBER
};

ZipLibrary load_zip() {
    ZipLibrary out{};
#ifdef FETTLE_LIBZIP_NAME
    const base::SharedLibrary library(FETTLE_LIBZIP_NAME, FETTLE_LIBZIP_PATH);
#define FETTLE_ZIP_FIND(function) library.find("zip_" #function, out.function);
#else
#define FETTLE_ZIP_FIND(function) out.function = &zip_##function;
#endif
    FETTLE_ZIP_FUNCTIONS(FETTLE_ZIP_FIND)
#undef FETTLE_ZIP_FIND
    return out;
}

const ZipLibrary& zip_library() {
    static const ZipLibrary library = load_zip();
    return library;
}

Error damaged(const std::string& where, const std::string& what) { return {ErrorCode::parse, where, "is a damaged zip archive: " + what}; }

}  // namespace

Result<ZipArchive> ZipArchive::open(std::string_view bytes, const std::string& where) try {
    const ZipLibrary& library = zip_library();
    zip_source_t* source = library.source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
    zip_t* opened = source == nullptr ? nullptr : library.open_from_source(source, ZIP_RDONLY, nullptr);
    if (opened == nullptr) {
        if (source != nullptr) library.source_free(source);
        return Error{ErrorCode::parse, where, "is not a zip archive, or a damaged one"};
    }
    ZipArchive archive;
    archive.where_ = where;
    archive.zip_ = {opened, library.discard};
    return archive;
} catch (const base::MissingLibrary& missing) {
    return Error{ErrorCode::file_not_found, where, std::string("cannot be unpacked: ") + missing.what()};
}

bool ZipArchive::has(const std::string& name) const { return zip_library().name_locate(zip_.get(), name.c_str(), 0) >= 0; }

Result<std::string> ZipArchive::unpacked(const std::string& name, std::uint64_t largest) const {
    const ZipLibrary& library = zip_library();
    const zip_int64_t found = library.name_locate(zip_.get(), name.c_str(), 0);
    if (found < 0) return Error{ErrorCode::file_not_found, where_, "has no part " + name};
    const auto index = static_cast<zip_uint64_t>(found);
    const std::string part = "its part " + name;
    zip_stat_t facts{};
    if (library.stat_index(zip_.get(), index, 0, &facts) != 0) return damaged(where_, part + " is not where the directory says");
    if (facts.encryption_method != ZIP_EM_NONE) return Error{ErrorCode::unsupported, where_, part + " is encrypted"};
    if (facts.comp_method != ZIP_CM_STORE && facts.comp_method != ZIP_CM_DEFLATE)
        return Error{ErrorCode::unsupported, where_, part + " is packed by another method than deflate"};
    if (facts.size > largest) {
        return Error{ErrorCode::out_of_range, where_,
                     part + " unpacks to " + std::to_string(facts.size) + " bytes, at most " + std::to_string(largest) + " are read"};
    }
    zip_file_t* file = library.fopen_index(zip_.get(), index, 0);
    if (file == nullptr) return damaged(where_, part + " is not where the directory says");
    std::string text, chunk(65536, '\0');  // memory is taken as bytes come, not as the directory claims
    zip_int64_t count = 0;
    while (text.size() <= facts.size && (count = library.fread(file, chunk.data(), chunk.size())) > 0)
        text.append(chunk, 0, static_cast<std::size_t>(count));
    library.fclose(file);  // at the end the checksum has been looked at
    if (count != 0 || text.size() != facts.size) return damaged(where_, part + " does not unpack to what it was");
    return text;
}

std::string zipped(const std::vector<ZipEntry>& entries) {
    constexpr zip_uint16_t midnight = 0, first_of_1980 = (1 << 5) + 1;
    const ZipLibrary& library = zip_library();
    zip_source_t* target = library.source_buffer_create(nullptr, 0, 0, nullptr);
    zip_t* archive = target == nullptr ? nullptr : library.open_from_source(target, ZIP_TRUNCATE, nullptr);
    FETTLE_ASSERT(archive != nullptr, "libzip writes into memory");
    library.source_keep(target);
    bool good = true;
    for (const ZipEntry& entry : entries) {
        zip_source_t* contents = library.source_buffer(archive, entry.contents.data(), entry.contents.size(), 0);
        const zip_int64_t index = library.file_add(archive, entry.name.c_str(), contents, ZIP_FL_ENC_UTF_8);
        good = good && index >= 0;
        if (!good) break;
        const auto at = static_cast<zip_uint64_t>(index);
        good = library.set_file_compression(archive, at, ZIP_CM_DEFLATE, 0) == 0 &&
               library.file_set_dostime(archive, at, midnight, first_of_1980, 0) == 0;
    }
    zip_stat_t facts{};
    good = good && library.close(archive) == 0 && library.source_stat(target, &facts) == 0 && library.source_open(target) == 0;
    FETTLE_ASSERT(good, "libzip writes into memory");
    std::string out(facts.size, '\0');
    good = library.source_read(target, out.data(), out.size()) == static_cast<zip_int64_t>(out.size());
    FETTLE_ASSERT(good, "libzip reads what it wrote");
    library.source_close(target);
    library.source_free(target);
    return out;
}

}  // namespace fettle::core::mesh_files
