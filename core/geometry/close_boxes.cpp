// SPDX-License-Identifier: MIT
#include "core/geometry/close_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/parallel.hpp"

namespace fettle::core::geometry {
namespace {

constexpr int boxes_per_piece = 8192;
constexpr int groups_per_task_level = 64;  ///< about so many groups, and the pairs of them, are the tasks
constexpr float far_away = 1e6F;           ///< coordinates are mapped to -1 to 1

/// Every third bit: 10 bits of x become bits 0, 3, 6, ...
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

struct Key {
    std::uint32_t place;  ///< along the curve
    int box;
};

/// By place, then by position: digits of ten bits, the lowest first.
void sort_keys(std::vector<Key>& keys) {
    constexpr std::uint32_t digits = 1024;
    std::vector<Key> other(keys.size());
    for (int shift = 0; shift < 30; shift += 10) {
        std::array<std::size_t, digits + 1> first{};
        for (const Key& key : keys) ++first[(key.place >> shift & (digits - 1)) + 1];
        for (std::size_t d = 1; d <= digits; ++d) first[d] += first[d - 1];
        for (const Key& key : keys) other[first[key.place >> shift & (digits - 1)]++] = key;
        keys.swap(other);
    }
}

}  // namespace

CloseBoxes::CloseBoxes(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    levels_.push_back(sorted_groups(boxes));
    add_levels();
    cut_tasks();
}

std::vector<CloseBoxes::Group> CloseBoxes::sorted_groups(const std::vector<Box>& boxes) {
    Vector3 low = boxes[0].low, high = boxes[0].high;
    for (const Box& box : boxes) {
        low = low.cwiseMin(box.low);
        high = high.cwiseMax(box.high);
    }
    const Vector3 middle = low / 2 + high / 2;
    Vector3 scale;
    for (int k = 0; k < 3; ++k) {
        const double half = std::max(high[k] - middle[k], middle[k] - low[k]);
        scale[k] = half > 1e-290 && half < 1e290 ? 1 / half : 0;  // 0: all are taken for the same
    }
    // A difference, a product and two roundings never turn the order of two numbers round. Adding 0 turns -0 into +0, so that the
    // difference of equal numbers is +0.
    const auto mapped = [&](double x, int k) { return static_cast<float>(std::clamp((x - middle[k]) * scale[k], -2.0, 2.0)) + 0.0F; };
    const int count = count_of(boxes), groups = (count + 3) / 4;
    std::vector<Key> keys(boxes.size());
    base::parallel_for(count, boxes_per_piece, [&](int i) {
        const Box& box = boxes[i];
        std::uint32_t place = 0;
        for (int k = 0; k < 3; ++k) {
            const float fraction = 0.25F * (mapped(box.low[k], k) + mapped(box.high[k], k)) + 0.5F;
            place |= spread(static_cast<std::uint32_t>(std::clamp(1024 * fraction, 0.0F, 1023.0F))) << k;
        }
        keys[i] = {place, i};
    });
    sort_keys(keys);
    order_.resize(boxes.size());
    std::vector<Group> out(groups);
    base::parallel_for(groups, boxes_per_piece / 4, [&](int g) {
        Group& group = out[g];
        for (int i = 0; i < 4; ++i) {
            const auto at = static_cast<std::size_t>(4 * g + i);
            if (at < keys.size()) order_[at] = keys[at].box;
            for (int k = 0; k < 3; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                group.low[axis][i] = at < keys.size() ? mapped(boxes[keys[at].box].low[k], k) : far_away;
                group.high[axis][i] = at < keys.size() ? mapped(boxes[keys[at].box].high[k], k) : -far_away;
            }
        }
    });
    return out;
}

CloseBoxes::Group CloseBoxes::joined(const std::vector<Group>& below, int g) {
    Group group;
    for (int i = 0; i < 4; ++i) {
        const auto at = static_cast<std::size_t>(4 * g + i);
        for (std::size_t k = 0; k < 3; ++k) {
            group.low[k][i] = at < below.size() ? below[at].low[k].minCoeff() : far_away;
            group.high[k][i] = at < below.size() ? below[at].high[k].maxCoeff() : -far_away;
        }
    }
    return group;
}

void CloseBoxes::add_levels() {
    while (levels_.back().size() > 1) {
        const std::vector<Group>& below = levels_.back();
        std::vector<Group> level((below.size() + 3) / 4);
        base::parallel_for(count_of(level), boxes_per_piece / 4, [&](int g) { level[g] = joined(below, g); });
        levels_.push_back(std::move(level));
    }
}

void CloseBoxes::cut_tasks() {
    const int top = count_of(levels_) - 1;
    int level = top;
    while (level > 0 && count_of(levels_[level]) < groups_per_task_level) --level;
    descend({top, 0, 0}, level, [&](const GroupPair& pair) {
        tasks_.push_back(pair);
        return true;
    });
}

}  // namespace fettle::core::geometry
