// SPDX-License-Identifier: MIT
// Solids of STEP files, which Open CASCADE reads for us in a process of its own (core/step_importer).
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "core/base/text.hpp"
#include "core/files/input_file.hpp"
#include "core/files/unique_names.hpp"
#include "core/mesh_files/import_answer.hpp"
#include "core/mesh_files/import_process.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr std::uint64_t largest_step_answer = 1024 * megabyte;  // more than most_placed vertices take, faces and names included
const std::string install = "sudo apt-get install libocct-data-exchange-dev && cmake --preset release && cmake --build --preset release";

ImportLimits limits_for(std::uint64_t size) {
    const std::uint64_t megabytes = size / megabyte;
    return {static_cast<unsigned>(60 + 20 * std::min<std::uint64_t>(megabytes, 200)), 2048 * megabyte + 200 * megabytes * megabyte,
            largest_step_answer};
}

/// Its first and last words, which Open CASCADE does not insist on: empty if they are there.
std::string cut_off(const std::string& path, std::uint64_t size) {
    constexpr std::uint64_t looked_at = 4096;
    std::ifstream file(path, std::ios::binary);
    std::string begin(std::min(size, looked_at), ' '), end = begin;
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    file.seekg(static_cast<std::streamoff>(size - end.size()));
    file.read(end.data(), static_cast<std::streamsize>(end.size()));
    if (begin.find("ISO-10303-21;") == std::string::npos)
        return "is no STEP file in plain text: it does not begin with ISO-10303-21; (of .stpz and .stpx export .step)";
    if (end.find("END-ISO-10303-21;") == std::string::npos)
        return "is cut off: it does not end with END-ISO-10303-21; export or download it again";
    return {};
}

}  // namespace

Result<RawMesh> read_step(const std::string& path, double chord, double surface_tolerance, const std::function<bool()>& should_stop) {
    if (!has_importer(Importer::step))
        return Error{ErrorCode::unsupported, path,
                     "this fettle was built without Open CASCADE, which reads STEP files; install it and build again: " + install};
    std::error_code code;
    const std::uint64_t size = std::filesystem::file_size(path, code);
    if (const std::string fault = cut_off(path, code ? 0 : size); !fault.empty()) return Error{ErrorCode::parse, path, fault};
    files::record_file(path);
    const ImportLimits limits = limits_for(size);
    const auto number = [](double value) { return base::formatted("%.17g", value); };
    const ImportOutcome outcome = run_importer(Importer::step, path, {number(chord), number(surface_tolerance)}, limits, should_stop);
    std::optional<RawMesh> mesh = answered_mesh(outcome.written);
    if (!mesh || mesh->items.empty()) {
        const ImportWords words{"Open CASCADE, the library that reads STEP files,", "", "install it: " + install,
                                "Open CASCADE gives no reason"};
        return import_failure(outcome, limits, path, words, answered_reason(outcome.written));
    }
    mesh->metres_per_unit = 1;
    files::UniqueNames names("#");
    for (std::size_t i = 0; i < mesh->items.size(); ++i)
        mesh->groups[i] = mesh->items[i].name = names.unique(mesh->items[i].name.empty() ? "solid" : mesh->items[i].name);
    return std::move(*mesh);
}

}  // namespace fettle::core::mesh_files
