// SPDX-License-Identifier: MIT
/// A file that is read, front to back: the one place that opens what is read. Regular files alone: a pipe would hold up the program for as
/// long as nobody writes into it, a device may have no end.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"

namespace fettle::core::files {

class InputFile {
public:
    /// Errors: file_not_found; file_unreadable (a folder, a pipe, a device, no permission).
    static base::Result<InputFile> open(const std::filesystem::path& path);
    ~InputFile();
    InputFile(InputFile&&) noexcept;
    InputFile& operator=(InputFile&&) noexcept;

    /// What comes next, valid until the next call; empty: there is no more, or it cannot be read (failed()). May end by Stopped
    /// (base/stop.hpp).
    std::string_view next();
    bool failed() const { return failed_; }

private:
    InputFile() = default;

    int file_ = -1;
    bool failed_ = false;
    std::vector<char> block_;
};

/// Tells the record of this thread (base/read_record.hpp) of a file that is read by another program; one that cannot be read is none.
void record_file(const std::filesystem::path& path);

}  // namespace fettle::core::files
