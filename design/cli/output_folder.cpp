// SPDX-License-Identifier: MIT
#include "fettle/design/cli/output_folder.hpp"

#include <fstream>
#include <limits>
#include <system_error>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/run_folder.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;

// By its lines. Of the first format, whose first line does not end the bodies, it is not known: there may be any number.
std::size_t stored_steps(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::size_t steps = 0;
    std::string line;
    if (std::getline(stream, line) && !line.ends_with('}')) return std::numeric_limits<std::size_t>::max();
    while (std::getline(stream, line)) steps += line.starts_with("{\"nodes\"") ? 1 : 0;
    return steps;
}

}  // namespace

Errors try_output_folder(const fs::path& folder) {
    const fs::path probe = folder / ".fettle_can_write";
    Errors errors = core::files::write_file_atomically(probe, "");
    for (Error& error : errors) error.where = folder.string();
    std::error_code ignored;
    fs::remove(probe, ignored);
    return errors;
}

Errors try_run_folder(const fs::path& folder, const std::vector<std::string>& more) {
    Errors errors = answers::others_files(folder, more);
    return errors.empty() ? try_output_folder(folder) : errors;
}

Errors try_output_file(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) return {{ErrorCode::file_unwritable, file.string(), "is a folder, a file is wanted"}};
    Errors errors = try_output_folder(file.has_parent_path() ? file.parent_path() : fs::path("."));
    for (Error& error : errors) error = {error.code, file.string(), "in " + error.where + ": " + error.message};
    return errors;
}

std::string name_for_longer_run(const fs::path& file, std::size_t steps) {
    if (!core::records::is_trajectory_file(file) || stored_steps(file) <= steps) return {};
    for (int n = 1;; ++n) {
        fs::path kept = file;
        kept.replace_extension(std::to_string(n) + file.extension().string());
        std::error_code ignored;
        if (!fs::exists(fs::symlink_status(kept, ignored))) return kept.string();
    }
}

}  // namespace fettle::design::cli
