// SPDX-License-Identifier: MIT
/// Four lanes: what the language has no operators for (wide_instructions.hpp). All of it is inlined into functions for either kind of
/// instructions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/base/wide_instructions.hpp"

namespace fettle::core::base {

inline constexpr int lanes = 4;

[[gnu::always_inline]] inline void load(const double* from, Four& out) { std::memcpy(&out, from, sizeof out); }
[[gnu::always_inline]] inline void store(const Four& x, double* to) { std::memcpy(to, &x, sizeof x); }

[[gnu::always_inline]] inline void square_root(const Four& x, Four& out) {
    for (int j = 0; j < lanes; ++j) out[j] = std::sqrt(x[j]);
}

[[gnu::always_inline]] inline void magnitude(const Four& x, Four& out) {
    for (int j = 0; j < lanes; ++j) out[j] = std::abs(x[j]);
}

/// Raises `largest` to x, in Four or in double. A NaN is taken, and stays.
template <class Value>
[[gnu::always_inline]] inline void take_larger(const Value& x, Value& largest) {
    largest = ((x > largest) | (x != x)) ? x : largest;
}
template <class Value>
[[gnu::always_inline]] inline void take_smaller(const Value& x, Value& smallest) {
    smallest = ((x < smallest) | (x != x)) ? x : smallest;
}

/// out[i][j] = rows[j][i].
[[gnu::always_inline]] inline void transpose(const std::array<Four, lanes>& rows, std::array<Four, lanes>& out) {
    const auto &x = rows[0], &y = rows[1], &z = rows[2], &w = rows[3];
    const Four xy0 = __builtin_shufflevector(x, y, 0, 4, 2, 6), xy1 = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    const Four zw0 = __builtin_shufflevector(z, w, 0, 4, 2, 6), zw1 = __builtin_shufflevector(z, w, 1, 5, 3, 7);
    out[0] = __builtin_shufflevector(xy0, zw0, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(xy1, zw1, 0, 1, 4, 5);
    out[2] = __builtin_shufflevector(xy0, zw0, 2, 3, 6, 7);
    out[3] = __builtin_shufflevector(xy1, zw1, 2, 3, 6, 7);
}

/// The numbers of four objects of `count` doubles each and nothing else, one number to an element of `out`..
template <std::size_t count, class Object>
[[gnu::always_inline]] inline void gather(const std::array<const Object*, lanes>& objects, std::array<Four, count>& out) {
    static_assert(sizeof(Object) == count * sizeof(double) && count >= lanes);
    for (std::size_t k = 0; k < count; k += lanes) {
        const std::size_t first = k + lanes <= count ? k : count - lanes;  // the last ones twice, rather than what lies behind them
        std::array<Four, lanes> rows, columns;
        for (std::size_t j = 0; j < lanes; ++j) load(reinterpret_cast<const double*>(objects[j]) + first, rows[j]);
        transpose(rows, columns);
        for (std::size_t i = 0; i < lanes; ++i) out[first + i] = columns[i];
    }
}

}  // namespace fettle::core::base
