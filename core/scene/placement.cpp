// SPDX-License-Identifier: MIT
#include "fettle/core/scene/placement.hpp"

#include <algorithm>
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
    std::vector<std::vector<geometry::Triangle>> triangles(mesh.shell_names.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        triangles[static_cast<std::size_t>(mesh.triangle_shell[t])].push_back(mesh.triangles[t]);
    }
    std::vector<geometry::Mesh> parts;
    std::vector<int> new_index(static_cast<std::size_t>(mesh.vertices.cols()), -1);
    for (std::size_t s = 0; s < triangles.size(); ++s) {
        std::vector<int> kept;
        for (const auto& triangle : triangles[s]) kept.insert(kept.end(), triangle.begin(), triangle.end());
        std::sort(kept.begin(), kept.end());
        kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
        for (std::size_t i = 0; i < kept.size(); ++i) new_index[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
        for (auto& triangle : triangles[s]) {
            for (int& v : triangle) v = new_index[static_cast<std::size_t>(v)];
        }
        parts.push_back(geometry::make_mesh(mesh.shell_names[s], mesh.vertices(Eigen::all, kept), std::move(triangles[s])));
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
