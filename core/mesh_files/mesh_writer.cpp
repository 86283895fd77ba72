// SPDX-License-Identifier: MIT
// STL and OBJ; 3MF is threemf_writer.cpp.
#include "core/mesh_files/mesh_writer.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/mesh_files/millimetres.hpp"

namespace fettle::core::mesh_files {
namespace {

Vector3 placed(const MeshPart& part, int vertex) {
    const Vector3 x = part.mesh->vertices.col(vertex);
    if (part.rotation == Matrix3::Identity() && part.position == Vector3::Zero()) return x;  // positions keep their bits
    return part.rotation * x + part.position;
}

void append_word(std::string& out, std::uint32_t word) {
    for (int i = 0; i < 4; ++i, word >>= 8) out += static_cast<char>(word & 255);
}

void append_float3(std::string& out, const Vector3& x) {
    for (int k = 0; k < 3; ++k) append_word(out, std::bit_cast<std::uint32_t>(static_cast<float>(x[k])));
}

std::string obj_name(const std::string& text) {
    std::string name = base::shown(text);
    for (char& c : name)
        if (static_cast<unsigned char>(c) <= ' ') c = '_';
    return name.empty() ? "part" : name;
}

/// Edges of no triangle stand last in the mesh's list.
std::size_t edges_of_triangles(const geometry::Mesh& mesh) {
    std::vector<geometry::Edge> edges;
    for (const geometry::Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    return static_cast<std::size_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

}  // namespace

std::string stl_bytes(const std::vector<MeshPart>& parts) {
    std::string out = "fettle: binary STL, unit mm, Z as in the scene";
    out.resize(80, ' ');
    std::size_t count = 0;
    for (const MeshPart& part : parts) count += part.mesh->triangles.size();
    append_word(out, static_cast<std::uint32_t>(count));
    for (const MeshPart& part : parts) {
        for (const geometry::Triangle& t : part.mesh->triangles) {
            const Vector3 a = placed(part, t[0]), b = placed(part, t[1]), c = placed(part, t[2]);
            append_float3(out, (b - a).cross(c - a).stableNormalized());
            for (const Vector3& x : {a, b, c}) append_float3(out, 1000 * x);
            out.append(2, '\0');
        }
    }
    return out;
}

double stl_rounding(const std::vector<MeshPart>& parts) {
    double largest = 0;
    for (const MeshPart& part : parts) {
        for (int i = 0; i < part.mesh->vertices.cols(); ++i) {
            const Vector3 x = placed(part, i), millimetre = 1000 * x;
            largest = std::max(largest, (millimetre.cast<float>().cast<double>() * 1e-3 - x).norm());
        }
    }
    return largest;
}

std::string obj_text(const std::vector<MeshPart>& parts, const std::string& materials) {
    std::string out = "# fettle: unit mm\n";
    if (!materials.empty()) out += "mtllib " + materials + "\n";
    std::size_t first = 1;  // OBJ counts from 1, through all parts
    const auto index = [&](int vertex) { return " " + std::to_string(first + static_cast<std::size_t>(vertex)); };
    for (const MeshPart& part : parts) {
        const geometry::Mesh& mesh = *part.mesh;
        out += "o " + obj_name(part.name) + "\n";
        if (!materials.empty()) out += "usemtl " + obj_name(part.name) + "\n";
        for (int i = 0; i < mesh.vertices.cols(); ++i) {
            const Vector3 x = placed(part, i);
            out += "v " + millimetres(x[0]) + " " + millimetres(x[1]) + " " + millimetres(x[2]) + "\n";
        }
        for (const geometry::Triangle& t : mesh.triangles) out += "f" + index(t[0]) + index(t[1]) + index(t[2]) + "\n";
        for (std::size_t e = edges_of_triangles(mesh); e < mesh.edges.size(); ++e)
            out += "l" + index(mesh.edges[e][0]) + index(mesh.edges[e][1]) + "\n";
        for (const int point : mesh.codimensional_points) out += "p" + index(point) + "\n";
        first += static_cast<std::size_t>(mesh.vertices.cols());
    }
    return out;
}

std::string mtl_text(const std::vector<MeshPart>& parts) {
    std::string out = "# fettle\n";
    for (const MeshPart& part : parts) {
        char colour[80];
        std::snprintf(colour, sizeof colour, "Kd %.4f %.4f %.4f\n", part.colour[0] / 255.0, part.colour[1] / 255.0, part.colour[2] / 255.0);
        out += "newmtl " + obj_name(part.name) + "\n" + colour;
    }
    return out;
}

}  // namespace fettle::core::mesh_files
