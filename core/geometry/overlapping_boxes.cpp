// SPDX-License-Identifier: MIT
#include "core/geometry/overlapping_boxes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/parallel.hpp"

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
        std::vector<Centre> centres(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) centres[i] = {boxes[i].low / 2 + boxes[i].high / 2, static_cast<int>(i)};
        nodes_.reserve(boxes.size());
        if (!boxes.empty()) build(centres, 0, count_of(boxes));
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
    struct Centre {
        Vector3 x;
        int box;
    };

    // The boxes of nodes come from below, each box's once.
    int build(std::vector<Centre>& centres, int first, int last) {
        const int index = count_of(nodes_);
        nodes_.emplace_back();
        nodes_[index].first = first;
        nodes_[index].last = last;
        if (last - first <= leaf_size) {
            for (int i = first; i < last; ++i) order_[i] = centres[i].box;
            Box box = boxes_[order_[first]];
            for (int i = first + 1; i < last; ++i) box = united(box, boxes_[order_[i]]);
            nodes_[index].box = box;
            return index;
        }
        Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (int i = first; i < last; ++i) {
            low = low.cwiseMin(centres[i].x);
            high = high.cwiseMax(centres[i].x);
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const int middle = first + (last - first) / 2;
        const auto begin = centres.begin();
        std::nth_element(begin + first, begin + middle, begin + last, [axis](const Centre& a, const Centre& b) {
            return a.x[axis] != b.x[axis] ? a.x[axis] < b.x[axis]
                                          : a.box < b.box;  // strict, so that the tree is the same on every platform
        });
        const int left = build(centres, first, middle);
        const int right = build(centres, middle, last);
        nodes_[index].left = left;
        nodes_[index].right = right;
        nodes_[index].box = united(nodes_[left].box, nodes_[right].box);
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

    static Box united(const Box& a, const Box& b) { return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)}; }

    const std::vector<Box>& boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

// By the first box, counted, then by the second: there are few of the same first. @param boxes  their number
std::vector<std::pair<int, int>> sorted(const std::vector<std::pair<int, int>>& pairs, std::size_t boxes) {
    std::vector<std::size_t> begin(boxes + 1, 0);  // of the pairs of each first box, once they have been counted and placed
    for (const auto& [a, b] : pairs) ++begin[a];
    std::size_t before = 0;
    for (std::size_t& count : begin) before += std::exchange(count, before);
    std::vector<std::pair<int, int>> out(pairs.size());
    for (const auto& pair : pairs) out[begin[pair.first]++] = pair;
    auto first = out.begin();
    for (std::size_t box = 0; box < boxes; ++box) {  // begin[box] is where its pairs end now
        const auto last = out.begin() + static_cast<std::ptrdiff_t>(begin[box]);
        std::sort(first, last);
        first = last;
    }
    return out;
}

}  // namespace

void visit_overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& visit) {
    if (boxes.empty()) return;
    BoxTree(boxes).visit_within(0, visit);
}

std::vector<std::pair<int, int>> overlapping_pairs(const std::vector<Box>& boxes, const std::function<bool(int, int)>& wanted) {
    constexpr int boxes_at_once = 64;  // that a thread takes
    using Pairs = BoxSweep::Pairs;
    std::vector<int> all(boxes.size());
    std::iota(all.begin(), all.end(), 0);
    const BoxSweep sweep(boxes, std::move(all));
    const auto found_from = [&](int begin, int end) {
        Pairs found;
        sweep.find(begin, end, std::numeric_limits<double>::denorm_min(), found);  // any gap at all is one
        found.erase(std::remove_if(found.begin(), found.end(), [&](const auto& pair) { return !wanted(pair.first, pair.second); }),
                    found.end());
        return found;
    };
    Pairs pairs = base::ordered_reduce(count_of(boxes), boxes_at_once, Pairs{}, found_from, [](Pairs&& so_far, Pairs&& piece) {
        so_far.insert(so_far.end(), piece.begin(), piece.end());
        return std::move(so_far);
    });
    return sorted(pairs, boxes.size());
}

}  // namespace fettle::core::geometry
