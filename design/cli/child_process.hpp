// SPDX-License-Identifier: MIT
/// This program beside itself, and programs that it talks with.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/process.hpp"

namespace fettle::design::cli {

/// Starts this program (the same executable) with these arguments. Its stdout is dropped, its stderr goes to a file. Throws
/// std::runtime_error if the system has no process left.
core::files::Process start_self(const std::vector<std::string>& arguments, const std::filesystem::path& log);

/// A child that is told lines and answers in lines.
class TalkingProcess {
public:
    /// Its stderr is this process's. Throws std::system_error where there is no such program, or no process left.
    explicit TalkingProcess(const std::vector<std::string>& words);

    /// Writes all of it. @return false: it does not listen any more
    bool tell(std::string_view text);
    void tell_no_more();
    /// Its next line, without the line feed; nothing: it will say no more, or should_stop said so, which is asked every 50 ms.
    std::optional<std::string> next_line(const std::function<bool()>& should_stop);

private:
    std::optional<core::files::Process> process_;
    core::files::Descriptor to_, from_;
    std::string heard_;
};

}  // namespace fettle::design::cli
