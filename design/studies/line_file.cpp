// SPDX-License-Identifier: MIT
#include "design/studies/line_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <thread>
#include <utility>

#include "core/files/atomic_file.hpp"

namespace fettle::design::studies {

namespace {

namespace fs = std::filesystem;

std::string system_message() { return std::strerror(errno); }

// A link that somebody laid there is not followed.
int open_file(const fs::path& path) { return ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666); }

// @return its new name
Result<std::string> rename_away(const fs::path& path) {
    const fs::path target = core::files::free_name(path);
    std::error_code failure;
    fs::rename(path, target, failure);
    if (failure) return Error{ErrorCode::file_unwritable, path.string(), "cannot be renamed: " + failure.message()};
    return target.string();
}

// A run that was killed may take a moment to let go of its file.
bool lock(int file) {
    for (int tries = 0; ::flock(file, LOCK_EX | LOCK_NB) != 0; ++tries) {
        if (tries == 10) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
}

}  // namespace

Result<LineFile> LineFile::open(const std::string& name, LineFileMode mode, const std::string& what) {
    LineFile out;
    out.path_ = name;
    out.what_ = what;
    const fs::path path = name;
    std::error_code failure;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), failure);
    if (failure) return Error{ErrorCode::file_unwritable, path.parent_path().string(), "cannot be made: " + failure.message()};
    const auto unwritable = [&] { return Error{ErrorCode::file_unwritable, name, "cannot be opened for writing: " + system_message()}; };
    // Locked before it is renamed or read: a file that another run is still writing is left alone.
    out.file_ = open_file(path);
    if (out.file_ < 0) return unwritable();
    if (!lock(out.file_)) {
        return Error{ErrorCode::file_unreadable, name, "another process is writing this " + what + "; wait for it, or name another"};
    }
    if (mode == LineFileMode::fresh && fs::file_size(path, failure) > 0) {
        const Result<std::string> kept = rename_away(path);
        if (!kept) return kept.errors();
        out.kept_as_ = *kept;
        ::close(out.file_);
        out.file_ = open_file(path);
        if (out.file_ < 0 || ::flock(out.file_, LOCK_EX | LOCK_NB) != 0) return unwritable();
    }
    const Result<std::string> text = core::files::read_file(name);
    if (!text) return text.errors();
    for (std::size_t begin = 0;;) {
        const std::size_t end = text->find('\n', begin);
        if (end == std::string::npos) break;  // what follows was cut off by a kill
        out.found_.push_back(text->substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

Errors LineFile::keep(std::size_t lines) {
    off_t size = 0;
    for (std::size_t k = 0; k < lines; ++k) size += static_cast<off_t>(found_[k].size() + 1);
    found_.resize(lines);
    if (::lseek(file_, 0, SEEK_END) == size || ::ftruncate(file_, size) == 0) return {};
    return {{ErrorCode::file_unwritable, path_, "cannot be cut back to its last whole line: " + system_message()}};
}

// Where not all of it gets there none of it stays: the file has whole lines alone.
void LineFile::append(const std::string& line) {
    waiting_ += line;
    waiting_ += '\n';
    const off_t end = ::lseek(file_, 0, SEEK_END);
    std::string_view left = waiting_;
    write_error_ = core::files::write_all(file_, left);
    if (write_error_ != 0 && end >= 0 && ::ftruncate(file_, end) == 0) left = waiting_;
    waiting_.erase(0, waiting_.size() - left.size());
    if (write_error_ == 0 && ::fsync(file_) != 0 && errno != EINVAL) write_error_ = errno;
}

Errors LineFile::unwritten() const {
    if (write_error_ == 0) return {};
    return {{ErrorCode::file_unwritable, path_, "the " + what_ + " cannot be written: " + std::strerror(write_error_)}};
}

LineFile::~LineFile() {
    if (file_ >= 0) ::close(file_);
}

LineFile::LineFile(LineFile&& other) noexcept { *this = std::move(other); }

LineFile& LineFile::operator=(LineFile&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(path_, other.path_);
    std::swap(what_, other.what_);
    std::swap(found_, other.found_);
    std::swap(waiting_, other.waiting_);
    std::swap(write_error_, other.write_error_);
    std::swap(kept_as_, other.kept_as_);
    return *this;
}

}  // namespace fettle::design::studies
