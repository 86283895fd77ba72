// SPDX-License-Identifier: MIT
/// Joins warnings that say the same of several elements of one list: seven cards of a house that are shells each give
///     a.json#/bodies/[1-5, 7, 8]: the mesh is open: it is a shell, and its density is per square metre
#pragma once

#include <string>
#include <vector>

namespace fettle::core::files {

struct Warning {
    std::string pointer;  ///< RFC 6901: "/bodies/3/density"
    std::string message;
};

/// "PATH#POINTER: MESSAGE", one of each message per place but for the last index in it, in the order of their first.
std::vector<std::string> grouped_warnings(const std::string& path, const std::vector<Warning>& warnings);

}  // namespace fettle::core::files
