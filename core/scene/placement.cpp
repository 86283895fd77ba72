// SPDX-License-Identifier: MIT
#include "fettle/core/scene/placement.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>

namespace fettle::core::scene {
namespace {

struct SineCosine {
    double sine, cosine;
};

SineCosine sine_cosine(double degrees) {
    const double turned = std::remainder(degrees, 360.0);  // exact
    if (turned == 0) return {0, 1};
    if (turned == 90) return {1, 0};
    if (turned == -90) return {-1, 0};
    if (std::abs(turned) == 180) return {0, -1};
    return {std::sin(radians(turned)), std::cos(radians(turned))};
}

}  // namespace

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

Matrix3 rotation_from_degrees(const Vector3& angles) {
    const auto [sa, ca] = sine_cosine(angles.x());
    const auto [sb, cb] = sine_cosine(angles.y());
    const auto [sc, cc] = sine_cosine(angles.z());
    Matrix3 rx, ry, rz;
    rx << 1, 0, 0, 0, ca, -sa, 0, sa, ca;
    ry << cb, 0, sb, 0, 1, 0, -sb, 0, cb;
    rz << cc, -sc, 0, sc, cc, 0, 0, 0, 1;
    return rz * ry * rx;
}

void scale_mesh(geometry::Mesh& mesh, const Vector3& factors) {
    mesh.vertices = factors.asDiagonal() * mesh.vertices;
    if (factors.prod() < 0) turn_triangles(mesh);
}

void turn_triangles(geometry::Mesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    const std::vector<geometry::Edge> edges = mesh.edges;  // those of triangles are found again, the others kept
    geometry::build_connectivity(mesh, edges);
}

std::vector<geometry::Mesh> split_shells(const geometry::Mesh& mesh) {
    if (mesh.triangles.empty()) return {mesh};
    std::vector<geometry::Mesh> parts(mesh.shell_names.size());
    for (std::size_t s = 0; s < parts.size(); ++s) {
        std::vector<int> new_index(static_cast<std::size_t>(mesh.vertices.cols()), -1);
        std::vector<geometry::Triangle> triangles;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.triangle_shell[t] != static_cast<int>(s)) continue;
            triangles.push_back(mesh.triangles[t]);
            for (const int v : mesh.triangles[t]) new_index[static_cast<std::size_t>(v)] = 0;
        }
        std::vector<int> kept;
        for (std::size_t v = 0; v < new_index.size(); ++v) {
            if (new_index[v] < 0) continue;
            new_index[v] = static_cast<int>(kept.size());
            kept.push_back(static_cast<int>(v));
        }
        for (auto& triangle : triangles) {
            for (int& v : triangle) v = new_index[static_cast<std::size_t>(v)];
        }
        parts[s] = geometry::make_mesh(mesh.shell_names[s], mesh.vertices(Eigen::all, kept), std::move(triangles));
    }
    return parts;
}

base::Result<std::string> find_mesh_file(const std::string& name, const std::string& scene_path, const std::vector<std::string>& mesh_dirs,
                                         const std::string& where) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    std::vector<fs::path> candidates;
    const fs::path folder = fs::absolute(scene_path, ignored).lexically_normal().parent_path();
    if (fs::path(name).is_absolute()) {
        candidates.emplace_back(name);
    } else {
        candidates.push_back(folder / name);
        for (const auto& dir : mesh_dirs) candidates.push_back(fs::path(dir) / name);
        fs::path above = folder;
        while (true) {
            candidates.push_back(above / "meshes" / name);
            if (above == above.parent_path()) break;
            above = above.parent_path();
        }
    }
    for (const auto& candidate : candidates) {
        if (fs::is_regular_file(candidate, ignored)) return candidate.string();
    }
    std::string looked = folder.string();
    for (const auto& dir : mesh_dirs) looked += ", " + dir;
    if (fs::path(name).is_absolute()) {
        return base::Error{base::ErrorCode::file_not_found, where, "mesh file " + name + " does not exist"};
    }
    return base::Error{base::ErrorCode::file_not_found, where,
                       "mesh file \"" + name + "\" was not found in " + looked +
                           ", nor in meshes/ of any folder above the scene; correct the name or add a folder with --mesh-dir"};
}

}  // namespace fettle::core::scene
