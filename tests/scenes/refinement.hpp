// SPDX-License-Identifier: MIT
/// Errors of one simulation with time steps h, h/2, h/4, ...: the order that they show, and the limit that they foretell.
#pragma once

#include <cmath>
#include <vector>

namespace fettle::tests::scenes::refinement {

/// From each step to half of it: log2 of the quotient of the errors.
inline std::vector<double> orders(const std::vector<double>& errors) {
    std::vector<double> out;
    for (std::size_t k = 0; k + 1 < errors.size(); ++k) out.push_back(std::log2(std::abs(errors[k] / errors[k + 1])));
    return out;
}

/// Richardson's extrapolation to h = 0 of values whose error is c h^order + d h^(order + 1) + ...: one power for each value but the first.
/// Contract: at least one value.
inline double extrapolated(std::vector<double> values, int order) {
    for (; values.size() > 1; ++order) {
        const double factor = std::exp2(order);
        for (std::size_t k = 0; k + 1 < values.size(); ++k) values[k] = (factor * values[k + 1] - values[k]) / (factor - 1);
        values.pop_back();
    }
    return values.front();
}

}  // namespace fettle::tests::scenes::refinement
