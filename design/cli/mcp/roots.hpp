// SPDX-License-Identifier: MIT
/// The folders below which tools may read and write: those that the client states, or that the server was started with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"

namespace fettle::design::cli::mcp {

class Roots {
public:
    Roots() = default;
    /// Folders that are not there are left out.
    explicit Roots(const std::vector<std::string>& folders);

    bool empty() const { return folders_.empty(); }
    /// The absolute path of a file or folder that need not be there, its links followed; a relative one is below the first root.
    /// Errors (unsupported): it is not below any root. @param where  For the message: the argument's name.
    Result<std::string> inside(const std::string& path, const std::string& where) const;
    /// Their names, with commas.
    std::string named() const;

private:
    std::vector<std::filesystem::path> folders_;  ///< canonical
};

/// The path of a file:// address (RFC 8089), its %xx decoded; empty: it is none of this machine.
std::string path_of_address(const std::string& address);

}  // namespace fettle::design::cli::mcp
