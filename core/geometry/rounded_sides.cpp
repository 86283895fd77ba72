// SPDX-License-Identifier: MIT
#include "core/geometry/rounded_sides.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/geometry/flat_features.hpp"
#include "core/geometry/half_edges.hpp"

namespace fettle::core::geometry {
namespace {

constexpr double tolerance = 1e-9;    // of the mesh's size
constexpr double straightest = 1e-6;  // turns up to this are none [rad]
// Share of a rectangle's width that stays plane, or it stands for a curved surface. At a round side's last rectangle half of it does.
constexpr double smallest_plane = 2.0 / 3;

// A rectangle of a plane facet. Corner k to corner k + 1 is side k, counter-clockwise seen from outside.
struct Rectangle {
    std::array<int, 4> corner{};
    std::array<std::vector<int>, 4> border;  // edges of the mesh, in order
    std::vector<int> triangles;
    Vector3 normal;
};

// Which triangles are at an edge: 3 t + k for side k of triangle t.
struct EdgeSides {
    int count = 0;
    std::array<int, 2> side{-1, -1};

    int other(int triangle) const { return count != 2 ? -1 : side[0] / 3 == triangle ? side[1] / 3 : side[0] / 3; }
};

class Rectangles {
public:
    explicit Rectangles(const Mesh& mesh) : mesh_(mesh) {
        if (mesh.triangles.empty()) return;
        const Vector3 extent = box_sides(mesh.vertices);
        allowed_ = tolerance * extent.norm();
        flat_ = flat_features(mesh, allowed_);
        if (!flat_.any()) return;  // a rectangle has two triangles or more
        edges_ = triangle_edges(mesh.triangles).of_side;
        sides_of_.resize(mesh.edges.size());
        for (int side = 0; side < count_of(edges_); ++side) {
            if (edges_[side] < 0) continue;
            EdgeSides& at = sides_of_[edges_[side]];
            if (at.count < 2) at.side[at.count] = side;
            ++at.count;
        }
        leaving_.assign(mesh.vertices.cols(), -1);
        std::vector<char> seen(mesh.triangles.size(), 0);
        for (int t = 0; t < count_of(mesh.triangles); ++t) {
            if (seen[t] != 0) continue;
            find_facet(t, seen);
            if (facet_.size() < 2 || !find_outline()) continue;
            if (auto found = rectangle()) all.push_back(std::move(*found));
        }
    }

    std::vector<Rectangle> all;  // in the order of their first triangles

    Vector3 at(int vertex) const { return mesh_.vertices.col(vertex); }
    int edge_of(int triangle, int k) const { return edges_[3 * triangle + k]; }
    const Triangle& corners_of(int triangle) const { return mesh_.triangles[triangle]; }
    bool is_flat(int edge) const { return flat_.is_flat_edge(edge); }
    bool is_sound(int edge) const { return sides_of_[edge].count == 2; }

    // Does the body turn inward across the whole of a rectangle's border?
    bool is_concave(const Rectangle& r, int side) const {
        for (const int e : r.border[side]) {
            const auto [a, b] = mesh_.edges[e];
            if (!is_sound(e)) return false;
            double height = 0;  // of the far corners above the plane; the rectangle's own is on it
            for (const int s : sides_of_[e].side)
                for (const int v : mesh_.triangles[s / 3])
                    if (v != a && v != b)
                        if (const double h = r.normal.dot(at(v) - at(r.corner[side])); std::abs(h) > std::abs(height)) height = h;
            if (!(height > allowed_)) return false;
        }
        return true;
    }

private:
    // The triangles of one plane with this one.
    void find_facet(int seed, std::vector<char>& seen) {
        facet_.assign(1, seed);
        seen[seed] = 1;
        for (std::size_t next = 0; next < facet_.size(); ++next) {
            const int t = facet_[next];
            for (int k = 0; k < 3; ++k) {
                const int e = edge_of(t, k);
                if (e < 0 || !is_flat(e)) continue;
                const int other = sides_of_[e].other(t);
                if (other < 0 || seen[other] != 0) continue;
                seen[other] = 1;
                facet_.push_back(other);
            }
        }
    }

    int start_of(int side) const { return mesh_.triangles[side / 3][side % 3]; }
    int end_of(int side) const { return mesh_.triangles[side / 3][(side % 3 + 1) % 3]; }

    // The facet's outline as sides of triangles, one after another. False if it is not one loop.
    bool find_outline() {
        border_.clear();
        loop_.clear();
        for (const int t : facet_)
            for (int k = 0; k < 3; ++k) {
                const int e = edge_of(t, k);
                if (e < 0) return false;
                if (!is_flat(e)) border_.push_back(3 * t + k);
            }
        if (border_.size() < 4) return false;
        bool simple = true;
        for (const int side : border_) {
            int& leaving = leaving_[start_of(side)];
            simple = simple && leaving < 0;
            leaving = side;
        }
        // Each vertex of it is left once: the way from the first one ends there, or at a vertex that is not left.
        if (simple) {
            int side = border_.front();
            do {
                loop_.push_back(side);
                side = leaving_[end_of(side)];
            } while (side >= 0 && side != border_.front() && loop_.size() < border_.size());
            simple = side == border_.front() && loop_.size() == border_.size();
        }
        for (const int side : border_) leaving_[start_of(side)] = -1;
        return simple;
    }

    // Is the point so near to the line through a and b?
    bool is_on_line(const Vector3& point, const Vector3& a, const Vector3& b) const {
        return (b - a).cross(point - a).norm() <= allowed_ * (b - a).norm();
    }

    // The facet with that outline, if it is one.
    std::optional<Rectangle> rectangle() const {
        const std::vector<int>& loop = loop_;
        const std::size_t n = loop.size();
        std::array<std::size_t, 4> turns{};
        std::size_t found = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Vector3 before = at(start_of(loop[i == 0 ? n - 1 : i - 1])), here = at(start_of(loop[i])), after = at(end_of(loop[i]));
            if ((here - before).dot(after - here) > 0 && is_on_line(here, before, after)) continue;
            if (found == 4) return std::nullopt;
            turns[found++] = i;
        }
        if (found != 4) return std::nullopt;
        Rectangle out;
        std::array<Vector3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = at(out.corner[k] = start_of(loop[turns[k]]));
        const Vector3 a = x[1] - x[0], b = x[3] - x[0];
        const double smaller = std::min(a.norm(), b.norm());
        if (!((x[0] - x[1] + x[2] - x[3]).norm() <= 2 * allowed_ && std::abs(a.dot(b)) <= allowed_ * smaller && smaller > 10 * allowed_))
            return std::nullopt;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t end = turns[(k + 1) % 4];
            for (std::size_t i = turns[k]; i != end; i = (i + 1) % n) {
                if (!is_on_line(at(start_of(loop[i])), x[k], x[(k + 1) % 4])) return std::nullopt;
                out.border[k].push_back(edges_[loop[i]]);
            }
        }
        out.normal = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
        out.triangles = facet_;
        return out;
    }

    const Mesh& mesh_;
    double allowed_ = 0;  // distance from a plane or line [m]
    FlatFeatures flat_;
    std::vector<int> edges_;  // [3 t + k]: edge of side k
    std::vector<EdgeSides> sides_of_;
    std::vector<int> leaving_;  // [vertex]: side of an outline from there, while it is looked at; -1
    // The facet that is looked at: its triangles; sides of triangles in any order, and one after another.
    std::vector<int> facet_, border_, loop_;
};

// Per 4 r + k, side k of rectangle r: the same of the rectangle that has this whole border too; -1.
std::vector<int> neighbours(const Rectangles& rectangles) {
    struct Line {
        int low, high, side;
    };
    std::vector<Line> lines;
    const auto& all = rectangles.all;
    for (int r = 0; r < count_of(all); ++r)
        for (int k = 0; k < 4; ++k) {
            const auto [low, high] = std::minmax(all[r].corner[k], all[r].corner[(k + 1) % 4]);
            lines.push_back({low, high, 4 * r + k});
        }
    std::sort(lines.begin(), lines.end(),
              [](const Line& a, const Line& b) { return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side); });
    std::vector<int> out(lines.size(), -1);
    for (std::size_t first = 0, last = 0; first < lines.size(); first = last) {
        for (last = first + 1; last < lines.size() && lines[last].low == lines[first].low && lines[last].high == lines[first].high;) ++last;
        if (last - first != 2) continue;
        const int a = lines[first].side, b = lines[first + 1].side;
        const auto& border = all[a / 4].border[a % 4];
        const auto& other = all[b / 4].border[b % 4];
        const bool sound = std::all_of(border.begin(), border.end(), [&](int e) { return rectangles.is_sound(e); });
        const bool opposite = all[a / 4].corner[a % 4] != all[b / 4].corner[b % 4];
        if (a / 4 == b / 4 || !sound || !opposite || !std::equal(border.begin(), border.end(), other.rbegin(), other.rend())) continue;
        out[a] = b;
        out[b] = a;
    }
    return out;
}

// Rectangles one after another, each by 4 r + (its side to the next one), which runs along the axis, as from lower to upper end.
struct Chain {
    std::vector<int> forward;
    bool closed = false;
};
int opposite_side(int side) { return side / 4 * 4 + (side + 2) % 4; }

// All of them, each rectangle in one for each of its two directions.
std::vector<Chain> chains(const std::vector<int>& neighbour) {
    std::vector<Chain> out;
    std::vector<char> seen(neighbour.size(), 0);
    for (int r = 0; r < count_of(neighbour) / 4; ++r)
        for (int axis = 0; axis < 2; ++axis) {
            const int seed = 4 * r + axis;
            if (seen[seed] != 0) continue;
            Chain chain;
            int first = seed;
            for (int back = neighbour[opposite_side(seed)]; back >= 0 && !chain.closed; back = neighbour[opposite_side(first)])
                if (back == seed)
                    chain.closed = true;
                else
                    first = back;
            if (chain.closed) first = seed;
            for (int at = first; at >= 0;) {
                seen[at] = seen[opposite_side(at)] = 1;
                chain.forward.push_back(at);
                at = neighbour[at] < 0 ? -1 : opposite_side(neighbour[at]);
                if (at == first) break;
            }
            out.push_back(std::move(chain));
        }
    return out;
}

bool is_round_kind(CornerKind kind) { return kind == CornerKind::convex_round || kind == CornerKind::concave_round; }

CornerKind kind_of(double turn) {
    if (std::abs(turn) <= straightest) return CornerKind::none;
    if (std::abs(turn) <= largest_smooth_turn) return turn > 0 ? CornerKind::convex_round : CornerKind::concave_round;
    return turn > 0 ? CornerKind::convex_edge : CornerKind::concave_edge;
}

// A side, with the rectangle's border that each corner is (4 r + k), and its rectangles.
struct DrawnSide {
    RoundedSide side;
    std::vector<int> borders, rectangles;

    int corner_after(int k) const { return k + 1 < count_of(side.corners) ? k + 1 : 0; }
};

// The axis points where its first component that is not 0 is positive: the same way seen along -axis is run through backward.
void turn_over(DrawnSide& drawn) {
    for (auto& corner : drawn.side.corners) std::swap(corner.rim[0], corner.rim[1]);
    drawn.side.axis = -drawn.side.axis;
    std::reverse(drawn.side.corners.begin(), drawn.side.corners.end());
    std::reverse(drawn.borders.begin(), drawn.borders.end());
    std::reverse(drawn.rectangles.begin(), drawn.rectangles.end());
    // Rectangle k stood after corner k of a ring, and now stands before it.
    if (drawn.side.closed) std::rotate(drawn.rectangles.begin(), drawn.rectangles.begin() + 1, drawn.rectangles.end());
}

DrawnSide drawn_side(const Rectangles& rectangles, const Chain& chain) {
    const auto& all = rectangles.all;
    DrawnSide out;
    RoundedSide& side = out.side;
    side.closed = chain.closed;
    const auto add_corner = [&](int border, int start, CornerKind kind) {
        const auto& corner = all[border / 4].corner;
        const int a = corner[border % 4], b = corner[(border + 1) % 4];
        side.corners.push_back({start == 0 ? std::array{a, b} : std::array{b, a}, kind});
        out.borders.push_back(border);
    };
    const auto end_kind = [&](int border) {
        return rectangles.is_concave(all[border / 4], border % 4) ? CornerKind::concave_edge : CornerKind::convex_edge;
    };
    const auto along = [&](int forward) {
        const auto& corner = all[forward / 4].corner;
        return Vector3(rectangles.at(corner[(forward + 1) % 4]) - rectangles.at(corner[forward % 4]));
    };
    side.axis.setZero();
    for (const int forward : chain.forward) side.axis += along(forward);
    side.axis.normalize();
    const std::size_t n = chain.forward.size();
    for (std::size_t k = 0; k < n; ++k) {
        const int forward = chain.forward[k], back = opposite_side(forward);
        out.rectangles.push_back(forward / 4);
        if (k == 0 && !chain.closed) {
            add_corner(back, 1, end_kind(back));
            continue;
        }
        const Vector3 before = all[chain.forward[k == 0 ? n - 1 : k - 1] / 4].normal, after = all[forward / 4].normal;
        add_corner(back, 1, kind_of(std::atan2(side.axis.dot(before.cross(after)), before.dot(after))));
    }
    if (!chain.closed) add_corner(chain.forward.back(), 0, end_kind(chain.forward.back()));
    for (int i = 0; i < 3; ++i) {
        if (std::abs(side.axis[i]) <= tolerance) continue;
        if (side.axis[i] < 0) turn_over(out);
        break;
    }
    for (std::size_t end = 0; end < 2; ++end) side.ends[end] = side.axis.dot(rectangles.at(side.corners.front().rim[end]));
    return out;
}

// Marks the rectangles of which the circles between them leave less than a share plane.
void mark_curved(const Rectangles& rectangles, const DrawnSide& drawn, std::vector<char>& curved) {
    const auto& corners = drawn.side.corners;
    const int n = drawn.side.rectangles();
    std::vector<double> width;
    for (int k = 0; k < n; ++k)
        width.push_back((rectangles.at(corners[drawn.corner_after(k)].rim[0]) - rectangles.at(corners[k].rim[0])).norm());
    for (int k = 0; k < n; ++k) {
        double plane = width[k];
        const int before = k == 0 ? n - 1 : k - 1, after = k + 1 == n ? 0 : k + 1;
        if (is_round_kind(corners[k].kind)) plane -= std::min(width[before], width[k]) / 2;
        if (is_round_kind(corners[drawn.corner_after(k)].kind)) plane -= std::min(width[after], width[k]) / 2;
        if (plane < smallest_plane * width[k]) curved[drawn.rectangles[k]] = 1;
    }
}

void add_place(std::vector<RoundedSides::Place>& places, RoundedSides::Place place) {
    if (places.empty() || places.back().side != place.side || places.back().at != place.at) places.push_back(place);
}

void add_side(const Rectangles& rectangles, const DrawnSide& drawn, RoundedSides& out) {
    const int number = count_of(out.sides);
    const auto& corners = drawn.side.corners;
    const bool round = drawn.side.is_round();
    for (int k = 0; k < count_of(corners); ++k) {
        for (const int v : corners[k].rim) add_place(out.of_vertex[v], {number, k});
        const int border = drawn.borders[k];
        for (const int e : rectangles.all[border / 4].border[border % 4]) add_place(out.of_edge[e], {number, k});
    }
    for (int k = 0; k < drawn.side.rectangles(); ++k) {
        const Rectangle& r = rectangles.all[drawn.rectangles[k]];
        // Its borders at the ends are those that its corners' lines are not.
        const int lines = drawn.borders[k] / 4 == drawn.rectangles[k] ? drawn.borders[k] % 4 : drawn.borders[drawn.corner_after(k)] % 4;
        for (const int end : {(lines + 1) % 4, (lines + 3) % 4})
            for (const int e : r.border[end]) add_place(out.of_edge[e], {number, k});
        for (const int t : r.triangles) {
            RoundedSides::Place& place = out.of_triangle[t];
            if (place.side < 0 || (round && !out.sides[place.side].is_round())) place = {number, k};
            for (const int v : rectangles.corners_of(t)) {
                auto& places = out.of_vertex[v];
                if (places.empty() || places.back().side != number) places.push_back({number, k});
            }
            for (int j = 0; j < 3; ++j)
                if (const int e = rectangles.edge_of(t, j); rectangles.is_flat(e)) add_place(out.of_edge[e], {number, k});
        }
    }
    out.sides.push_back(drawn.side);
}

}  // namespace

bool RoundedSide::is_round() const {
    return std::any_of(corners.begin(), corners.end(), [](const Corner& c) { return is_round_kind(c.kind); });
}

RoundedSides rounded_sides(const Mesh& mesh) {
    RoundedSides out;
    out.of_vertex.resize(mesh.vertices.cols());
    out.of_triangle.resize(mesh.triangles.size());
    out.of_edge.resize(mesh.edges.size());
    const Rectangles rectangles(mesh);
    std::vector<DrawnSide> all;
    for (const Chain& chain : chains(neighbours(rectangles))) all.push_back(drawn_side(rectangles, chain));
    std::vector<char> curved(rectangles.all.size(), 0);
    for (const DrawnSide& drawn : all) mark_curved(rectangles, drawn, curved);
    for (const DrawnSide& drawn : all) {
        const auto is_curved = [&](int r) { return curved[r] != 0; };
        if (drawn.side.is_round() || !std::all_of(drawn.rectangles.begin(), drawn.rectangles.end(), is_curved))
            add_side(rectangles, drawn, out);
    }
    return out;
}

}  // namespace fettle::core::geometry
