// SPDX-License-Identifier: MIT
#include "design/tolerances/control_variate.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

ControlledMean controlled_mean(const VectorX& y, const VectorX& x, double mean_of_x) {
    FETTLE_ASSERT(y.size() == x.size() && y.size() >= 3, "pairs of samples, at least 3");
    const auto n = static_cast<double>(y.size());
    const double y_mean = y.mean(), x_mean = x.mean();
    const double yy = (y.array() - y_mean).square().sum(), xx = (x.array() - x_mean).square().sum();
    const double xy = ((y.array() - y_mean) * (x.array() - x_mean)).sum();
    if (!(xx > 0 && yy > 0)) return {y_mean, std::sqrt(yy / (n - 1) / n), 0};
    const double slope = xy / xx, correlation = std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
    const double left = std::max(0.0, yy - xy * slope);
    return {y_mean - slope * (x_mean - mean_of_x), std::sqrt(left / (n - 2) / n), correlation};
}

CountedYield controlled_yield(double predicted, int gained, int lost, int of, double confidence) {
    const double each = 0.5 * (1 + confidence);
    const CountedYield up = counted_yield(gained, of, each), down = counted_yield(lost, of, each);
    const auto at = [&](const Yield& plus, const Yield& minus) {
        const double within = std::clamp(predicted + plus.within - minus.within, 0.0, 1.0);
        return Yield{within, 1 - within};
    };
    return {at(up.found, down.found), at(up.least, down.most), at(up.most, down.least)};
}

}  // namespace fettle::design::tolerances
