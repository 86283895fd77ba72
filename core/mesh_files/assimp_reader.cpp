// SPDX-License-Identifier: MIT
// Formats that assimp reads for us, in a process of their own. What comes back is taken as if a stranger had written it: the process may
// have been made to write anything.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/files/input_file.hpp"
#include "core/files/text_lines.hpp"
#include "core/mesh_files/import_format.hpp"
#include "core/mesh_files/import_process.hpp"
#include "core/mesh_files/raw_mesh.hpp"
#include "core/mesh_files/xml_reader.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr std::uint64_t megabyte = 1 << 20;
constexpr int could_not_load = 127;                       // the loader's own exit code
constexpr std::uint64_t largest_answer = 512 * megabyte;  // twice what most_placed vertices take; beyond that it is names

/// Several times what assimp takes for files that are as they should be: buffers that a file only names are not counted in its size.
ImportLimits limits_for(const std::string& path) {
    std::error_code code;
    const std::uint64_t size = std::filesystem::file_size(path, code), megabytes = code ? 0 : size / megabyte;
    return {static_cast<unsigned>(3 + std::min<std::uint64_t>(megabytes, 1000)), 1024 * megabyte + 100 * megabytes * megabyte,
            largest_answer};
}

/// Takes values from the front; nullopt for more than there is.
class Bytes {
public:
    explicit Bytes(std::string_view bytes) : left_(bytes) {}

    template <class Value>
    std::optional<Value> one() {
        Value value{};
        if (left_.size() < sizeof value) return std::nullopt;
        std::memcpy(&value, left_.data(), sizeof value);
        left_.remove_prefix(sizeof value);
        return value;
    }
    template <class Value>
    bool list(std::uint64_t count, std::vector<Value>& to) {
        if (count > left_.size() / sizeof(Value)) return false;
        to.resize(count);
        if (count > 0) std::memcpy(static_cast<void*>(to.data()), left_.data(), count * sizeof(Value));
        left_.remove_prefix(count * sizeof(Value));
        return true;
    }
    std::optional<std::string> text(std::size_t length) {
        if (length > left_.size()) return std::nullopt;
        std::string out(left_.substr(0, length));
        left_.remove_prefix(length);
        return out;
    }

private:
    std::string_view left_;
};

bool all_in(const std::vector<int>& indices, std::size_t count) {
    return std::all_of(indices.begin(), indices.end(), [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < count; });
}

/// nullopt: not what the importer writes of a mesh.
std::optional<RawMesh> mesh_of(std::string_view written) {
    static_assert(sizeof(Vector3) == 3 * sizeof(double) && sizeof(geometry::Edge) == 2 * sizeof(int));
    Bytes bytes(written);
    const auto header = bytes.one<ImportHeader>();
    RawMesh mesh;
    if (!header || header->mark != import_is_mesh || !bytes.list(header->vertices, mesh.vertices) ||
        !bytes.list(header->corners, mesh.corners) || !bytes.list(header->polygons, mesh.polygon_ends) ||
        !bytes.list(header->polygons, mesh.polygon_group) || !bytes.list(header->edges, mesh.edges) ||
        !bytes.list(header->points, mesh.points))
        return std::nullopt;
    for (std::uint64_t i = 0; i < header->names; ++i) {
        const auto length = bytes.one<std::uint32_t>();
        auto name = length ? bytes.text(*length) : std::nullopt;
        if (!name) return std::nullopt;
        mesh.groups.push_back(std::move(*name));
    }
    if (bytes.one<std::uint64_t>() != import_end) return std::nullopt;
    const auto good_end = [&](const geometry::Edge& edge) { return all_in({edge[0], edge[1]}, mesh.vertices.size()); };
    if (!all_in(mesh.corners, mesh.vertices.size()) || !all_in(mesh.points, mesh.vertices.size()) ||
        !all_in(mesh.polygon_group, mesh.groups.size()) || !std::all_of(mesh.edges.begin(), mesh.edges.end(), good_end))
        return std::nullopt;
    std::int64_t last = 0;
    for (const int end : mesh.polygon_ends) {
        if (end < last + 3) return std::nullopt;
        last = end;
    }
    if (static_cast<std::size_t>(last) != mesh.corners.size()) return std::nullopt;
    return mesh;
}

/// The reason that the importer gives; empty if it gives none.
std::string reason_of(std::string_view written) {
    Bytes bytes(written);
    const auto header = bytes.one<ImportHeader>();
    if (!header || header->mark != import_is_failure) return "";
    std::string reason(written.substr(sizeof *header, 300));
    std::replace_if(
        reason.begin(), reason.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, ' ');
    return reason;
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

Error failure(const ImportOutcome& outcome, const ImportLimits& limits, const std::string& path) {
    using End = ImportOutcome::End;
    const std::string library = "assimp, the library that reads files of this kind, ", other = "as .3mf, .obj, .stl, .off or .ply",
                      instead = "; export it again, or " + other;
    const std::string memory = std::to_string(limits.memory / megabyte) + " MiB";
    switch (outcome.end) {
        case End::out_of_time:
            return {ErrorCode::parse, path, library + "came to no end in " + std::to_string(limits.seconds) + " s" + instead};
        case End::killed:
            return {ErrorCode::parse, path, library + "crashed over it (signal " + std::to_string(outcome.code) + ")" + instead};
        case End::too_large:
            return {ErrorCode::out_of_range, path,
                    "is too large: what it places takes more than " + std::to_string(limits.largest / megabyte) + " MiB" + instead};
        case End::stopped:
            return {ErrorCode::file_unreadable, path, "was not read to its end: stopped on request"};
        case End::not_started:
            return {
                ErrorCode::unsupported, path,
                "the program that reads files of this kind cannot be started: " + std::generic_category().message(outcome.code) + instead};
        case End::exited:
            break;
    }
    if (outcome.code == could_not_load)
        return {ErrorCode::unsupported, path, library + "cannot be loaded; install it, or export the mesh " + other};
    if (outcome.code == import_out_of_memory)
        return {ErrorCode::out_of_range, path, library + "wants more than " + memory + " of memory for it" + instead};
    if (outcome.code == import_too_large)
        return {ErrorCode::out_of_range, path, "is too large: it places more than 10 million vertices and triangles" + instead};
    const std::string reason = in_plain_words(reason_of(outcome.written));
    return {ErrorCode::parse, path, "cannot be read as a mesh: " + (reason.empty() ? "assimp gives no reason" : reason) + instead};
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
    const ImportOutcome outcome = run_importer(path, limits, should_stop);
    std::optional<RawMesh> mesh = mesh_of(outcome.written);
    if (!mesh) return failure(outcome, limits, path);
    mesh->metres_per_unit = *unit;
    return std::move(*mesh);
}

}  // namespace fettle::core::mesh_files
