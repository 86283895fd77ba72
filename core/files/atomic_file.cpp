// SPDX-License-Identifier: MIT
#include "core/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/mixed_bits.hpp"

namespace fettle::core::files {

using base::Error;
using base::ErrorCode;
using base::Errors;

namespace {

namespace fs = std::filesystem;

Errors failure(const fs::path& path, const char* what, int code) {
    return {{ErrorCode::file_unwritable, path.string(), std::string(what) + ": " + std::generic_category().message(code)}};
}

constexpr const char* unwritten = "the file cannot be written";

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

std::string by_handle(int file) { return "/proc/self/fd/" + std::to_string(file); }

// A file without a name in the folder of `path`, which can be given one: its handle, -1 if there can be none.
int open_unnamed(const fs::path& path) {
#ifdef O_TMPFILE
    const int file = ::open(folder_of(path).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0 || ::access(by_handle(file).c_str(), F_OK) == 0) return file;
    ::close(file);
#else
    static_cast<void>(path);
#endif
    return -1;
}

// Six letters that no other process is likely to choose, nor another thread of this one.
std::string random_ending() {
    static std::atomic<std::uint64_t> calls{0};
    const auto now = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    std::uint64_t bits = base::mixed_bits(base::mixed_bits(now ^ ++calls) ^ static_cast<std::uint64_t>(::getpid()));
    std::string letters = ".";
    for (int i = 0; i < 6; ++i, bits /= 26) letters += static_cast<char>('a' + bits % 26);
    return letters;
}

// A file of a name that nothing has, beside `path`: its handle, -1 if there can be none. Its permissions are those of any new file, which
// mkstemp would not give it.
int open_beside(const fs::path& path, std::string& name) {
    constexpr int tries = 100;
    int file = -1;
    for (int i = 0; i < tries && file < 0; ++i) {
        name = path.string() + random_ending();
        file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno != EEXIST && errno != EINTR) break;
    }
    if (file < 0) name.clear();
    return file;
}

// New names reach the disk with their folder; file systems that cannot do this have nothing better to offer.
void flush_folder(const fs::path& folder) {
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return;
    ::fsync(handle);
    ::close(handle);
}

// A name of an open file: /dev/stdout, /dev/fd/3, /proc/self/fd/3.
bool names_open_file(const fs::path& path) {
    std::error_code code;
    for (fs::path at = path; fs::is_symlink(fs::symlink_status(at, code)); at = folder_of(at) / fs::read_symlink(at, code)) {
        const fs::path folder = fs::canonical(folder_of(at), code);
        if (code) return false;
        if (folder.filename() == "fd" && *++folder.begin() == "proc") return true;
    }
    return false;
}

// What is written to as it goes. A pipe that nobody reads would be waited for without an end: -1 and ENXIO after a while.
int open_directly(const fs::path& path) {
    constexpr std::chrono::seconds patience{10};
    constexpr std::chrono::milliseconds between{20};
    const auto end = std::chrono::steady_clock::now() + patience;
    std::error_code ignored;
    const bool is_pipe = fs::is_fifo(path, ignored);
    while (true) {
        const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | (is_pipe ? O_NONBLOCK : 0));
        if (file >= 0 && is_pipe) ::fcntl(file, F_SETFL, O_APPEND);
        if (file >= 0 || !is_pipe || errno != ENXIO || std::chrono::steady_clock::now() > end) return file;
        std::this_thread::sleep_for(between);
    }
}

}  // namespace

int write_all(int file, std::string_view& left) {
    while (!left.empty()) {
        const ssize_t written = ::write(file, left.data(), left.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return written < 0 ? errno : EIO;
        left.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

fs::path free_name(const fs::path& path) {
    for (int n = 1;; ++n) {
        fs::path name = path;
        name.replace_extension(std::to_string(n) + path.extension().string());
        std::error_code ignored;
        if (!fs::exists(fs::symlink_status(name, ignored))) return name;
    }
}

bool is_written_directly(const fs::path& path) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (!fs::exists(status) || fs::is_directory(status)) return false;
    return !fs::is_regular_file(status) || names_open_file(path);
}

NewFile::NewFile(fs::path path) : path_(std::move(path)) {
    std::error_code code;
    fs::create_directories(folder_of(path_), code);
    if (code) {
        errors_ = failure(folder_of(path_), "the folder cannot be made", code.value());
    } else if (fs::is_directory(path_, code)) {
        fail(unwritten, EISDIR);  // known before a set of files takes its names
    } else if (is_written_directly(path_)) {
        directly_ = true;
        file_ = open_directly(path_);
        if (file_ < 0) fail(errno == ENXIO ? "nobody reads it" : unwritten, errno);
    } else if (file_ = open_unnamed(path_); file_ < 0) {
        file_ = open_beside(path_, temporary_);
        if (file_ < 0) fail(unwritten, errno);
    }
}

NewFile::~NewFile() {
    close();
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

NewFile::NewFile(NewFile&& other) noexcept { *this = std::move(other); }

NewFile& NewFile::operator=(NewFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(temporary_, other.temporary_);
    std::swap(file_, other.file_);
    std::swap(directly_, other.directly_);
    std::swap(errors_, other.errors_);
    return *this;
}

void NewFile::fail(const char* what, int code) {
    if (errors_.empty()) errors_ = failure(path_, what, code);
}

void NewFile::close() {
    if (file_ >= 0 && ::close(file_) != 0) fail(unwritten, errno);
    file_ = -1;
}

void NewFile::write(std::string_view contents) {
    if (!errors_.empty()) return;
    if (const int code = write_all(file_, contents); code != 0) fail(unwritten, code);
}

Errors NewFile::finish() {
    if (file_ >= 0 && errors_.empty() && !directly_ && ::fsync(file_) != 0) fail(unwritten, errno);
    if (file_ >= 0 && errors_.empty() && !directly_ && temporary_.empty()) {
        std::string name;
        const int taken = open_beside(path_, name);  // so that nothing else has it
        if (taken >= 0) ::close(taken);
        if (taken < 0 || ::unlink(name.c_str()) != 0 ||
            ::linkat(AT_FDCWD, by_handle(file_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            fail(unwritten, errno);
        } else {
            temporary_ = name;
        }
    }
    close();
    return errors_;
}

// What has been done to names, which goes back where something fails.
struct FilesTogether::Undo {
    struct Kept {
        fs::path path;
        std::string aside;   // empty: there was nothing at `path`
        bool stays = false;  // under its other name
    };
    std::vector<Kept> kept;
    bool undone = true;

    ~Undo() {
        for (auto each = kept.rbegin(); each != kept.rend(); ++each) {
            if (undone && each->aside.empty()) ::unlink(each->path.c_str());
            if (undone && !each->aside.empty()) std::rename(each->aside.c_str(), each->path.c_str());
            if (!each->aside.empty() && (undone || !each->stays)) ::unlink(each->aside.c_str());  // both can be names of one file
        }
    }
};

Errors FilesTogether::add(NewFile file) {
    Errors errors = file.finish();
    if (errors.empty()) files_.push_back(std::move(file));
    return errors;
}

Errors FilesTogether::add(const fs::path& path, std::string_view contents) {
    NewFile file(path);
    file.write(contents);
    return add(std::move(file));
}

void FilesTogether::take_away(const fs::path& path) { gone_.push_back(path); }

void FilesTogether::keep_as(const fs::path& path, const fs::path& name) { kept_.emplace_back(path, name); }

// What is at `path` gets another name: in place of its own, or beside it, until a new file replaces it.
Errors FilesTogether::set_aside(const fs::path& path, Aside how, Undo& undo) {
    std::error_code code;
    std::string aside;
    const fs::file_type there = fs::symlink_status(path, code).type();
    if (there == fs::file_type::directory) {
        if (how == Aside::away) return {};  // none of ours: it is left alone
        return failure(path, unwritten, EISDIR);
    }
    if (there != fs::file_type::not_found) {
        const int file = open_beside(path, aside);
        if (file < 0) return failure(path, "the file cannot be replaced", errno);
        ::close(file);
        ::unlink(aside.c_str());
        // Some file systems have no second names.
        const bool linked = how == Aside::beside && ::link(path.c_str(), aside.c_str()) == 0;
        if (!linked && std::rename(path.c_str(), aside.c_str()) != 0) return failure(path, "the file cannot be replaced", errno);
    }
    if (how == Aside::beside || !aside.empty()) undo.kept.push_back({path, aside, false});
    return {};
}

Errors FilesTogether::take_names() {
    Undo undo;
    const bool alone = files_.size() == 1 && gone_.empty() && kept_.empty();
    Errors errors;
    const auto set_aside_in_turn = [&](const fs::path& path, Aside how) {
        if (errors.empty()) errors = set_aside(path, how, undo);
    };
    // The answer goes first, unless what has its name is kept.
    const bool has_answer = !alone && !files_.empty() && !files_.back().temporary_.empty();
    const auto is_answer = [&](const auto& kept) { return kept.first == files_.back().path_; };
    if (has_answer && std::none_of(kept_.begin(), kept_.end(), is_answer)) set_aside_in_turn(files_.back().path_, Aside::away);
    for (const auto& [path, name] : kept_) {
        if (!errors.empty()) break;
        if (std::rename(path.c_str(), name.c_str()) != 0) {
            errors = failure(name, "what was there before cannot be kept", errno);
        } else {
            undo.kept.push_back({path, name.string(), true});
        }
    }
    for (const fs::path& path : gone_) set_aside_in_turn(path, Aside::away);
    std::set<fs::path> folders;
    for (NewFile& file : files_) {
        if (file.temporary_.empty()) continue;
        if (!alone) set_aside_in_turn(file.path_, Aside::beside);
        if (errors.empty() && std::rename(file.temporary_.c_str(), file.path_.c_str()) != 0) errors = failure(file.path_, unwritten, errno);
        if (!errors.empty()) return errors;
        file.temporary_.clear();
        folders.insert(folder_of(file.path_));
    }
    if (!errors.empty()) return errors;
    undo.undone = false;
    for (const fs::path& folder : folders) flush_folder(folder);
    files_.clear();
    gone_.clear();
    kept_.clear();
    return {};
}

Errors write_file_atomically(const fs::path& path, std::string_view contents) {
    FilesTogether file;
    Errors errors = file.add(path, contents);
    return errors.empty() ? file.take_names() : errors;
}

}  // namespace fettle::core::files
