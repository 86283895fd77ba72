// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/overlapping_boxes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace fettle::core::geometry {
namespace {

constexpr int leaf_size = 4;

struct Node {
    Box box;
    int first, last;            ///< range of `order`
    int left = -1, right = -1;  ///< children, -1 in a leaf

    bool is_leaf() const { return left < 0; }
};

class BoxTree {
public:
    explicit BoxTree(const std::vector<Box>& boxes) : boxes_(boxes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        nodes_.reserve(boxes.size());
        if (!boxes.empty()) build(0, static_cast<int>(boxes.size()));
    }

    /// False once `visit` has returned false.
    bool visit_within(int node, const std::function<bool(int, int)>& visit) const {
        const Node& n = nodes_[node];
        if (n.is_leaf()) {
            for (int i = n.first; i < n.last; ++i) {
                for (int j = i + 1; j < n.last; ++j) {
                    if (!visit_pair(order_[i], order_[j], visit)) return false;
                }
            }
            return true;
        }
        return visit_within(n.left, visit) && visit_within(n.right, visit) && visit_between(n.left, n.right, visit);
    }

private:
    int build(int first, int last) {
        const int index = static_cast<int>(nodes_.size());
        nodes_.push_back({bounds(first, last), first, last});
        if (last - first <= leaf_size) return index;
        Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (int i = first; i < last; ++i) {
            low = low.cwiseMin(centre(order_[i]));
            high = high.cwiseMax(centre(order_[i]));
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const int middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int i, int j) {
            const double a = centre(i)(axis), b = centre(j)(axis);
            return a != b ? a < b : i < j;  // a strict order of all boxes, so that the tree is the same on every platform
        });
        const int left = build(first, middle);
        const int right = build(middle, last);
        nodes_[index].left = left;
        nodes_[index].right = right;
        return index;
    }

    bool visit_between(int a, int b, const std::function<bool(int, int)>& visit) const {
        const Node &na = nodes_[a], &nb = nodes_[b];
        if (!na.box.overlaps(nb.box)) return true;
        if (na.is_leaf() && nb.is_leaf()) {
            for (int i = na.first; i < na.last; ++i) {
                for (int j = nb.first; j < nb.last; ++j) {
                    if (!visit_pair(order_[i], order_[j], visit)) return false;
                }
            }
            return true;
        }
        const bool split_a = nb.is_leaf() || (!na.is_leaf() && na.last - na.first >= nb.last - nb.first);
        return split_a ? visit_between(na.left, b, visit) && visit_between(na.right, b, visit)
                       : visit_between(a, nb.left, visit) && visit_between(a, nb.right, visit);
    }

    bool visit_pair(int i, int j, const std::function<bool(int, int)>& visit) const {
        return !boxes_[i].overlaps(boxes_[j]) || visit(std::min(i, j), std::max(i, j));
    }

    Box bounds(int first, int last) const {
        Box box = boxes_[order_[first]];
        for (int i = first + 1; i < last; ++i) {
            box.low = box.low.cwiseMin(boxes_[order_[i]].low);
            box.high = box.high.cwiseMax(boxes_[order_[i]].high);
        }
        return box;
    }

    Vector3 centre(int i) const { return boxes_[i].low / 2 + boxes_[i].high / 2; }

    const std::vector<Box>& boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace

void visit_overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& visit) {
    if (boxes.empty()) return;
    BoxTree(boxes).visit_within(0, visit);
}

}  // namespace fettle::core::geometry
