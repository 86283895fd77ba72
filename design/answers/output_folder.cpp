// SPDX-License-Identifier: MIT
#include "design/answers/output_folder.hpp"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/files/json_keys.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/records/trajectory_io.hpp"
#include "design/answers/run_folder.hpp"

namespace fettle::design::answers {

namespace {

namespace fs = std::filesystem;

// By its lines. It is not known for the first format, whose first line does not end the bodies: there may be any number.
std::size_t stored_steps(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::size_t steps = 0;
    std::string line;
    if (std::getline(stream, line) && !line.ends_with('}')) return std::numeric_limits<std::size_t>::max();
    while (std::getline(stream, line)) steps += line.starts_with("{\"nodes\"") ? 1 : 0;
    return steps;
}

// What somebody made, and a run reads; null: nothing of the kind.
const char* kind_of_input(const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return nullptr;
    if (core::mesh_files::has_mesh_extension(file.string())) return "a mesh";
    if (core::files::has_top_level_key(file, "fettle_design")) return "a design";
    return core::files::has_top_level_key(file, "fettle_scene") ? "a scene" : nullptr;
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
    Errors errors = others_files(folder, more);
    return errors.empty() ? try_output_folder(folder) : errors;
}

Errors try_output_file(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) return {{ErrorCode::file_unwritable, file.string(), "is a folder, a file is expected"}};
    if (core::files::is_written_directly(file)) {
        if (::access(file.c_str(), W_OK) == 0) return {};
        return {{ErrorCode::file_unwritable, file.string(), "cannot be written to: " + std::generic_category().message(errno)}};
    }
    if (const char* kind = kind_of_input(file); kind != nullptr)
        return {{ErrorCode::inconsistent, file.string(), std::string("is ") + kind + ", which would be replaced; write elsewhere"}};
    Errors errors = try_output_folder(file.has_parent_path() ? file.parent_path() : fs::path("."));
    for (Error& error : errors) error.where = file.string();
    return errors;
}

std::string name_for_longer_run(const fs::path& file, std::size_t steps) {
    if (!core::records::is_trajectory_file(file) || stored_steps(file) <= steps) return {};
    return core::files::free_name(file).string();
}

}  // namespace fettle::design::answers
