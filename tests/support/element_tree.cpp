// SPDX-License-Identifier: MIT
#include "tests/support/element_tree.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace fettle::tests::support {
namespace {

constexpr int leaf_size = 1;
constexpr double rounding = 1e-12;  // relative; sums and products of a dozen terms stay far below

std::vector<Element> elements_of(const core::geometry::Mesh& mesh) {
    std::vector<Element> elements;
    std::set<core::geometry::Edge> of_triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        elements.push_back({ElementKind::triangle, static_cast<int>(i), t});
        for (int k = 0; k < 3; ++k) of_triangles.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    }
    std::vector<bool> used(mesh.vertices.cols(), false);
    for (const auto& t : mesh.triangles)
        for (const int v : t) used[v] = true;
    for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
        const auto [a, b] = mesh.edges[i];
        used[a] = used[b] = true;
        if (of_triangles.count({std::min(a, b), std::max(a, b)}) == 0)
            elements.push_back({ElementKind::edge, static_cast<int>(i), {a, b, b}});
    }
    for (int v = 0; v < count_of(used); ++v)
        if (!used[v]) elements.push_back({ElementKind::point, v, {v, v, v}});
    return elements;
}

/// May boxes overlap, when all points of b move by up to `margin` relative to a? Axes of both boxes are tried.
struct RelativePose {
    Matrix3 rotation, absolute;  ///< b's axes in a's frame
    Vector3 position;
    RelativePose(const core::kinematics::Pose& a, const core::kinematics::Pose& b)
        : rotation(a.rotation.transpose() * b.rotation), position(a.rotation.transpose() * (b.position - a.position)) {
        absolute = rotation.cwiseAbs();
    }
    bool may_overlap(const ElementTree::Node& a, const ElementTree::Node& b, double margin) const {
        const Vector3 between = rotation * b.center + position - a.center;
        if (((between.cwiseAbs() - a.half - absolute * b.half).array() > margin).any()) return false;
        const Vector3 in_b = rotation.transpose() * between;
        return !((in_b.cwiseAbs() - b.half - absolute.transpose() * a.half).array() > margin).any();
    }
};

}  // namespace

const char* to_string(ElementKind kind) {
    return kind == ElementKind::triangle ? "triangle" : (kind == ElementKind::edge ? "edge" : "point");
}

Spread spread_of(const core::kinematics::PathSegment& path, double duration) {
    const double size = path.position_t0.norm() + path.position_step.norm();
    return {path.position_step.norm() * duration + rounding * size, path.rotation_vector_step.norm() * duration + rounding};
}

ElementTree::ElementTree(const core::geometry::Mesh& mesh) : elements_(elements_of(mesh)) {
    for (const Element& element : elements_) has_loose_elements_ |= element.kind != ElementKind::triangle;
    build(0, count_of(elements_), mesh);
    for (const Node& node : nodes_)
        if (node.left < 0) element_size_ += node.half.maxCoeff() / static_cast<double>(elements_.size());
}

int ElementTree::build(int first, int count, const core::geometry::Mesh& mesh) {
    // Boxes are recomputed from the vertices as the elements are reordered: quick enough for a checker.
    const auto box_of = [&](const Element& element) {
        Eigen::AlignedBox3d box;
        for (int k = 0; k < vertex_count(element); ++k) box.extend(Vector3(mesh.vertices.col(element.vertices[k])));
        return box;
    };
    Eigen::AlignedBox3d box, centers;
    Node node;
    for (int i = first; i < first + count; ++i) {
        box.extend(box_of(elements_[i]));
        centers.extend(box_of(elements_[i]).center());
        for (int k = 0; k < vertex_count(elements_[i]); ++k)
            node.radius = std::max(node.radius, mesh.vertices.col(elements_[i].vertices[k]).norm());
    }
    node.center = box.center();
    node.half = box.sizes() * (0.5 + rounding);
    node.first = first, node.count = count;
    const int here = count_of(nodes_);
    nodes_.push_back(node);
    if (count <= leaf_size) return here;
    int axis = 0;
    centers.sizes().maxCoeff(&axis);
    const int half = count / 2;
    std::nth_element(elements_.begin() + first, elements_.begin() + first + half, elements_.begin() + first + count,
                     [&](const Element& a, const Element& b) { return box_of(a).center()[axis] < box_of(b).center()[axis]; });
    const int left = build(first, half, mesh), right = build(first + half, count - half, mesh);
    nodes_[here].left = left, nodes_[here].right = right;
    return here;
}

std::vector<std::pair<int, int>> near_elements(const SpreadBody& a, const SpreadBody& b) {
    std::vector<std::pair<int, int>> pairs, open{{0, 0}};
    const RelativePose relative(a.pose, b.pose);
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        const ElementTree::Node &node_a = a.tree.nodes()[i], &node_b = b.tree.nodes()[j];
        const double margin = a.spread.q + a.spread.r * node_a.radius + b.spread.q + b.spread.r * node_b.radius;
        if (!relative.may_overlap(node_a, node_b, margin)) continue;
        const bool split_a = node_a.left >= 0 && (node_b.left < 0 || node_a.half.maxCoeff() >= node_b.half.maxCoeff());
        if (split_a) {
            open.emplace_back(node_a.left, j);
            open.emplace_back(node_a.right, j);
        } else if (node_b.left >= 0) {
            open.emplace_back(i, node_b.left);
            open.emplace_back(i, node_b.right);
        } else {
            for (int k = 0; k < node_a.count; ++k)
                for (int l = 0; l < node_b.count; ++l) pairs.emplace_back(node_a.first + k, node_b.first + l);
        }
    }
    return pairs;
}

}  // namespace fettle::tests::support
