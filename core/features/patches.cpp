// SPDX-License-Identifier: MIT
#include "core/features/patches.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/half_edges.hpp"

namespace fettle::core::features {

namespace {

using geometry::HalfEdge;
using geometry::Triangle;

// Vertices by x, y, z, triangles by their vertices, each from its least one on.
void sort_mesh(const geometry::Mesh& mesh, Patches& out) {
    const int count = static_cast<int>(mesh.vertices.cols());
    std::vector<int> order(count), place(count);
    std::iota(order.begin(), order.end(), 0);
    const auto before = [&](int i, int j) {
        for (int k = 0; k < 3; ++k)
            if (mesh.vertices(k, i) != mesh.vertices(k, j)) return mesh.vertices(k, i) < mesh.vertices(k, j);
        return false;
    };
    std::sort(order.begin(), order.end(), before);
    out.vertices.resize(3, count);
    for (int k = 0; k < count; ++k) {
        out.vertices.col(k) = mesh.vertices.col(order[k]);
        place[order[k]] = k;
    }
    std::vector<std::pair<Triangle, int>> sorted;
    for (int t = 0; t < count_of(mesh.triangles); ++t) {
        Triangle triangle = mesh.triangles[t];
        for (int& vertex : triangle) vertex = place[vertex];
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
        sorted.emplace_back(triangle, t);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [triangle, t] : sorted) {
        out.triangles.push_back(triangle);
        out.in_mesh.push_back(t);
    }
}

Vector3 middle_of(const Patches& out, int t) {
    const Triangle& c = out.triangles[t];
    return (out.vertices.col(c[0]) + out.vertices.col(c[1]) + out.vertices.col(c[2])) / 3;
}

void measure_triangles(Patches& out) {
    for (const Triangle& t : out.triangles) {
        const Vector3 a = out.vertices.col(t[0]), b = out.vertices.col(t[1]), c = out.vertices.col(t[2]);
        const Vector3 cross = (b - a).cross(c - a);
        out.areas.push_back(0.5 * cross.norm());
        out.normals.push_back(out.areas.back() > 0 ? Vector3(cross / (2 * out.areas.back())) : Vector3::Zero());
    }
}

// Beyond an edge of a triangle, per side; -1: an open edge, or one with more than two triangles.
std::vector<std::array<int, 3>> neighbours_of(const Patches& out, const std::vector<HalfEdge>& halves) {
    std::vector<std::array<int, 3>> beyond(out.triangles.size(), {-1, -1, -1});
    const auto side_of = [&](const HalfEdge& half) {
        const Triangle& t = out.triangles[half.triangle];
        for (int k = 0; k < 3; ++k)
            if (std::minmax(t[k], t[(k + 1) % 3]) == std::minmax(half.low, half.high)) return k;
        return 0;
    };
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        if (!geometry::is_sound_edge(halves, first, last)) return;
        beyond[halves[first].triangle][side_of(halves[first])] = halves[first + 1].triangle;
        beyond[halves[first + 1].triangle][side_of(halves[first + 1])] = halves[first].triangle;
    });
    return beyond;
}

struct Plane {
    Vector3 normal;
    double offset = 0;
};

class FlatGrowth {
public:
    FlatGrowth(Patches& out, const std::vector<std::array<int, 3>>& beyond, double flatness, double limit)
        : out_(out), beyond_(beyond), flatness_(flatness), least_cosine_(std::cos(limit)) {}

    void run() {
        out_.patch_of.assign(out_.triangles.size(), -1);
        std::vector<int> seeds(out_.triangles.size());
        std::iota(seeds.begin(), seeds.end(), 0);
        std::stable_sort(seeds.begin(), seeds.end(), [&](int s, int t) { return out_.areas[s] > out_.areas[t]; });
        for (const int seed : seeds)
            if (out_.patch_of[seed] < 0) grow(seed);
    }

private:
    bool lies_in(const Plane& plane, int t) const {
        for (const int v : out_.triangles[t])
            if (std::abs(plane.normal.dot(out_.vertices.col(v)) - plane.offset) > flatness_) return false;
        const Triangle& corners = out_.triangles[t];
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (out_.vertices.col(corners[k]) - out_.vertices.col(corners[(k + 1) % 3])).norm());
        const bool is_sliver = 2 * out_.areas[t] <= 8 * flatness_ * longest;  // its normal says nothing
        return is_sliver || plane.normal.dot(out_.normals[t]) > least_cosine_;
    }

    // Through the mean of the vertices, across the sum of the areas' vectors.
    Plane plane_of(const std::vector<int>& members) const {
        Vector3 normal = Vector3::Zero();
        double offset = 0;
        for (const int t : members) normal += out_.areas[t] * out_.normals[t];
        if (!(normal.norm() > 0)) normal = Vector3::UnitZ();
        normal.normalize();
        for (const int t : members)
            for (const int v : out_.triangles[t]) offset += normal.dot(out_.vertices.col(v)) / (3.0 * static_cast<double>(members.size()));
        return {normal, offset};
    }

    void grow(int seed) {
        const int patch = count_of(out_.patches);
        std::vector<int> members{seed};
        out_.patch_of[seed] = patch;
        if (out_.areas[seed] > 0) {
            constexpr int most_rounds = 4;  // a plane that is fitted anew reaches farther
            for (int round = 0; round < most_rounds; ++round) {
                const std::size_t before = members.size();
                const Plane plane = plane_of(members);
                for (std::size_t next = 0; next < members.size(); ++next)
                    for (const int t : beyond_[members[next]])
                        if (t >= 0 && out_.patch_of[t] < 0 && lies_in(plane, t)) {
                            out_.patch_of[t] = patch;
                            members.push_back(t);
                        }
                if (members.size() == before) break;
            }
        }
        Patch made;
        made.normal = plane_of(members).normal;
        for (const int t : members) {
            made.area += out_.areas[t];
            made.centre += out_.areas[t] * middle_of(out_, t);
        }
        made.centre = made.area > 0 ? Vector3(made.centre / made.area) : Vector3(out_.vertices.col(out_.triangles[seed][0]));
        out_.patches.push_back(made);
    }

    Patches& out_;
    const std::vector<std::array<int, 3>>& beyond_;
    double flatness_, least_cosine_;
};

void find_creases(Patches& out, const std::vector<HalfEdge>& halves, double limit) {
    out.is_sharp.assign(out.vertices.cols(), 0);
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        const int a = halves[first].low, b = halves[first].high;
        if (!geometry::is_sound_edge(halves, first, last)) {
            out.is_sharp[a] = out.is_sharp[b] = 1;
            return;
        }
        int p = out.patch_of[halves[first].triangle], q = out.patch_of[halves[first + 1].triangle];
        if (p == q) return;
        if (p > q) std::swap(p, q);
        const Vector3 &m = out.patches[p].normal, &n = out.patches[q].normal;
        const double angle = std::atan2(m.cross(n).norm(), m.dot(n));
        const int s = halves[first].triangle, t = halves[first + 1].triangle;  // each below the other's patch: convex
        const Vector3 &beside_s = out.patches[out.patch_of[s]].normal, &beside_t = out.patches[out.patch_of[t]].normal;
        const Vector3 at = out.vertices.col(a);
        const bool is_convex = beside_s.dot(middle_of(out, t) - at) + beside_t.dot(middle_of(out, s) - at) <= 0;
        if (angle > limit) out.is_sharp[a] = out.is_sharp[b] = 1;
        out.creases.push_back({p, q, a, b, is_convex ? angle : -angle});
    });
}

}  // namespace

IndexLists::IndexLists(int lists, const std::vector<int>& owner) : first_(lists + 1, 0) {
    for (const int list : owner)
        if (list >= 0) ++first_[list + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    all_.resize(first_.back());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int member = 0; member < count_of(owner); ++member)
        if (owner[member] >= 0) all_[next[owner[member]]++] = member;
}

void IndexLists::add(std::span<const int> list) {
    all_.insert(all_.end(), list.begin(), list.end());
    first_.push_back(static_cast<int>(all_.size()));
}

Patches patches_of(const geometry::Mesh& mesh, double flatness, double limit) {
    Patches out;
    if (mesh.triangles.empty()) return out;
    sort_mesh(mesh, out);
    measure_triangles(out);
    out.size = geometry::box_sides(out.vertices).norm();
    const std::vector<HalfEdge> halves = geometry::sorted_half_edges(out.triangles);
    FlatGrowth(out, neighbours_of(out, halves), flatness, limit).run();
    find_creases(out, halves, limit);
    const int count = count_of(out.patches);
    out.patch_triangles = IndexLists(count, out.patch_of);
    std::vector<int> vertices, ends, creases;
    for (int patch = 0; patch < count; ++patch) {
        vertices.clear();
        for (const int t : out.patch_triangles[patch]) vertices.insert(vertices.end(), out.triangles[t].begin(), out.triangles[t].end());
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        out.patch_vertices.add(vertices);
    }
    for (const Crease& crease : out.creases) ends.insert(ends.end(), {crease.p, crease.q});
    const IndexLists by_end(count, ends);
    for (int patch = 0; patch < count; ++patch) {
        creases.clear();
        for (const int end : by_end[patch]) creases.push_back(end / 2);
        out.patch_creases.add(creases);
    }
    return out;
}

}  // namespace fettle::core::features
