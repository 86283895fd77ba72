// SPDX-License-Identifier: MIT
#include "design/tolerances/moments.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

double skewness(const Moments& moments) {
    return moments.standard_deviation > 0 ? moments.third / std::pow(moments.standard_deviation, 3) : 0;
}

double kurtosis(const Moments& moments) {
    return moments.standard_deviation > 0 ? moments.fourth / std::pow(moments.standard_deviation, 4) : 3;
}

SampleMoments sample_moments(const VectorX& values) {
    FETTLE_ASSERT(values.size() >= 2 && values.allFinite(), "two values or more, all finite");
    const double n = static_cast<double>(values.size());
    SampleMoments result;
    Moments& moments = result.moments;
    moments.mean = values[0] + (values.array() - values[0]).mean();  // exact where all are equal
    const Eigen::ArrayXd centred = values.array() - moments.mean;
    const double variance = centred.square().sum() / (n - 1);
    moments.standard_deviation = std::sqrt(variance);
    moments.third = centred.cube().mean();
    moments.fourth = centred.square().square().mean();
    result.mean_error = moments.standard_deviation / std::sqrt(n);
    if (variance > 0) {
        const double variance_of_variance = (moments.fourth - variance * variance * (n - 3) / (n - 1)) / n;
        result.standard_deviation_error = std::sqrt(std::max(variance_of_variance, 0.0)) / (2 * moments.standard_deviation);
    }
    return result;
}

}  // namespace fettle::design::tolerances
