// SPDX-License-Identifier: MIT
/// A file of lines that a long run adds to, one at a time, each on the disk before the next: what a run that is killed leaves is whole
/// lines, and perhaps a part of one, which is dropped when the run goes on.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

namespace fettle::design::studies {

enum class LineFileMode {
    fresh,  ///< a file that is there is kept under another name (history.1.jsonl, ...)
    resume  ///< its lines are read; none is a fresh start
};

/// Owns the open file, which it locks against a second process.
class LineFile {
public:
    /// Makes its folder. @param what  Its name in messages: "history".
    /// Errors: in use by another process (file_unreadable), it or its folder cannot be made or written (file_unwritable).
    static Result<LineFile> open(const std::string& path, LineFileMode mode, const std::string& what);
    ~LineFile();
    LineFile(LineFile&&) noexcept;
    LineFile& operator=(LineFile&&) noexcept;

    /// The whole lines that were there.
    const std::vector<std::string>& found() const { return found_; }
    /// Ends the file after the first of these; to be called before the first append. Errors: file_unwritable.
    Errors keep(std::size_t lines);

    /// Adds a line, and waits until it is on the disk. What cannot be written (a full disk) is kept, and tried again with the next.
    void append(const std::string& line);
    /// Why what was appended is not all on the disk (file_unwritable); nothing where it is.
    Errors unwritten() const;

    /// Name of the file that `fresh` renamed away; empty if there was none.
    const std::string& kept_as() const { return kept_as_; }

private:
    LineFile() = default;

    int file_ = -1;
    std::string path_, what_;
    std::vector<std::string> found_;
    std::string waiting_;  ///< lines that are not on the disk yet
    int write_error_ = 0;  ///< why
    std::string kept_as_;
};

}  // namespace fettle::design::studies
