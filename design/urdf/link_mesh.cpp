// SPDX-License-Identifier: MIT
#include "design/urdf/link_mesh.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "core/geometry/mesh_transforms.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "design/shapes/file_part.hpp"

namespace fettle::design::urdf {

namespace {

namespace fs = std::filesystem;
using core::geometry::Mesh;

constexpr int sphere_rounds = 3;  // of an octahedron cut in four: 512 triangles

/// Vertices on the sphere.
Mesh sphere_mesh(double radius) {
    std::vector<Vector3> vertices{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<core::geometry::Triangle> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int round = 0; round < sphere_rounds; ++round) {
        std::map<std::array<int, 2>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [found, added] = middles.insert({{std::min(a, b), std::max(a, b)}, count_of(vertices)});
            if (added) vertices.push_back((vertices[a] + vertices[b]).normalized());
            return found->second;
        };
        std::vector<core::geometry::Triangle> finer;
        for (const auto& t : triangles) {
            const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    Matrix3X x(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(i) = radius * vertices[i];
    return core::geometry::make_mesh("sphere", x, triangles);
}

Result<Mesh> part_mesh(const std::string& part, const std::map<std::string, double>& dimensions) {
    const auto shape = shapes::FilePart::create(part, dimensions);
    return shape ? description::drawn_mesh(**shape) : Result<Mesh>(shape.errors());
}

/// Where a mesh may be: as it is named, relative to the file; of package://NAME/x also NAME/x and x below each folder above it.
Result<std::string> find_mesh(std::string name, const MeshFolders& where) {
    bool package = false;
    for (const char* prefix : {"package://", "file://", "model://"}) {
        if (!name.starts_with(prefix)) continue;
        package = std::string_view(prefix) != "file://";
        name.erase(0, std::string_view(prefix).size());
        break;
    }
    std::vector<fs::path> folders{where.folder.empty() ? fs::path(".") : fs::path(where.folder)};
    folders.insert(folders.end(), where.mesh_dirs.begin(), where.mesh_dirs.end());
    if (package)
        for (fs::path up = fs::absolute(folders.front()); up.has_relative_path(); up = up.parent_path()) folders.push_back(up);
    std::vector<std::string> names{name};
    if (package && name.find('/') != std::string::npos) names.push_back(name.substr(name.find('/') + 1));
    std::error_code code;
    for (const fs::path& folder : folders)
        for (const std::string& each : names)
            if (fs::is_regular_file(folder / each, code)) return (folder / each).string();
    return Error{ErrorCode::file_not_found, name,
                 "the robot's mesh is not there; looked for it beside the file, in its packages' folders, and in --mesh-dir"};
}

Result<Mesh> mesh_of(const Geometry& geometry, const MeshFolders& where) {
    switch (geometry.kind) {
        case GeometryKind::box:
            return part_mesh("box", {{"size_x", geometry.size.x()}, {"size_y", geometry.size.y()}, {"size_z", geometry.size.z()}});
        case GeometryKind::cylinder:
            return part_mesh("cylinder", {{"radius", geometry.radius}, {"length", geometry.length}});
        case GeometryKind::sphere:
            return sphere_mesh(geometry.radius);
        case GeometryKind::other:
            return Error{ErrorCode::unsupported, "<" + geometry.file + ">",
                         "is not a geometry that is read; known are box, cylinder, sphere, mesh"};
        case GeometryKind::mesh:
            break;
    }
    const Result<std::string> path = find_mesh(geometry.file, where);
    if (!path) return path.errors();
    Result<Mesh> mesh = core::mesh_files::read_mesh(*path);
    if (mesh) core::geometry::scale_mesh(*mesh, geometry.scale);
    return mesh;
}

}  // namespace

Result<Mesh> link_mesh(const Link& link, const MeshFolders& where) {
    std::vector<Vector3> vertices;
    std::vector<core::geometry::Triangle> triangles;
    std::vector<core::geometry::Edge> edges;
    std::optional<core::geometry::Deviation> deviation;
    Errors errors;
    for (const Geometry& geometry : link.geometry()) {
        const Result<Mesh> mesh = mesh_of(geometry, where);
        for (const Error& error : mesh.errors())
            errors.push_back({error.code, "link \"" + link.name + "\": " + error.where, error.message});
        if (!mesh) continue;
        if (mesh->deviation) {
            if (!deviation) deviation.emplace();
            deviation->add(*mesh->deviation);
        }
        const int first = count_of(vertices);
        for (const auto& x : mesh->vertices.colwise()) vertices.push_back(core::kinematics::world_position(geometry.origin, x));
        for (const auto& t : mesh->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
        for (const auto& e : mesh->edges) edges.push_back({first + e[0], first + e[1]});
    }
    if (!errors.empty()) return errors;
    Matrix3X x(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(i) = vertices[i];
    Mesh mesh;
    mesh.name = link.name;
    mesh.vertices = std::move(x);
    mesh.triangles = std::move(triangles);
    mesh.deviation = deviation;
    core::geometry::build_connectivity(mesh, edges);
    return mesh;
}

}  // namespace fettle::design::urdf
