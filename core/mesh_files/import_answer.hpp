// SPDX-License-Identifier: MIT
/// What a program that reads a file in a process of its own (import_process.hpp) has answered. It is taken as if a stranger had written it:
/// the process may have been made to write anything.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.hpp"
#include "core/mesh_files/import_process.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {

inline constexpr std::uint64_t megabyte = 1 << 20;

/// nullopt: not what an importer writes of a mesh.
std::optional<RawMesh> answered_mesh(std::string_view written);

/// The reason that an importer gives; empty if it gives none.
std::string answered_reason(std::string_view written);

/// How messages speak of the library that reads, and of what to do where it does not.
struct ImportWords {
    std::string library;    ///< "assimp, the library that reads files of this kind,"
    std::string instead;    ///< "; export it again, or as .3mf"
    std::string install;    ///< what to do where the library cannot be loaded
    std::string no_reason;  ///< "assimp gives no reason"
};

/// Why there is no mesh. @param reason  answered_reason() in plain words
Error import_failure(const ImportOutcome& outcome, const ImportLimits& limits, const std::string& path, const ImportWords& words,
                     const std::string& reason);

}  // namespace fettle::core::mesh_files
