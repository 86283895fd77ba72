// SPDX-License-Identifier: MIT
#include "fettle/design/cli/outputs_apart.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "fettle/core/files/json_document.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/cli/mesh_subject.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using core::files::JsonNode;

/// A file, the option that it comes from, and the file that names it; empty: the option does.
struct NamedFile {
    std::string option;
    fs::path path;
    std::string by = {};
};

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    if (fs::equivalent(a, b, ignored)) return fs::is_regular_file(a, ignored);
    if (fs::exists(a, ignored) || fs::exists(b, ignored)) return false;
    return fs::weakly_canonical(fs::absolute(a), ignored) == fs::weakly_canonical(fs::absolute(b), ignored);
}

// Every text of a scene or design that is the name of a file.
std::vector<fs::path> files_named_in(const std::string& path, const std::vector<std::string>& mesh_dirs) {
    std::vector<fs::path> files;
    auto document = core::files::JsonDocument::read(path);
    if (!document) return files;  // its reader tells why
    std::vector<fs::path> folders{fs::path(path).parent_path()};
    folders.insert(folders.end(), mesh_dirs.begin(), mesh_dirs.end());
    std::vector<JsonNode> open{document->root()};
    while (!open.empty()) {
        const JsonNode node = open.back();
        open.pop_back();
        if (node.is_array()) {
            for (JsonNode& each : node.elements()) open.push_back(std::move(each));
        } else if (node.is_object()) {
            for (auto& [key, member] : node.members()) open.push_back(std::move(member));
        } else if (node.is_string()) {
            const std::string name = node.string().value_or("");
            std::error_code ignored;
            for (const fs::path& folder : folders)
                if (!name.empty() && fs::is_regular_file(folder / name, ignored)) files.push_back(folder / name);
        }
    }
    return files;
}

std::vector<fs::path> files_of_folder(const fs::path& folder) {
    if (const auto trajectory = trajectory_in(folder.string())) return {*trajectory, folder / "result.json"};
    std::vector<fs::path> meshes;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder, code))
        if (file_kind(entry.path().string()) == FileKind::mesh) meshes.push_back(entry.path());
    return meshes;
}

// What is read with a file or folder, itself among it.
std::vector<NamedFile> read_with(const GivenValue& given, const std::vector<std::string>& mesh_dirs) {
    std::vector<NamedFile> files{{given.option, given.value}};
    std::set<fs::path> known;  // a scene may name itself
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string path = files[i].path.string();
        std::error_code code;
        std::vector<fs::path> more;
        if (!known.insert(fs::weakly_canonical(path, code)).second) continue;
        if (fs::is_directory(path, code)) {
            more = files_of_folder(path);
        } else if (fs::is_regular_file(path, code)) {
            const FileKind kind = file_kind(path);
            if (kind == FileKind::scene || kind == FileKind::design) more = files_named_in(path, mesh_dirs);
            if (kind == FileKind::certificate) more = {certificate_trajectory(path)};
        }
        for (const fs::path& file : more) files.push_back({given.option, file, path});
    }
    return files;
}

Error conflict(const NamedFile& output, const NamedFile& other, const std::string& does) {
    return {ErrorCode::inconsistent, output.option,
            output.path.string() + " is what " + other.option + " " + does + (other.by.empty() ? "" : ", named by " + other.by) +
                ": it would be destroyed; write elsewhere"};
}

bool is_one_of(const std::vector<std::string>& options, const std::string& option) {
    return std::find(options.begin(), options.end(), option) != options.end();
}

}  // namespace

Errors check_outputs_apart(const Command& command, const std::vector<GivenValue>& given, const CommonOptions& common) {
    std::vector<std::string> writes{"--log", "--junit", "--sarif", "--markdown"};
    writes.insert(writes.end(), command.files.writes.begin(), command.files.writes.end());
    std::vector<NamedFile> outputs;
    Errors errors;
    for (const GivenValue& value : given) {
        if (!is_one_of(writes, value.option)) continue;
        const NamedFile output{value.option, value.value};
        for (const NamedFile& other : outputs)
            if (is_same_file(output.path, other.path)) errors.push_back(conflict(output, other, "writes too"));
        outputs.push_back(output);
    }
    std::error_code ignored;
    const auto is_there = [&](const NamedFile& output) { return fs::is_regular_file(output.path, ignored); };
    if (std::none_of(outputs.begin(), outputs.end(), is_there)) return errors;  // then none of them is read
    for (const GivenValue& value : given) {
        if (!is_one_of(command.files.reads, value.option)) continue;
        for (const NamedFile& input : read_with(value, common.mesh_dirs))
            for (const NamedFile& output : outputs)
                if (is_same_file(output.path, input.path)) errors.push_back(conflict(output, input, "reads"));
    }
    return errors;
}

}  // namespace fettle::design::cli
