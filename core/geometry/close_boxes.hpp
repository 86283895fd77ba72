// SPDX-License-Identifier: MIT
/// Pairs of overlapping boxes among very many, in no order that a caller may rely on: built in linear time and searched on several threads.
/// Where the order of the calls matters: overlapping_boxes.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/geometry/overlapping_boxes.hpp"

namespace fettle::core::geometry {

/// A tree over boxes along a curve that fills space (Morton order): groups of four boxes, of four groups, and so on.
class CloseBoxes {
public:
    /// Contract: finite boxes with low <= high.
    explicit CloseBoxes(const std::vector<Box>& boxes);

    /// How many tasks the search is cut into: by the boxes alone.
    int tasks() const { return count_of(tasks_); }

    /// Calls visit(i, j) for pairs of boxes of a task: over all tasks once for each two that overlap, and for some that nearly do. Until it
    /// returns false. Tasks are independent: each may run on a thread of its own.
    template <class Visit>
    void visit_task(int task, const Visit& visit) const;

private:
    using Lanes = Eigen::Array<float, 4, 1>;

    /// Coordinates through a map that keeps their order, so that what overlaps still does. Places that are not taken are far from all.
    struct Group {
        std::array<Lanes, 3> low, high;

        /// Bit 4 i + j: does box i overlap box j of the other? Where the least of these differences is not negative.
        unsigned overlaps(const Group& other) const {
            unsigned found = 0;
            for (int i = 0; i < 4; ++i) {
                Lanes room = (other.high[0] - low[0][i]).min(high[0][i] - other.low[0]);
                for (std::size_t k = 1; k < 3; ++k) room = room.min(other.high[k] - low[k][i]).min(high[k][i] - other.low[k]);
                for (int j = 0; j < 4; ++j) found |= (~std::bit_cast<std::uint32_t>(room[j]) >> 31) << (4 * i + j);
            }
            return found;
        }
    };
    struct GroupPair {
        int level, a, b;  ///< within one group if a = b
    };

    std::vector<Group> sorted_groups(const std::vector<Box>& boxes);
    /// The box of the groups 4 g to 4 g + 3.
    static Group joined(const std::vector<Group>& below, int g);
    void add_levels();
    void cut_tasks();
    template <class Handle>
    bool descend(const GroupPair& pair, int lowest, const Handle& handle) const;

    std::vector<int> order_;                  ///< positions of the caller's boxes along the curve
    std::vector<std::vector<Group>> levels_;  ///< from the boxes to the root; box i of group g has group 4 g + i below it
    std::vector<GroupPair> tasks_;
};

/// handle(pair) for the overlapping pairs of level `lowest` that stand below this one (level -1: of the caller's boxes, by their places in
/// `order_`); false once it has returned false.
template <class Handle>
bool CloseBoxes::descend(const GroupPair& pair, int lowest, const Handle& handle) const {
    if (pair.level == lowest) return handle(pair);
    const Group& first = levels_[pair.level][pair.a];
    const Group& second = levels_[pair.level][pair.b];
    unsigned found = first.overlaps(second);
    // A box with itself is no pair, a group with itself is; each pair once.
    if (pair.a == pair.b) found &= pair.level == 0 ? 0x08ceU : 0x8cefU;
    for (; found != 0; found &= found - 1) {
        const int bit = std::countr_zero(found);
        const GroupPair below{pair.level - 1, 4 * pair.a + bit / 4, 4 * pair.b + bit % 4};
        if (!(below.level == lowest ? handle(below) : descend(below, lowest, handle))) return false;
    }
    return true;
}

template <class Visit>
void CloseBoxes::visit_task(int task, const Visit& visit) const {
    descend(tasks_[task], -1, [&](const GroupPair& boxes) { return visit(order_[boxes.a], order_[boxes.b]); });
}

}  // namespace fettle::core::geometry
