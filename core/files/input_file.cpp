// SPDX-License-Identifier: MIT
#include "core/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/read_record.hpp"
#include "core/base/stop.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"

namespace fettle::core::files {

using base::Error;
using base::ErrorCode;
using base::Errors;
using base::Result;

namespace {

constexpr std::size_t block_size = std::size_t{1} << 16;

// What stands there in place of a file; empty: a file.
std::string other_kind(const struct stat& there) {
    if (S_ISREG(there.st_mode)) return {};
    if (S_ISDIR(there.st_mode)) return "is a folder, a file is expected";
    const std::string kind = S_ISFIFO(there.st_mode) ? "a pipe" : S_ISSOCK(there.st_mode) ? "a socket" : "a device";
    return "is " + kind + ", not a regular file; write what it gives into a file, and name that";
}

Error no_file(const std::filesystem::path& path, int code) {
    if (code == ENOENT || code == ENOTDIR) return {ErrorCode::file_not_found, path.string(), "no such file"};
    return {ErrorCode::file_unreadable, path.string(), "the file cannot be read: " + std::generic_category().message(code)};
}

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
    struct stat there {};
    if (::stat(path.c_str(), &there) != 0) return no_file(path, errno);
    if (std::string other = other_kind(there); !other.empty()) return Error{ErrorCode::file_unreadable, path.string(), std::move(other)};
    InputFile out;
    out.file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);  // whatever stands there by now, it is not waited for
    if (out.file_ < 0) return no_file(path, errno);
    if (::fstat(out.file_, &there) != 0) return no_file(path, errno);
    if (std::string other = other_kind(there); !other.empty()) return Error{ErrorCode::file_unreadable, path.string(), std::move(other)};
    out.block_.resize(block_size);
    return out;
}

std::string_view InputFile::next() {
    base::stop_if_asked();
    ssize_t count = 0;
    do {
        count = ::read(file_, block_.data(), block_.size());
    } while (count < 0 && errno == EINTR);
    failed_ = count < 0;
    return {block_.data(), failed_ ? 0 : static_cast<std::size_t>(count)};
}

InputFile::~InputFile() {
    if (file_ >= 0) ::close(file_);
}

InputFile::InputFile(InputFile&& other) noexcept { *this = std::move(other); }

InputFile& InputFile::operator=(InputFile&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(failed_, other.failed_);
    std::swap(block_, other.block_);
    return *this;
}

Result<std::string> read_file(const std::filesystem::path& path) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.errors();
    std::string contents;
    for (std::string_view block = file->next(); !block.empty(); block = file->next()) contents.append(block);
    if (file->failed()) return Error{ErrorCode::file_unreadable, path.string(), "the file cannot be read"};
    if (base::ReadRecord::innermost() != nullptr) {
        Fnv1a hash;
        hash.add(contents);
        base::ReadRecord::tell({{path.string(), hash.value()}});
    }
    return contents;
}

void record_file(const std::filesystem::path& path) {
    if (base::ReadRecord::innermost() != nullptr) static_cast<void>(read_file(path));
}

}  // namespace fettle::core::files
