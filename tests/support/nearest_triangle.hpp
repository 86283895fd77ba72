// SPDX-License-Identifier: MIT
/// The distance of a place from a mesh's triangles, by a tree of boxes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/geometry/distance.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::tests::support {

class NearestTriangle {
public:
    explicit NearestTriangle(const core::geometry::Mesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        split(0, order_.size());
    }
    double distance(const Vector3& place) const {
        double best = std::numeric_limits<double>::infinity();  // squared
        search(0, place, best);
        return std::sqrt(best);
    }

private:
    struct Node {
        Vector3 low, high;
        std::size_t first = 0, last = 0;
        int left = -1, right = -1;
    };
    Vector3 corner(int t, int k) const {
        return mesh_.vertices.col(mesh_.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
    }

    int split(std::size_t first, std::size_t last) {
        Node node;
        node.first = first, node.last = last;
        node.low.setConstant(std::numeric_limits<double>::infinity());
        node.high = -node.low;
        for (std::size_t i = first; i < last; ++i) {
            for (int k = 0; k < 3; ++k) {
                node.low = node.low.cwiseMin(corner(order_[i], k));
                node.high = node.high.cwiseMax(corner(order_[i], k));
            }
        }
        const int index = static_cast<int>(nodes_.size());
        nodes_.push_back(node);
        if (last - first <= 4) return index;
        int axis = 0;
        (node.high - node.low).maxCoeff(&axis);
        const auto middle = [&](int t) { return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis]; };
        const std::size_t half = (first + last) / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(half), at(last), [&](int a, int b) { return middle(a) < middle(b); });
        const int left = split(first, half), right = split(half, last);
        nodes_[static_cast<std::size_t>(index)].left = left;
        nodes_[static_cast<std::size_t>(index)].right = right;
        return index;
    }
    double from_box(int index, const Vector3& place) const {
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        return (node.low - place).cwiseMax(place - node.high).cwiseMax(0.0).squaredNorm();
    }
    void search(int index, const Vector3& place, double& best) const {
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (from_box(index, place) >= best) return;
        if (node.left < 0) {
            for (std::size_t i = node.first; i < node.last; ++i)
                best = std::min(best, core::geometry::point_triangle_distance_squared(place, corner(order_[i], 0), corner(order_[i], 1),
                                                                                      corner(order_[i], 2)));
            return;
        }
        const bool left_first = from_box(node.left, place) <= from_box(node.right, place);
        search(left_first ? node.left : node.right, place, best);
        search(left_first ? node.right : node.left, place, best);
    }

    const core::geometry::Mesh& mesh_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace fettle::tests::support
