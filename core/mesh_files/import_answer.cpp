// SPDX-License-Identifier: MIT
#include "core/mesh_files/import_answer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <system_error>

#include "core/mesh_files/import_format.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr int could_not_load = 127;  // the loader's own exit code

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
    bool texts(std::uint64_t count, std::vector<std::string>& to) {
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto length = one<std::uint32_t>();
            auto value = length ? text(*length) : std::nullopt;
            if (!value) return false;
            to.push_back(std::move(*value));
        }
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

/// Are the polygons of each item its own: of its vertices, under its name?
bool are_apart(const RawMesh& mesh) {
    for (std::size_t i = 0; i < mesh.items.size(); ++i) {
        const RawItem& item = mesh.items[i];
        const bool last = i + 1 == mesh.items.size();
        const std::size_t vertices_end = last ? mesh.vertices.size() : mesh.items[i + 1].first_vertex,
                          polygons_end = last ? mesh.polygon_ends.size() : mesh.items[i + 1].first_polygon;
        if (item.first_vertex >= vertices_end || item.first_polygon >= polygons_end) return false;
        std::size_t corner = item.first_polygon == 0 ? 0 : static_cast<std::size_t>(mesh.polygon_ends[item.first_polygon - 1]);
        for (std::size_t p = item.first_polygon; p < polygons_end; ++p) {
            if (mesh.polygon_group[p] != static_cast<int>(i)) return false;
            for (; corner < static_cast<std::size_t>(mesh.polygon_ends[p]); ++corner) {
                const auto vertex = static_cast<std::size_t>(mesh.corners[corner]);
                if (vertex < item.first_vertex || vertex >= vertices_end) return false;
            }
        }
    }
    return true;
}

/// The bodies of a STEP file: each name is a solid's.
bool take_bodies(const ImportHeader& header, Bytes& bytes, RawMesh& mesh) {
    if (header.bodies == 0) return header.faces == 0;
    std::vector<ImportBody> bodies;
    if (header.bodies != header.names || !bytes.list(header.bodies, bodies) || !bytes.list(header.polygons, mesh.polygon_face) ||
        !bytes.texts(header.faces, mesh.face_names) || !all_in(mesh.polygon_face, mesh.face_names.size()))
        return false;
    RawItem last;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const ImportBody& body = bodies[i];
        RawItem item{mesh.groups[i], body.first_vertex, body.first_polygon};
        if (item.first_vertex < last.first_vertex || item.first_polygon < last.first_polygon || item.first_vertex > mesh.vertices.size() ||
            item.first_polygon > mesh.polygon_ends.size())
            return false;
        for (const double length : {body.out, body.in, body.declared})
            if (!(length >= 0) || !std::isfinite(length)) return false;
        const bool is_proven = body.is_proven == 1;
        item.deviation = geometry::Deviation{body.out, body.in, is_proven, is_proven, body.declared};
        if (const std::uint32_t colour = body.colour; (colour >> 24) == 1)
            item.colour = {static_cast<unsigned char>(colour >> 16), static_cast<unsigned char>(colour >> 8),
                           static_cast<unsigned char>(colour)};
        last = item;
        mesh.items.push_back(std::move(item));
    }
    return !mesh.items.empty() && mesh.items.front().first_vertex == 0 && mesh.items.front().first_polygon == 0;
}

}  // namespace

std::optional<RawMesh> answered_mesh(std::string_view written) {
    static_assert(sizeof(Vector3) == 3 * sizeof(double) && sizeof(geometry::Edge) == 2 * sizeof(int));
    Bytes bytes(written);
    const auto header = bytes.one<ImportHeader>();
    RawMesh mesh;
    if (!header || header->mark != import_is_mesh || !bytes.list(header->vertices, mesh.vertices) ||
        !bytes.list(header->corners, mesh.corners) || !bytes.list(header->polygons, mesh.polygon_ends) ||
        !bytes.list(header->polygons, mesh.polygon_group) || !bytes.list(header->edges, mesh.edges) ||
        !bytes.list(header->points, mesh.points))
        return std::nullopt;
    if (!bytes.texts(header->names, mesh.groups) || !take_bodies(*header, bytes, mesh) || bytes.one<std::uint64_t>() != import_end)
        return std::nullopt;
    const auto good_end = [&](const geometry::Edge& edge) { return all_in({edge[0], edge[1]}, mesh.vertices.size()); };
    if (!all_in(mesh.corners, mesh.vertices.size()) || !all_in(mesh.points, mesh.vertices.size()) ||
        !all_in(mesh.polygon_group, mesh.groups.size()) || !std::all_of(mesh.edges.begin(), mesh.edges.end(), good_end))
        return std::nullopt;
    std::int64_t last = 0;
    for (const int end : mesh.polygon_ends) {
        if (end < last + 3) return std::nullopt;
        last = end;
    }
    if (static_cast<std::size_t>(last) != mesh.corners.size() || !are_apart(mesh)) return std::nullopt;
    return mesh;
}

std::string answered_reason(std::string_view written) {
    Bytes bytes(written);
    const auto header = bytes.one<ImportHeader>();
    if (!header || header->mark != import_is_failure) return "";
    std::string reason(written.substr(sizeof *header, 600));
    std::replace_if(
        reason.begin(), reason.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, ' ');
    return reason;
}

Error import_failure(const ImportOutcome& outcome, const ImportLimits& limits, const std::string& path, const ImportWords& words,
                     const std::string& reason) {
    using End = ImportOutcome::End;
    const std::string library = words.library + " ", &instead = words.instead;
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
    if (outcome.code == could_not_load) return {ErrorCode::unsupported, path, library + "cannot be loaded; " + words.install};
    if (outcome.code == import_out_of_memory)
        return {ErrorCode::out_of_range, path, library + "wants more than " + memory + " of memory for it" + instead};
    if (outcome.code == import_too_large)
        return {ErrorCode::out_of_range, path, "is too large: it places more than 10 million vertices and triangles" + instead};
    return {ErrorCode::parse, path, "cannot be read: " + (reason.empty() ? words.no_reason : reason) + instead};
}

}  // namespace fettle::core::mesh_files
