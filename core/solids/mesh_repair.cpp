// SPDX-License-Identifier: MIT
#include "core/solids/mesh_repair.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "core/geometry/half_edges.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::solids {
namespace {

std::string place_of(const geometry::Mesh& mesh, std::size_t triangle) {
    char text[160];
    const Vector3 x = mesh.vertices.col(mesh.triangles[triangle][0]);
    std::snprintf(text, sizeof text, "triangle %zu at (%.6g, %.6g, %.6g) mm", triangle, 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
    return text;
}

std::string counted(std::size_t count, const std::string& what, const std::string& several) {
    return std::to_string(count) + " " + (count == 1 ? what : several);
}

/// The same corners in the same direction, whichever is first.
geometry::Triangle from_smallest(geometry::Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// For every triangle: may it be a copy, or have one? Then it runs along a side that another runs along too, in the same direction.
std::vector<bool> possible_copies(const geometry::Mesh& mesh, const std::vector<geometry::HalfEdge>& halves) {
    std::vector<bool> out(mesh.triangles.size(), false);
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        std::array<int, 2> count{};
        for (std::size_t i = first; i < last; ++i) ++count[halves[i].forward ? 1 : 0];
        for (std::size_t i = first; i < last; ++i)
            if (count[halves[i].forward ? 1 : 0] > 1) out[halves[i].triangle] = true;
    });
    return out;
}

/// False if there were none.
bool drop_copies(geometry::Mesh& mesh, const std::vector<geometry::HalfEdge>& halves, std::vector<std::string>& done) {
    const std::vector<bool> possible = possible_copies(mesh, halves);
    if (std::find(possible.begin(), possible.end(), true) == possible.end()) return false;
    std::set<geometry::Triangle> seen;
    std::vector<geometry::Triangle> kept;
    std::vector<int> faces;
    std::size_t first = mesh.triangles.size();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!possible[t] || seen.insert(from_smallest(mesh.triangles[t])).second) {
            kept.push_back(mesh.triangles[t]);
            if (!mesh.triangle_face.empty()) faces.push_back(mesh.triangle_face[t]);
        } else {
            first = std::min(first, t);
        }
    }
    const std::size_t count = mesh.triangles.size() - kept.size();
    if (count == 0) return false;
    done.push_back(counted(count, "copy of a triangle is", "copies of triangles are") + " left out, first " + place_of(mesh, first) +
                   ": no effect on the mass");
    mesh.triangles = std::move(kept);
    mesh.triangle_face = std::move(faces);
    const std::vector<geometry::Edge> edges = mesh.edges;  // those of triangles are found again, the others kept
    geometry::build_connectivity(mesh, edges);
    return true;
}

/// Is there an edge of two triangles that both run along it the same way?
bool some_are_turned_over(const std::vector<geometry::HalfEdge>& halves) {
    bool found = false;
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        found =
            found || (last - first == 2 && halves[first].low != halves[first].high && halves[first].forward == halves[first + 1].forward);
    });
    return found;
}

/// For every triangle whether it is to be turned, so that each shell is oriented within itself; shells that cannot be are left as they are.
std::vector<bool> turns_within_shells(const geometry::Mesh& mesh, const std::vector<geometry::HalfEdge>& halves) {
    if (!some_are_turned_over(halves)) return std::vector<bool>(mesh.triangles.size(), false);
    struct Link {
        int other;
        bool same_way;  ///< both run the edge in one direction: one of them is turned over
    };
    std::vector<std::vector<Link>> links(mesh.triangles.size());
    std::vector<bool> orientable(mesh.shell_names.size(), true);
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        const geometry::HalfEdge &a = halves[first], &b = halves[last - 1];
        if (last - first != 2 || a.low == a.high) {
            orientable[mesh.triangle_shell[a.triangle]] = false;
            return;
        }
        links[a.triangle].push_back({b.triangle, a.forward == b.forward});
        links[b.triangle].push_back({a.triangle, a.forward == b.forward});
    });
    std::vector<int> turn(mesh.triangles.size(), -1);
    std::vector<bool> out(mesh.triangles.size(), false);
    for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
        const auto shell = static_cast<std::size_t>(mesh.triangle_shell[start]);
        if (turn[start] >= 0 || !orientable[shell]) continue;
        std::vector<std::size_t> reached{start};
        turn[start] = 0;
        std::size_t turned = 0;
        for (std::size_t i = 0; i < reached.size() && orientable[shell]; ++i) {
            for (const Link& link : links[reached[i]]) {
                const int wanted = turn[reached[i]] ^ static_cast<int>(link.same_way);
                int& other = turn[link.other];
                if (other >= 0 && other != wanted) orientable[shell] = false;  // as on a Moebius strip
                if (other >= 0) continue;
                other = wanted;
                turned += static_cast<std::size_t>(wanted);
                reached.push_back(static_cast<std::size_t>(link.other));
            }
        }
        if (!orientable[shell]) continue;
        const int minority = 2 * turned <= reached.size() ? 1 : 0;
        for (const std::size_t t : reached) out[t] = turn[t] == minority;
    }
    return out;
}

/// False if there were none.
bool turn_over(geometry::Mesh& mesh, const std::vector<bool>& turns, const std::string& what, std::vector<std::string>& done) {
    const auto count = static_cast<std::size_t>(std::count(turns.begin(), turns.end(), true));
    if (count == 0) return false;
    const auto first = static_cast<std::size_t>(std::find(turns.begin(), turns.end(), true) - turns.begin());
    done.push_back(what + ": " + counted(count, "triangle is", "triangles are") + " turned, first " + place_of(mesh, first));
    for (std::size_t t = 0; t < turns.size(); ++t) {
        if (turns[t]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    const std::vector<geometry::Edge> edges = mesh.edges;  // those of triangles are found again, the others kept
    geometry::build_connectivity(mesh, edges);
    return true;
}

/// Which triangles of a closed mesh belong to shells that are inside out.
std::vector<bool> turns_of_shells(const geometry::Mesh& mesh) {
    std::vector<bool> out(mesh.triangles.size(), false);
    const std::vector<Shell> shells = shells_of(mesh);
    const bool sound = std::all_of(shells.begin(), shells.end(), [](const Shell& shell) { return shell.is_oriented(); });
    if (sound) return out;
    if (!self_intersections(mesh, 1).empty()) {  // then which is within which has no answer
        out.assign(out.size(), geometry::volume_sign(mesh.vertices, mesh.triangles) < 0);
        return out;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Shell& shell = shells[mesh.triangle_shell[t]];
        if (shell.depth % 2 == 0) {
            out[t] = shell.volume_sign < 0;
        } else {
            // A cavity is turned with the solid that it is in. A solid within a sound solid may be meant: it is told, not turned.
            out[t] = shell.volume_sign > 0 && shells[shell.around].volume_sign < 0;
        }
    }
    return out;
}

}  // namespace

std::vector<std::string> repair_mesh(geometry::Mesh& mesh) {
    std::vector<std::string> done;
    if (mesh.triangles.empty()) return done;
    std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    if (drop_copies(mesh, halves, done)) halves = geometry::sorted_half_edges(mesh);
    if (turn_over(mesh, turns_within_shells(mesh, halves), "triangles of one surface were turned over", done))
        halves = geometry::sorted_half_edges(mesh);
    if (bounds_a_solid(halves)) turn_over(mesh, turns_of_shells(mesh), "the solid was inside out", done);
    return done;
}

}  // namespace fettle::core::solids
