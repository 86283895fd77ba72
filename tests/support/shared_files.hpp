// SPDX-License-Identifier: MIT
/// The folder of shared material beside the project (scenes of the paper, ground-truth collision queries): not part of a clone, so a
/// test that needs it says so and is skipped without it:
///     FETTLE_NEEDS_SHARED();
///     auto scene = read(shared_file("scenes/fixtures/unit-tests/5-cubes.json"));
/// Place: environment variable FETTLE_SHARED, else FETTLE_SHARED_DIR of the build (../shared).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/support/skip.hpp"

namespace fettle::tests::support {

inline std::filesystem::path shared_folder() {
    const char* place = std::getenv("FETTLE_SHARED");
    return place != nullptr && *place != '\0' ? place : FETTLE_SHARED_DIR;
}

inline bool has_shared_files() { return std::filesystem::is_directory(shared_folder()); }

/// Full path. Throws if the folder is there and the file is not: that is a failure, not a reason to skip.
inline std::string shared_file(const std::string& path) {
    const std::filesystem::path full = shared_folder() / path;
    if (!std::filesystem::exists(full)) throw std::runtime_error("shared file is missing: " + full.string());
    return full.string();
}

}  // namespace fettle::tests::support

/// First line of a test case (catch2/catch.hpp included) that reads shared files.
#define FETTLE_NEEDS_SHARED()                          \
    if (!::fettle::tests::support::has_shared_files()) \
    FETTLE_SKIP("no folder " << ::fettle::tests::support::shared_folder() << " (set FETTLE_SHARED)")
