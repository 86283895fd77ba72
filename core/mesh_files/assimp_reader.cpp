// SPDX-License-Identifier: MIT
// Formats that assimp reads for us, in a process of their own.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/files/input_file.hpp"
#include "core/files/text_lines.hpp"
#include "core/mesh_files/import_answer.hpp"
#include "core/mesh_files/import_process.hpp"
#include "core/mesh_files/raw_mesh.hpp"
#include "core/mesh_files/xml_reader.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr std::uint64_t largest_answer = 512 * megabyte;  // twice what most_placed vertices take; beyond that it is names

/// Several times what assimp takes for files that are as they should be: buffers that a file only names are not counted in its size.
ImportLimits limits_for(const std::string& path) {
    std::error_code code;
    const std::uint64_t size = std::filesystem::file_size(path, code), megabytes = code ? 0 : size / megabyte;
    return {static_cast<unsigned>(3 + std::min<std::uint64_t>(megabytes, 1000)), 1024 * megabyte + 100 * megabytes * megabyte,
            largest_answer};
}

/// What assimp says most often of damaged files and of other ones; the rest stays as it is.
std::string in_plain_words(const std::string& reason) {
    for (const auto& [said, words] : {std::pair{"No suitable reader found", "its contents are not of the kind that its name says"},
                                      {"3DS file is either empty or corrupt", "it is damaged or not a 3DS file"},
                                      {"StreamReader: File is empty or EOF", "it ends too early"},
                                      {"Unable to read file, malformed XML", "it is damaged or not XML"}})
        if (reason.starts_with(said)) return words;
    return reason;
}

/// What the unit of a format that has one is, in metres. glTF: metres. COLLADA: assimp has put its <unit> into the positions. 3DS: none.
Result<double> metres_per_unit(const std::string& path, std::string_view extension) {
    if (extension == ".3ds") return 0.0;
    if (extension != ".amf") return 1.0;
    const auto text = files::read_file(path);
    if (!text) return text.errors();
    XmlReader xml(*text, path);
    std::string unit;
    xml.read([&] {
        unit = xml.attribute("unit").value_or("millimeter");
        xml.stop();
    });
    if (!xml.errors().empty()) return xml.errors();
    for (const auto& [name, metres] : {std::pair{"millimeter", 1e-3}, {"inch", 0.0254}, {"feet", 0.3048}, {"meter", 1.0}, {"micron", 1e-6}})
        if (unit == name) return metres;
    return Error{ErrorCode::out_of_range, xml.where(), "the unit `" + unit + "` must be millimeter, inch, feet, meter or micron"};
}

}  // namespace

Result<RawMesh> read_by_assimp(const std::string& path, std::string_view extension, const std::function<bool()>& should_stop) {
    std::error_code code;
    if (std::filesystem::file_size(path, code) == 0) return Error{ErrorCode::parse, path, "is empty; export or download it again"};
    const auto unit = metres_per_unit(path, extension);
    if (!unit) return unit.errors();
    files::record_file(path);
    const ImportLimits limits = limits_for(path);
    const ImportOutcome outcome = run_importer(Importer::assimp, path, {}, limits, should_stop);
    std::optional<RawMesh> mesh = answered_mesh(outcome.written);
    if (!mesh) {
        const std::string other = "as .3mf, .obj, .stl, .off or .ply";
        const ImportWords words{"assimp, the library that reads files of this kind,", "; export it again, or " + other,
                                "install it, or export the mesh " + other, "assimp gives no reason"};
        const std::string reason = in_plain_words(answered_reason(outcome.written));
        return import_failure(outcome, limits, path, words, reason);
    }
    mesh->metres_per_unit = *unit;
    return std::move(*mesh);
}

}  // namespace fettle::core::mesh_files
