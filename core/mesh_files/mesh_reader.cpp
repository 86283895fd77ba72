// SPDX-License-Identifier: MIT
#include "core/mesh_files/mesh_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/geometry/connectivity.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

using geometry::Mesh;
using geometry::Triangle;

constexpr std::size_t max_listed = 5;
constexpr int most_corners = 10'000;              // of a polygon: cutting it takes half a second
constexpr std::int64_t most_tests = 800'000'000;  // of all polygons of a file together: six times what the worst of them takes

constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 31;  // so that every count of what is in it is an int

using Parse = Result<RawMesh> (*)(std::string_view bytes, const std::string& where);

/// Without a parser of our own assimp reads it, or Open CASCADE.
struct Format {
    std::string_view extension;
    bool states_unit = false;
    Parse parse = nullptr;
};
constexpr std::array<Format, 12> formats = {{{".stl", false, parse_stl},
                                             {".obj", false, parse_obj},
                                             {".off", false, parse_off},
                                             {".ply", false, parse_ply},
                                             {".3mf", true, parse_3mf},
                                             {".dae", true},
                                             {".gltf", true},
                                             {".glb", true},
                                             {".3ds", false},
                                             {".amf", true},
                                             {".step", true},
                                             {".stp", true}}};

std::string lower_case_extension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

const Format* format_of(const std::string& path) {
    const std::string extension = lower_case_extension(path);
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& each) { return each.extension == extension; });
    return found == formats.end() ? nullptr : &*found;
}

Errors checked_file(const std::string& path) {
    std::error_code code;
    const std::string full = std::filesystem::absolute(path, code).string();
    if (!std::filesystem::exists(path, code)) {
        return {{ErrorCode::file_not_found, path, "no such file; looked for it at " + (full.empty() ? path : full)}};
    }
    if (!std::filesystem::is_regular_file(path, code)) return {{ErrorCode::file_unreadable, path, "is not a file"}};
    std::ifstream file(path, std::ios::binary);
    if (!file) return {{ErrorCode::file_unreadable, path, "cannot be opened for reading"}};
    if (std::filesystem::file_size(path, code) > largest_file)
        return {{ErrorCode::out_of_range, path, "is larger than 2 GiB, which is the most that is read; export it in parts, or coarser"}};
    return {};
}

Result<RawMesh> read_raw(const std::string& path, const MeshReadOptions& options) {
    const Format* format = format_of(path);
    if (format == nullptr)
        return Error{ErrorCode::unsupported, path,
                     "extension `" + lower_case_extension(path) + "` is not a mesh format; allowed: " + mesh_extensions()};
    if (Errors errors = checked_file(path); !errors.empty()) return errors;
    if (is_step(path)) return read_step(path, options.chord, options.surface_tolerance, options.should_stop);
    if (format->parse == nullptr) return read_by_assimp(path, format->extension, options.should_stop);
    const auto text = files::read_file(path);
    if (!text) return text.errors();
    return format->parse(*text, path);
}

Errors check_numbers(const RawMesh& raw, const std::string& path) {
    Errors errors;
    std::size_t count = 0;
    for (std::size_t i = 0; i < raw.vertices.size(); ++i) {
        const Vector3& x = raw.vertices[i];
        if (base::is_usable_number(x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>()) || ++count > max_listed) continue;
        std::ostringstream text;
        text << "vertex " << i << " (counted from 0) is " << (x.allFinite() ? "beyond 1e30 m" : "not finite") << ": " << x.transpose()
             << "; export the mesh again";
        errors.push_back({x.allFinite() ? ErrorCode::out_of_range : ErrorCode::not_finite, path, text.str()});
    }
    if (count > max_listed) errors.push_back({errors.back().code, path, "and " + std::to_string(count - max_listed) + " more vertices"});
    return errors;
}

/// Triangles and, for each, the object that it comes from.
struct GroupedTriangles {
    std::vector<Triangle> triangles;
    std::vector<int> group;
    std::vector<int> face;  ///< of files that have faces
};

/// Polygons cut into triangles; with `weld` without those that have two equal corners.
Result<GroupedTriangles> grouped_triangles(const RawMesh& raw, bool weld, const std::string& path) {
    GroupedTriangles result;
    result.triangles.reserve(raw.polygon_ends.size());
    result.group.reserve(raw.polygon_ends.size());
    const auto add = [&](const Triangle& t, std::size_t polygon) {
        const Vector3 &a = raw.vertices[t[0]], &b = raw.vertices[t[1]], &c = raw.vertices[t[2]];
        if (weld && (a == b || b == c || c == a)) return;
        result.triangles.push_back(t);
        result.group.push_back(raw.polygon_group[polygon]);
        if (!raw.polygon_face.empty()) result.face.push_back(raw.polygon_face[polygon]);
    };
    int first = 0;
    std::int64_t tests = most_tests;
    for (std::size_t p = 0; p < raw.polygon_ends.size(); ++p) {
        const int* corners = raw.corners.data() + first;
        const int count = raw.polygon_ends[p] - first;
        first = raw.polygon_ends[p];
        if (count == 3) {
            add({corners[0], corners[1], corners[2]}, p);
            continue;
        }
        if (count > most_corners)
            return Error{ErrorCode::out_of_range, path,
                         "face " + std::to_string(p) + " (counted from 0) is a polygon of " + std::to_string(count) +
                             " vertices; at most " + std::to_string(most_corners) +
                             " are cut into triangles; export the mesh as triangles"};
        const std::vector<Triangle> pieces = triangulated(raw.vertices, corners, count, tests);
        if (tests < 0)
            return Error{ErrorCode::out_of_range, path,
                         "has too many polygons of many vertices that are not convex (up to face " + std::to_string(p) +
                             ", counted from 0) to be cut into triangles; export the mesh as triangles"};
        if (pieces.empty()) {
            std::ostringstream text;
            text << "face " << p << " (counted from 0), a polygon of " << count << " vertices near ("
                 << raw.vertices[corners[0]].transpose()
                 << "), has no area or an outline that crosses itself; export the mesh as triangles";
            return Error{ErrorCode::mesh_invalid, path, text.str()};
        }
        for (const Triangle& t : pieces) add(t, p);
    }
    return result;
}

/// Programs leave vertices behind that nothing uses: they are no part of the solid. A file of vertices alone is a file of points.
void drop_unused_vertices(RawMesh& raw, std::vector<Triangle>& triangles) {
    if (raw.corners.empty() && raw.edges.empty() && raw.points.empty()) return;
    std::erase_if(raw.edges, [&](const geometry::Edge& edge) { return raw.vertices[edge[0]] == raw.vertices[edge[1]]; });
    std::vector<int> place(raw.vertices.size(), -1);
    const auto visit_indices = [&](const auto& visit) {
        for (Triangle& triangle : triangles) std::for_each(triangle.begin(), triangle.end(), visit);
        for (geometry::Edge& edge : raw.edges) std::for_each(edge.begin(), edge.end(), visit);
        std::for_each(raw.points.begin(), raw.points.end(), visit);
    };
    visit_indices([&](const int vertex) { place[vertex] = 0; });
    int kept = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] < 0) continue;
        raw.vertices[kept] = raw.vertices[i];
        place[i] = kept++;
    }
    raw.vertices.resize(kept);
    visit_indices([&](int& vertex) { vertex = place[vertex]; });
}

/// A shell has the name of the object of its first triangle, numbered where the object has several shells; unnamed ones keep "file/3".
void name_shells(Mesh& mesh, const std::vector<int>& triangle_group, const std::vector<std::string>& groups) {
    FETTLE_ASSERT(mesh.triangles.size() == triangle_group.size(), "one object per triangle");
    std::vector<std::string> object(mesh.shell_names.size());
    for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
        const int group = triangle_group[t];
        object[mesh.triangle_shell[t]] = group < 0 ? "" : groups[group];
    }
    for (std::string& name : object) name = base::shown_on_one_line(name);  // control characters and what is no UTF-8, escaped
    std::map<std::string, int> total, used;
    for (const std::string& name : object) ++total[name];
    for (std::size_t s = 0; s < object.size(); ++s) {
        if (object[s].empty()) continue;
        mesh.shell_names[s] = total[object[s]] == 1 ? object[s] : object[s] + "/" + std::to_string(used[object[s]]++);
    }
}

/// The names of its faces alone, which follow one another in the file.
void take_faces(const std::vector<std::string>& names, RawMesh& out) {
    if (out.polygon_face.empty()) return;
    const auto [least, most] = std::minmax_element(out.polygon_face.begin(), out.polygon_face.end());
    const int first = *least;
    out.face_names.assign(names.begin() + first, names.begin() + *most + 1);
    for (int& face : out.polygon_face) face -= first;
}

/// The vertices and polygons of item `i`, as a file of their own.
RawMesh item_of(const RawMesh& raw, std::size_t i) {
    const RawItem& item = raw.items[i];
    const bool last = i + 1 == raw.items.size();
    const std::size_t vertices_end = last ? raw.vertices.size() : raw.items[i + 1].first_vertex,
                      polygons_end = last ? raw.polygon_ends.size() : raw.items[i + 1].first_polygon;
    RawMesh out;
    out.metres_per_unit = raw.metres_per_unit;
    const auto from = [](const auto& list, std::size_t at) { return list.begin() + static_cast<std::ptrdiff_t>(at); };
    out.vertices.assign(from(raw.vertices, item.first_vertex), from(raw.vertices, vertices_end));
    std::size_t corner = item.first_polygon == 0 ? 0 : static_cast<std::size_t>(raw.polygon_ends[item.first_polygon - 1]);
    for (std::size_t p = item.first_polygon; p < polygons_end; ++p) {
        for (; corner < static_cast<std::size_t>(raw.polygon_ends[p]); ++corner)
            out.corners.push_back(raw.corners[corner] - static_cast<int>(item.first_vertex));
        out.polygon_ends.push_back(count_of(out.corners));
        // The objects of an item follow one another: those of all items are copied once.
        const int group = raw.polygon_group[p], first_group = raw.polygon_group[item.first_polygon];
        if (static_cast<std::size_t>(group - first_group) >= out.groups.size())
            out.groups.insert(out.groups.end(), from(raw.groups, static_cast<std::size_t>(first_group) + out.groups.size()),
                              from(raw.groups, static_cast<std::size_t>(group) + 1));
        out.polygon_group.push_back(group - first_group);
        if (!raw.polygon_face.empty()) out.polygon_face.push_back(raw.polygon_face[p]);
    }
    take_faces(raw.face_names, out);
    out.items = {{item.name, 0, 0, item.deviation, item.colour}};
    return out;
}

/// @param name  of the mesh.
Result<Mesh> mesh_of(RawMesh& raw, const std::string& name, const std::string& path, const MeshReadOptions& options) {
    if (raw.vertices.empty()) return Error{ErrorCode::mesh_invalid, path, "has no vertices, so no triangles; is it the right file?"};
    // Scaled before anything is compared: rounding can make equal what was not in the file.
    const double unit = raw.metres_per_unit > 0 ? raw.metres_per_unit : options.unit;
    for (Vector3& x : raw.vertices) x *= unit;
    if (Errors errors = check_numbers(raw, path); !errors.empty()) return errors;
    auto faces = grouped_triangles(raw, options.weld, path);
    if (!faces) return faces.errors();
    drop_unused_vertices(raw, faces->triangles);
    if (raw.vertices.empty())
        return Error{ErrorCode::mesh_invalid, path, "has triangles of no area alone: each has two corners in one place; export it again"};

    Matrix3X vertices(3, raw.vertices.size());
    for (std::size_t i = 0; i < raw.vertices.size(); ++i) vertices.col(i) = raw.vertices[i];
    Mesh mesh;
    if (options.weld) {
        mesh = geometry::welded_mesh(name, vertices, faces->triangles, raw.edges);
    } else {
        mesh.name = name;
        mesh.vertices = std::move(vertices);
        mesh.triangles = std::move(faces->triangles);
        geometry::build_connectivity(mesh, raw.edges);
    }
    name_shells(mesh, faces->group, raw.groups);
    if (!faces->face.empty()) {
        mesh.triangle_face = std::move(faces->face);
        mesh.face_names = std::move(raw.face_names);
    }
    for (const RawItem& item : raw.items) {
        if (!item.deviation) continue;
        if (!mesh.deviation) mesh.deviation.emplace();
        mesh.deviation->add(*item.deviation);
        mesh.colour = raw.items.front().colour;
    }
    return mesh;
}

}  // namespace

std::string mesh_extensions() {
    std::string text;
    for (const Format& format : formats) (text += text.empty() ? "" : " ") += format.extension;
    return text;
}

bool has_mesh_extension(const std::string& path) { return format_of(path) != nullptr; }

bool is_step(const std::string& path) {
    const std::string extension = lower_case_extension(path);
    return extension == ".step" || extension == ".stp";
}

bool states_its_unit(const std::string& path) {
    const Format* format = format_of(path);
    return format != nullptr && format->states_unit;
}

Result<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options) {
    FETTLE_ASSERT(options.unit > 0, "the unit of a mesh file is a positive length");
    Result<RawMesh> raw = read_raw(path, options);
    if (!raw) return raw.errors();
    return mesh_of(*raw, std::filesystem::path(path).filename().string(), path, options);
}

Result<std::vector<Mesh>> read_mesh_parts(const std::string& path, const MeshReadOptions& options) {
    FETTLE_ASSERT(options.unit > 0, "the unit of a mesh file is a positive length");
    Result<RawMesh> raw = read_raw(path, options);
    if (!raw) return raw.errors();
    std::vector<Mesh> parts;
    Errors errors;
    const auto add = [&](RawMesh& part, const std::string& name) {
        Result<Mesh> mesh = mesh_of(part, name, path, options);
        errors.insert(errors.end(), mesh.errors().begin(), mesh.errors().end());
        if (mesh) parts.push_back(std::move(*mesh));
    };
    for (std::size_t i = 0; i < raw->items.size(); ++i) {
        RawMesh item = item_of(*raw, i);
        add(item, raw->items[i].name);
    }
    if (raw->items.empty()) add(*raw, std::filesystem::path(path).stem().string());
    if (!errors.empty()) return errors;
    return parts;
}

Result<Mesh> item_called(const std::vector<Mesh>& parts, const std::string& name, const std::string& path) {
    std::string names;
    std::vector<const Mesh*> found;
    constexpr std::size_t most_told = 30;
    const std::vector<std::string> called = item_names(parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (called[i] == name) return parts[i];
        if (parts[i].name == name) found.push_back(&parts[i]);
        if (i < most_told) names += (i == 0 ? "`" : ", `") + base::shown_on_one_line(called[i]) + "`";
    }
    if (found.size() == 1) return *found.front();
    return Error{ErrorCode::inconsistent, path,
                 std::string(found.empty() ? "has no item `" : "has several items `") + name + "`; it has " + names +
                     (parts.size() > most_told ? ", ..." : "")};
}

std::vector<std::string> item_names(const std::vector<Mesh>& parts) {
    std::map<std::string, int> counts, so_far;
    for (const Mesh& part : parts) ++counts[part.name];
    std::vector<std::string> names;
    for (const Mesh& part : parts)
        names.push_back(counts[part.name] == 1 ? part.name : part.name + "#" + std::to_string(++so_far[part.name]));
    return names;
}

}  // namespace fettle::core::mesh_files
