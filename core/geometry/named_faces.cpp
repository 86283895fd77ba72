// SPDX-License-Identifier: MIT
#include "core/geometry/named_faces.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::core::geometry {

namespace {

// "slot 2" -> "slot"; of what is no copy the name itself.
std::string without_number(const std::string& name) {
    const std::size_t last = name.find_last_not_of("0123456789");
    if (last == std::string::npos || last == 0 || last + 1 == name.size() || name[last] != ' ') return name;
    return name.substr(0, last);
}

bool is_called(const std::string& face, const std::string& name) {
    for (std::string each = face;; each = without_number(each)) {
        if (each == name) return true;
        if (each == without_number(each)) return false;
    }
}

void add_once(const std::string& name, std::vector<std::string>& names) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::vector<std::string> names_of_faces(const Mesh& mesh) {
    std::vector<std::string> names;
    for (std::string face : mesh.face_names) {
        while (face != without_number(face)) face = without_number(face);
        add_once(face, names);
    }
    for (const std::string& face : mesh.face_names) {
        add_once(without_number(face), names);
        add_once(face, names);
    }
    return names;
}

std::vector<int> triangles_of_face(const Mesh& mesh, const std::string& name) {
    std::vector<int> triangles;
    for (int t = 0; t < count_of(mesh.triangle_face); ++t)
        if (is_called(mesh.face_names[mesh.triangle_face[t]], name)) triangles.push_back(t);
    return triangles;
}

SubMesh sub_mesh(const Mesh& mesh, const std::vector<int>& triangles) {
    FETTLE_ASSERT(!triangles.empty(), "a part of a mesh has a triangle");
    SubMesh out;
    out.triangles = triangles;
    std::vector<int> place(mesh.vertices.cols(), -1);
    for (const int t : triangles)
        for (const int v : mesh.triangles[t]) place[v] = 0;
    for (int v = 0; v < count_of(place); ++v) {
        if (place[v] < 0) continue;
        place[v] = count_of(out.vertices);
        out.vertices.push_back(v);
    }
    std::vector<Triangle> own;
    for (const int t : triangles) {
        const Triangle& whole = mesh.triangles[t];
        own.push_back({place[whole[0]], place[whole[1]], place[whole[2]]});
    }
    out.mesh = make_mesh(mesh.name, mesh.vertices(Eigen::all, out.vertices), std::move(own));
    const auto ends = [](int u, int v) { return std::pair(std::min(u, v), std::max(u, v)); };
    std::map<std::pair<int, int>, int> edges;
    for (int e = 0; e < count_of(mesh.edges); ++e) edges.emplace(ends(mesh.edges[e][0], mesh.edges[e][1]), e);
    for (const Edge& edge : out.mesh.edges) out.edges.push_back(edges.at(ends(out.vertices[edge[0]], out.vertices[edge[1]])));
    return out;
}

}  // namespace fettle::core::geometry
