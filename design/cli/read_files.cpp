// SPDX-License-Identifier: MIT
#include "design/cli/read_files.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>

#include "core/certificate/certificate.hpp"
#include "core/files/atomic_file.hpp"
#include "core/mesh_files/find_mesh_file.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;

/// Every text of a JSON file with the key before it; without recursion, up to where it is not JSON any more.
struct Texts : nlohmann::json_sax<nlohmann::json> {
    std::function<void(const std::string& key, const std::string& text)> take;
    std::string last_key;

    explicit Texts(decltype(take) take_one) : take(std::move(take_one)) {}
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& text) override {
        take(last_key, text);
        return true;
    }
    bool binary(binary_t& /*value*/) override { return true; }
    bool start_object(std::size_t /*size*/) override { return true; }
    bool key(string_t& text) override {
        last_key = text;
        return true;
    }
    bool end_object() override { return true; }
    bool start_array(std::size_t /*size*/) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t /*at*/, const std::string& /*token*/, const nlohmann::detail::exception& /*error*/) override {
        return false;
    }
};

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// Follows names from file to file, each file once.
class Reader {
public:
    explicit Reader(const GivenFiles& given) : given_(given) {}

    void follow(const std::string& path) {
        std::error_code ignored;
        if (!seen_.insert(fs::weakly_canonical(path, ignored).string()).second) return;
        if (fs::is_directory(path, ignored)) return follow_folder(path);
        if (!is_file(path)) return;
        const FileKind kind = file_kind(path);
        if (kind == FileKind::mesh) return;
        if (kind == FileKind::certificate) add(path, clearance::certificate_trajectory(path));
        const auto text = core::files::read_file(path);
        if (!text) return;
        if (path.ends_with(".urdf")) return follow_urdf(path, *text);
        const bool lines = kind == FileKind::trajectory || path.ends_with(".jsonl");  // the first one names files
        const std::string_view head = lines ? std::string_view(*text).substr(0, text->find('\n')) : std::string_view(*text);
        Texts texts([&](const std::string& key, const std::string& name) {
            if (names_a_file(kind, lines, key)) take(path, name);
        });
        nlohmann::json::sax_parse(head.begin(), head.end(), &texts);
    }

    std::vector<NamedFile> found;

private:
    // An export may write once more what the certificate tells of an export before.
    bool names_a_file(FileKind kind, bool lines, const std::string& key) const {
        if (kind == FileKind::certificate) return key == "source" || (key == "file" && given_.command != "export");
        return !lines || key == "scene" || key == "file";
    }

    void add(const std::string& by, const std::string& file) {
        if (!is_file(file)) return;
        found.push_back({by, file, false});
        follow(file);
    }

    // As the readers look for it: beside the file, in the folders of meshes; what trajectories name, from the current folder.
    void take(const std::string& by, const std::string& name) {
        constexpr std::size_t longest = 4096;
        const std::size_t package = name.find("://");  // of URDF
        if (name.size() > longest || name.find('.') == std::string::npos || name.find('\n') != std::string::npos) return;
        const std::string file = package == std::string::npos ? name : name.substr(package + 3);
        if (const auto there = core::mesh_files::find_mesh_file(file, by, given_.mesh_dirs, by)) add(by, *there);
        add(by, file);
    }

    void follow_folder(const std::string& folder) {
        std::error_code ignored;
        if (clearance::are_meshes({folder})) {
            for (const auto& entry : fs::directory_iterator(folder, ignored))
                if (core::mesh_files::has_mesh_extension(entry.path().string())) add(folder, entry.path().string());
        }
        for (const char* name : {"result.json", "trajectory.json", "trajectory.running.json", "trajectory.start.json", "history.jsonl",
                                 "design.final.json", "steps.csv", "contacts.csv", "drives.csv", "joints.csv"}) {
            const std::string file = (fs::path(folder) / name).string();
            if (std::string_view(name) == "result.json" && is_file(file)) {
                found.push_back({folder, file, false});  // the files that it names are those that were written
            } else {
                add(folder, file);
            }
        }
    }

    void follow_urdf(const std::string& path, const std::string& text) {
        constexpr std::string_view attribute = "filename=";
        for (std::size_t at = text.find(attribute); at != std::string::npos; at = text.find(attribute, at + 1)) {
            const std::size_t begin = at + attribute.size() + 1, end = text.find(text[std::min(begin, text.size()) - 1], begin);
            if (end != std::string::npos) take(path, text.substr(begin, end - begin));
        }
    }

    const GivenFiles& given_;
    std::set<std::string> seen_;
};

}  // namespace

std::vector<NamedFile> files_read(const GivenFiles& given) {
    Reader reader(given);
    for (const NamedFile& named : given.named) {
        const bool leads_on = !named.option.starts_with("-") || named.option == "--trajectory" || named.option == "--continue";
        if (!named.is_written && leads_on) reader.follow(named.file);
    }
    return reader.found;
}

Errors replaced_inputs(const std::vector<NamedFile>& written, const GivenFiles& given) {
    std::vector<NamedFile> files;
    for (const NamedFile& file : written)
        if (file.is_written && is_file(file.file)) files.push_back(file);
    if (files.empty()) return {};  // what is given may be large
    for (const NamedFile& file : given.named)
        if (!file.is_written) files.push_back(file);
    const std::vector<NamedFile> read = files_read(given);
    files.insert(files.end(), read.begin(), read.end());
    return named_twice(files);
}

}  // namespace fettle::design::cli
