// SPDX-License-Identifier: MIT
/// A box of a body's points along its segment, as both bodies of a pair see it: two boxes, compared with another's two at once.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace fettle::core::ccd {

/// Numbers 0 to 2 are along the axes of body a, 4 to 6 along those of body b, [m], rounded outwards; 3 and 7 belong to no axis and are
/// about 0, which separates nothing.
struct alignas(32) PlacedBox {
    std::array<float, 8> low{}, minus_high{};

    /// True only if the boxes are farther apart than the margin along some axis: sums of floats do not round past the margin, which is one.
    [[gnu::always_inline]] bool is_apart(const PlacedBox& other, float margin) const {
        Eight l, h, other_l, other_h;
        std::memcpy(&l, low.data(), sizeof l);
        std::memcpy(&h, minus_high.data(), sizeof h);
        std::memcpy(&other_l, other.low.data(), sizeof l);
        std::memcpy(&other_h, other.minus_high.data(), sizeof h);
        const auto is_along = (l + other_h > margin) | (other_l + h > margin);
        std::array<std::uint64_t, 4> any;
        std::memcpy(any.data(), &is_along, sizeof is_along);
        return (any[0] | any[1] | any[2] | any[3]) != 0;
    }
    /// Widens this one to hold both.
    void join(const PlacedBox& other) {
        take_smaller(other.low, low);
        take_smaller(other.minus_high, minus_high);
    }

private:
    using Eight = float __attribute__((vector_size(32)));

    static void take_smaller(const std::array<float, 8>& from, std::array<float, 8>& smallest) {
        Eight x, y;
        std::memcpy(&x, from.data(), sizeof x);
        std::memcpy(&y, smallest.data(), sizeof y);
        y = y <= x ? y : x;
        std::memcpy(smallest.data(), &y, sizeof y);
    }
};

}  // namespace fettle::core::ccd
