// SPDX-License-Identifier: MIT
#include "core/mesh_files/millimetres.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace fettle::core::mesh_files {

std::string decimal(double x) {
    std::array<char, 32> text{};
    const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), x);
    return {text.data(), end};
}

std::string millimetres(double x) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double scaled = 1000 * x;
    for (const double v : {scaled, std::nextafter(scaled, infinity), std::nextafter(scaled, -infinity)}) {
        if (v * 1e-3 == x) return decimal(v);
    }
    return decimal(scaled);
}

}  // namespace fettle::core::mesh_files
