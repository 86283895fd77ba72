// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/predicates.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

using geometry::orient2d;
using geometry::Triangle;

/// A corner in the plane, counter-clockwise outline.
struct Corner {
    Vector2 x;
    int vertex = 0;
    std::size_t before = 0, after = 0;  ///< in what is left of the outline
    std::size_t next_to_test = 0;       ///< corners before this one are known not to block the triangle of this corner and its neighbours
    bool there = true;
};

/// Cuts ears off. What has been found of a corner's triangle is kept until a neighbour goes: all tests together are of the second order.
class EarClipper {
public:
    EarClipper(std::vector<Corner> outline, std::int64_t& tests) : corners_(std::move(outline)), tests_(tests) {
        const std::size_t n = corners_.size();
        for (std::size_t i = 0; i < n; ++i) {
            corners_[i].before = (i + n - 1) % n;
            corners_[i].after = (i + 1) % n;
        }
    }

    /// Empty if the outline crosses itself, or the tests run out.
    std::vector<Triangle> triangles() {
        std::vector<Triangle> out;
        std::size_t first = 0;
        for (std::size_t left = corners_.size(); left > 3; --left) {
            // The second corner is tried first, and the first one last.
            std::size_t ear = corners_[first].after;
            while (tests_ >= 0 && !is_ear(ear)) {
                if (ear == first) return {};
                ear = corners_[ear].after;
            }
            if (tests_ < 0) return {};
            out.push_back(triangle(ear));
            if (ear == first) first = corners_[ear].after;
            remove(ear);
        }
        out.push_back({corners_[first].vertex, corners_[corners_[first].after].vertex, corners_[corners_[first].before].vertex});
        return out;
    }

private:
    Triangle triangle(std::size_t i) const {
        return {corners_[corners_[i].before].vertex, corners_[i].vertex, corners_[corners_[i].after].vertex};
    }

    bool is_ear(std::size_t i) {
        Corner& corner = corners_[i];
        --tests_;
        if (corner.next_to_test == not_convex) return false;
        const Vector2 &a = corners_[corner.before].x, &b = corner.x, &c = corners_[corner.after].x;
        if (corner.next_to_test == 0 && orient2d(a, b, c) <= 0) {
            corner.next_to_test = not_convex;
            return false;
        }
        const Vector2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        for (; corner.next_to_test < corners_.size(); ++corner.next_to_test, --tests_) {
            const Corner& other = corners_[corner.next_to_test];
            const Vector2& p = other.x;
            if (!other.there || (p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
            if (p == a || p == b || p == c) continue;
            // Also a corner on the diagonal c a blocks: cutting there would leave a piece without area.
            if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) return false;
        }
        return true;
    }

    void remove(std::size_t i) {
        Corner& gone = corners_[i];
        gone.there = false;
        corners_[gone.before].after = gone.after;
        corners_[gone.after].before = gone.before;
        corners_[gone.before].next_to_test = corners_[gone.after].next_to_test = 0;
    }

    static constexpr std::size_t not_convex = static_cast<std::size_t>(-1);
    std::vector<Corner> corners_;
    std::int64_t& tests_;
};

/// Does it turn left at every corner, and once round in all? Edges that go right, or straight up, are a half of all directions; who turns
/// by less than a half each time enters that half once for each time round.
bool is_strictly_convex(const std::vector<Corner>& outline) {
    const std::size_t n = outline.size();
    const auto goes_right = [&](std::size_t i) {
        const Vector2 &a = outline[i].x, &b = outline[(i + 1) % n].x;
        return b.x() > a.x() || (b.x() == a.x() && b.y() > a.y());
    };
    int rounds = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(orient2d(outline[i].x, outline[(i + 1) % n].x, outline[(i + 2) % n].x) > 0)) return false;
        rounds += !goes_right(i) && goes_right((i + 1) % n) ? 1 : 0;
    }
    return rounds == 1;
}

/// As the clipper cuts it.
std::vector<Triangle> fan(const int* corners, int count) {
    std::vector<Triangle> out;
    for (int i = 1; i + 1 < count; ++i) out.push_back({corners[0], corners[i], corners[i + 1]});
    return out;
}

Vector3 newell_normal(const std::vector<Vector3>& vertices, const int* corners, int count) {
    Vector3 normal = Vector3::Zero();
    for (int i = 0; i < count; ++i) {
        const Vector3 a = vertices[corners[i]] - vertices[corners[0]], b = vertices[corners[(i + 1) % count]] - vertices[corners[0]];
        normal += a.cross(b);
    }
    return normal;
}

}  // namespace

std::vector<Triangle> triangulated(const std::vector<Vector3>& vertices, const int* corners, int count, std::int64_t& tests) {
    if (count == 3) return {{corners[0], corners[1], corners[2]}};
    const Vector3 normal = newell_normal(vertices, corners, count);
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    std::vector<Corner> outline(count);
    for (int i = 0; i < count; ++i) {
        Vector2 x = geometry::projected(vertices[corners[i]], axis);
        if (normal(axis) < 0) x.x() = -x.x();
        outline[i].x = x;
        outline[i].vertex = corners[i];
    }
    if (is_strictly_convex(outline)) return fan(corners, count);
    return EarClipper(std::move(outline), tests).triangles();
}

}  // namespace fettle::core::mesh_files
