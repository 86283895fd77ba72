// SPDX-License-Identifier: MIT
#include "core/parts/merged_faces.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/geometry/predicates.hpp"
#include "core/parts/triangulation.hpp"

namespace fettle::core::parts {
namespace {

using Kind = VertexOrigin::Kind;

/// The pieces of one face.
struct Face {
    std::vector<std::size_t> triangles;  // of the cut
    bool is_cut = false;                 // has corners that are not of its own solid
};

using HalfEdges = std::unordered_map<std::uint64_t, std::size_t>;  // from corner to corner: the face on the left

std::uint64_t half_edge(int from, int to) { return static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint32_t>(to); }

bool is_of(const VertexOrigin& origin, bool of_a) { return origin.kind == (of_a ? Kind::vertex_of_a : Kind::vertex_of_b); }

class Merger {
public:
    Merger(const SolidCut& cut, const std::vector<Vector3>& points, double rounding) : cut_(cut), points_(points), rounding_(rounding) {}

    void find_faces(const std::vector<int>& face_of_a, const std::vector<int>& face_of_b) {
        std::map<std::pair<bool, int>, std::size_t> known;
        for (std::size_t k = 0; k < cut_.triangles.size(); ++k) {
            const CutTriangle& t = cut_.triangles[k];
            const int flat = (t.of_a ? face_of_a : face_of_b)[t.triangle];
            const std::pair key(t.of_a, flat >= 0 ? flat : -1 - t.triangle);
            const std::size_t face = known.emplace(key, faces_.size()).first->second;
            if (face == faces_.size()) faces_.emplace_back();
            faces_[face].triangles.push_back(k);
            for (const int corner : t.corners) faces_[face].is_cut = faces_[face].is_cut || !is_of(cut_.vertices[corner], t.of_a);
            for (std::size_t i = 0; i < 3; ++i) halves_[half_edge(t.corners[i], t.corners[(i + 1) % 3])] = face;
        }
    }

    /// Corners within faces, and those on straight stretches of the edges between them.
    void find_dropped() {
        neighbours_.resize(cut_.vertices.size());
        for (const auto& [half, face] : halves_) {
            const int from = static_cast<int>(half >> 32), to = static_cast<int>(half & 0xffffffff);
            if (!is_edge(from, to, face)) continue;
            neighbours_[from].push_back(to);
            neighbours_[to].push_back(from);
        }
        is_dropped_.assign(cut_.vertices.size(), 0);
        for (std::size_t v = 0; v < neighbours_.size(); ++v) {
            auto& others = neighbours_[v];
            std::sort(others.begin(), others.end());
            others.erase(std::unique(others.begin(), others.end()), others.end());
            is_dropped_[v] = others.empty();
        }
        // Chains from corners where three faces or more meet; what is left are rings.
        std::vector<char> seen(cut_.vertices.size(), 0);
        for (const bool rings : {false, true})
            for (int v = 0; v < count_of(neighbours_); ++v) {
                if (neighbours_[v].empty() || seen[v] != 0 || (neighbours_[v].size() == 2) != rings) continue;
                for (const int next : neighbours_[v])
                    if (neighbours_[next].size() == 2 && seen[next] == 0) straighten(chain_from(v, next, seen));
            }
        for (Face& face : faces_)
            for (const std::size_t k : face.triangles)
                for (const int corner : cut_.triangles[k].corners) face.is_cut = face.is_cut || is_dropped_[corner] != 0;
    }

    std::optional<SolidCut> merged() const {
        SolidCut out;
        std::vector<int> index(cut_.vertices.size(), -1);
        const auto kept = [&](int corner) {
            if (index[corner] < 0) {
                index[corner] = count_of(out.vertices);
                out.vertices.push_back(cut_.vertices[corner]);
            }
            return index[corner];
        };
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const Face& face = faces_[f];
            std::vector<CutTriangle> triangles;
            if (face.is_cut) {
                auto made = triangulated_face(f);
                if (!made) return std::nullopt;
                triangles = std::move(*made);
            } else {
                for (const std::size_t k : face.triangles) triangles.push_back(cut_.triangles[k]);
            }
            for (CutTriangle& t : triangles) {
                for (int& corner : t.corners) corner = kept(corner);
                out.triangles.push_back(t);
            }
        }
        return out;
    }

private:
    bool is_edge(int from, int to, std::size_t face) const {
        const auto back = halves_.find(half_edge(to, from));
        return back == halves_.end() || back->second != face;
    }

    // Corners from v over `next` to the end of the stretch, where it is not two faces that meet.
    std::vector<int> chain_from(int v, int next, std::vector<char>& seen) const {
        std::vector<int> chain{v, next};
        seen[v] = 1;
        while (neighbours_[chain.back()].size() == 2 && seen[chain.back()] == 0) {
            seen[chain.back()] = 1;
            const auto& two = neighbours_[chain.back()];
            chain.push_back(two[0] == chain[chain.size() - 2] ? two[1] : two[0]);
        }
        return chain;
    }

    void straighten(const std::vector<int>& chain) {
        for (std::size_t from = 0; from + 2 < chain.size();) {
            std::size_t to = from + 2;
            while (to < chain.size() && is_straight(chain, from, to)) ++to;
            for (std::size_t k = from + 1; k + 1 < to; ++k) is_dropped_[chain[k]] = 1;
            from = std::max(to - 1, from + 1);
        }
    }

    // Do all in between lie on the line from one to the other, in order, but for rounding?
    bool is_straight(const std::vector<int>& chain, std::size_t from, std::size_t to) const {
        const Vector3 start = points_[chain[from]], way = points_[chain[to]] - start;
        const double length = way.norm();
        if (!(length > 0)) return false;
        double before = 0;
        for (std::size_t k = from + 1; k < to; ++k) {
            const Vector3 p = points_[chain[k]] - start;
            const double along = p.dot(way) / length;
            if (!(along >= before - rounding_ && along <= length + rounding_ && p.cross(way).norm() <= rounding_ * length)) return false;
            before = std::max(before, along);
        }
        return true;
    }

    // Nothing: its edges cross each other. No triangles: it is so narrow that its edges have become one.
    std::optional<std::vector<CutTriangle>> triangulated_face(std::size_t f) const {
        std::map<int, std::vector<int>> following;  // along the face's edge, corners that are left out passed over
        Vector3 normal = Vector3::Zero();
        for (const std::size_t k : faces_[f].triangles) {
            const auto& c = cut_.triangles[k].corners;
            normal += (points_[c[1]] - points_[c[0]]).cross(points_[c[2]] - points_[c[0]]);
            for (std::size_t i = 0; i < 3; ++i)
                if (is_edge(c[i], c[(i + 1) % 3], f)) following[c[i]].push_back(c[(i + 1) % 3]);
        }
        Eigen::Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        PlaneRegion region;
        std::map<int, int> index;
        std::vector<int> corners;
        const auto add = [&](int corner) {
            const auto [place, is_new] = index.emplace(corner, count_of(corners));
            if (is_new) {
                corners.push_back(corner);
                const Vector2 p = geometry::projected(points_[corner], static_cast<int>(axis));
                region.points.push_back(normal[axis] > 0 ? p : Vector2(p.y(), p.x()));
            }
            return place->second;
        };
        for (auto& [start, nexts] : following) {
            while (is_dropped_[start] == 0 && !nexts.empty()) {
                std::vector<int> loop;
                for (int at = start; !following[at].empty();) {
                    if (is_dropped_[at] == 0) loop.push_back(at);
                    const int next = following[at].back();
                    following[at].pop_back();
                    at = next;
                }
                if (loop.size() < 3) continue;
                for (int& corner : loop) corner = add(corner);
                region.loops.push_back(std::move(loop));
            }
        }
        std::vector<CutTriangle> out;
        if (region.loops.empty()) return out;
        CutTriangle made = cut_.triangles[faces_[f].triangles.front()];
        for (const auto& t : triangulated(region).triangles) {
            made.corners = {corners[t[0]], corners[t[1]], corners[t[2]]};
            out.push_back(made);
        }
        return out.empty() ? std::nullopt : std::optional(std::move(out));
    }

    const SolidCut& cut_;
    const std::vector<Vector3>& points_;
    double rounding_;
    std::vector<Face> faces_;
    HalfEdges halves_;
    std::vector<std::vector<int>> neighbours_;  ///< per corner: along edges between faces
    std::vector<char> is_dropped_;
};

}  // namespace

SolidCut with_merged_faces(SolidCut cut, const std::vector<int>& face_of_a, const std::vector<int>& face_of_b,
                           const std::vector<Vector3>& points, double rounding) {
    Merger merger(cut, points, rounding);
    merger.find_faces(face_of_a, face_of_b);
    merger.find_dropped();
    auto merged = merger.merged();
    return merged ? std::move(*merged) : std::move(cut);
}

}  // namespace fettle::core::parts
