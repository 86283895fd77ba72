// SPDX-License-Identifier: MIT
/// Points that fill a cube evenly, the same ones on every run: multiples of powers of a generalised golden ratio, modulo 1 (M. Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018).
#pragma once

#include <cmath>
#include <vector>

namespace fettle::core::base {

/// frac(1/2 + index / g^(k + 1)), k < n, where g > 1 solves g^(n + 1) = g + 1. Point 0 is the middle of the unit cube.
class Kronecker {
public:
    explicit Kronecker(int n) {
        double g = 2;
        for (int k = 0; k < 60; ++k) g = std::pow(1 + g, 1.0 / (n + 1));
        for (int k = 0; k < n; ++k) steps_.push_back(std::pow(g, -(k + 1)));
    }
    /// Coordinate k of point `index`, in [0, 1).
    double at(int index, std::size_t k) const {
        const double y = 0.5 + index * steps_[k];
        return y - std::floor(y);
    }

private:
    std::vector<double> steps_;
};

}  // namespace fettle::core::base
