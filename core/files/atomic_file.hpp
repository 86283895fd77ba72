// SPDX-License-Identifier: MIT
/// Whole files: read, and written so that a reader, or a machine that loses power, finds the old contents or the new, never a part; and
/// sets of files that belong together, which are all written before the first of them takes its name.
///
///     FilesTogether files;
///     Errors errors = files.add(folder / "steps.csv", table);
///     if (errors.empty()) errors = files.add(folder / "result.json", answer);   // the last: it vouches for the others
///     if (errors.empty()) errors = files.take_names();
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.hpp"

namespace fettle::core::files {

/// Does something stand at `path` that is no file or folder (a pipe, a device), or a name that the system gives to an open file
/// (/dev/stdout, /dev/fd/3)? It is written to, never replaced or taken away.
bool is_written_directly(const std::filesystem::path& path);

/// A file that is written beside its name, front to back. Its folder is made if it is not there; permissions are those of a new file.
/// Until it is finished it has no name at all, where the file system can do that: a program that is killed leaves nothing of it.
/// What is_written_directly() is written to as it goes.
class NewFile {
public:
    explicit NewFile(std::filesystem::path path);
    /// What took no name is taken away.
    ~NewFile();
    NewFile(NewFile&&) noexcept;
    NewFile& operator=(NewFile&&) noexcept;

    /// Does nothing once something has failed.
    void write(std::string_view contents);
    /// All of it is on the disk. @return nothing, or what failed first (file_unwritable)
    [[nodiscard]] base::Errors finish();

    const std::filesystem::path& path() const { return path_; }

private:
    friend class FilesTogether;
    void fail(const char* what, int code);
    void close();

    std::filesystem::path path_;
    std::string temporary_;  ///< its name until then; empty: none yet, or it is written directly
    int file_ = -1;
    bool directly_ = false;
    base::Errors errors_;
};

/// Writes to a descriptor until nothing is left; the bytes written are taken off the front. @return 0, or errno of what failed
int write_all(int file, std::string_view& left);

/// The first of NAME.1.EXT, NAME.2.EXT, ... beside NAME.EXT that nothing has, not even a link that leads nowhere.
std::filesystem::path free_name(const std::filesystem::path& path);

/// What is put together in memory of a file that may be long before it is written.
inline constexpr std::size_t write_size = std::size_t{1} << 20;

/// Files that are replaced together: if anything fails, those that are there stay as they were.
class FilesTogether {
public:
    /// Finished, if it is not yet. @return why it cannot be written; then the whole set cannot
    [[nodiscard]] base::Errors add(NewFile file);
    [[nodiscard]] base::Errors add(const std::filesystem::path& path, std::string_view contents);
    /// Is taken away, if it is there, when the others take their names.
    void take_away(const std::filesystem::path& path);
    /// Is kept under another name, which nothing has, before one of the others takes its own.
    void keep_as(const std::filesystem::path& path, const std::filesystem::path& name);
    /// First the name of the last file is freed, which vouches for the others; the last file takes it at the end. So whoever finds it finds
    /// all of the others, and whoever is killed between leaves none. One file alone replaces the one before it in one go.
    /// @return nothing, or what failed (file_unwritable); then everything is as it was before.
    [[nodiscard]] base::Errors take_names();

private:
    struct Undo;
    enum class Aside { beside, away };
    static base::Errors set_aside(const std::filesystem::path& path, Aside how, Undo& undo);

    std::vector<NewFile> files_;
    std::vector<std::filesystem::path> gone_;
    std::vector<std::pair<std::filesystem::path, std::filesystem::path>> kept_;
};

/// One file. @return nothing, or why not (file_unwritable); then `path` is as it was.
[[nodiscard]] base::Errors write_file_atomically(const std::filesystem::path& path, std::string_view contents);

/// The contents of a file. Errors: file_not_found, file_unreadable (a folder, a pipe, a device, no permission).
base::Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace fettle::core::files
