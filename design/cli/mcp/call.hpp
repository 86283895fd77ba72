// SPDX-License-Identifier: MIT
/// One call of a tool: a process of this program, listened to without waiting.
#pragma once

#include <poll.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/files/process.hpp"
#include "design/cli/mcp/answer.hpp"

namespace fettle::design::cli::mcp {

class Call {
public:
    /// Starts it. Throws std::system_error if the system has no process or pipe left.
    /// @param words   The command line's, without the program's name.
    /// @param folder  For its files, its own.
    Call(const Tool& tool, std::vector<std::string> words, const std::vector<std::string>& passed_on, std::filesystem::path folder);
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    ~Call();

    const Tool& tool() const { return tool_; }
    /// What a person would have typed.
    const std::string& typed() const { return typed_; }
    /// What it reported last, on its stderr.
    const std::string& doing() const { return doing_; }
    /// The descriptors to be polled: those that are still open.
    void add_streams(std::vector<pollfd>& streams) const;
    /// Takes what has come. @return it has a new report
    bool listen();
    /// Asks it to end with what it has.
    void stop() { process_->ask_to_stop(); }
    /// Its end, once it has come and all that it said is here.
    std::optional<Ended> ended();
    /// The picture that it drew; empty: none.
    std::string picture() const;

private:
    bool take(core::files::Descriptor& from, std::string& into);

    const Tool& tool_;
    std::filesystem::path folder_;
    std::string typed_, out_, error_, doing_;
    std::optional<core::files::Process> process_;
    core::files::Descriptor out_from_, error_from_;
};

}  // namespace fettle::design::cli::mcp
