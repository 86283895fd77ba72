// SPDX-License-Identifier: MIT
#include "design/clearance/certificate_files.hpp"

#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"

namespace fettle::design::clearance {

std::string certificate_trajectory(const std::string& certificate) {
    std::string stem = certificate;
    for (const std::string ending : {".json", ".certificate"}) {
        if (stem.size() > ending.size() && stem.compare(stem.size() - ending.size(), ending.size(), ending) == 0)
            stem.resize(stem.size() - ending.size());
    }
    return stem + ".trajectory.json";
}

std::string name_from_certificate(const std::string& certificate, const std::string& file) {
    const auto whole = [](const std::filesystem::path& path) { return std::filesystem::absolute(path).lexically_normal(); };
    const std::filesystem::path full = whole(file), near = full.lexically_relative(whole(certificate).parent_path());
    const bool below = !near.empty() && *near.begin() != "..";
    return below ? near.string() : full.string();
}

std::filesystem::path file_of_certificate(const std::string& certificate, const std::string& name) {
    return std::filesystem::path(certificate).parent_path() / name;  // a whole path stays as it is
}

Result<std::vector<core::certificate::ExportedFile>> named_files(const std::vector<std::string>& files, const std::string& certificate) {
    std::vector<core::certificate::ExportedFile> named;
    Errors errors;
    for (const std::string& file : files) {
        const Result<std::string> bytes = core::files::read_file(file);
        errors.insert(errors.end(), bytes.errors().begin(), bytes.errors().end());
        if (!bytes) continue;
        named.push_back({name_from_certificate(certificate, file), core::files::hash_of(*bytes), 0});
    }
    if (!errors.empty()) return errors;
    return named;
}

}  // namespace fettle::design::clearance
