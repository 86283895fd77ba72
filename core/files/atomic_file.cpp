// SPDX-License-Identifier: MIT
#include "fettle/core/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

namespace fettle::core::files {

using base::Error;
using base::ErrorCode;
using base::Errors;
using base::Result;

namespace {

Errors failure(const std::filesystem::path& path, const char* what, int code) {
    return {{ErrorCode::file_unreadable, path.string(), std::string(what) + ": " + std::generic_category().message(code)}};
}

/// 0, or errno of the call that failed.
int write_all(int file, std::string_view contents) {
    while (!contents.empty()) {
        const ssize_t written = ::write(file, contents.data(), contents.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        contents.remove_prefix(static_cast<std::size_t>(written));
    }
    return ::fsync(file) == 0 ? 0 : errno;
}

}  // namespace

Errors write_file_atomically(const std::filesystem::path& path, std::string_view contents) {
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) return failure(folder, "the folder cannot be made", code.value());

    std::string temporary = path.string() + ".XXXXXX";
    const int file = ::mkstemp(temporary.data());
    if (file < 0) return failure(path, "the file cannot be written", errno);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(file, 0666 & ~mask);  // mkstemp's 0600 would keep a report from its readers

    int error = write_all(file, contents);
    if (::close(file) != 0 && error == 0) error = errno;
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        return failure(path, "the file cannot be written", error);
    }
    // The new name itself reaches the disk with its folder; file systems that cannot do this have nothing better to offer.
    const int folder_handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
    if (folder_handle >= 0) {
        ::fsync(folder_handle);
        ::close(folder_handle);
    }
    return {};
}

Result<std::string> read_file(const std::filesystem::path& path) {
    std::error_code code;
    if (!std::filesystem::exists(path, code)) return Error{ErrorCode::file_not_found, path.string(), "no such file"};
    if (std::filesystem::is_directory(path, code)) return Error{ErrorCode::file_unreadable, path.string(), "is a folder, a file is wanted"};
    std::ifstream stream(path, std::ios::binary);
    std::string contents;
    std::vector<char> block(1 << 16);
    do {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        contents.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream);
    if (!stream.is_open() || stream.bad()) return Error{ErrorCode::file_unreadable, path.string(), "the file cannot be read"};
    return contents;
}

}  // namespace fettle::core::files
