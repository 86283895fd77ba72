// SPDX-License-Identifier: MIT
#include "design/optimisers/noise.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"

namespace fettle::design::optimisers {

namespace {

using core::base::infinity;

// Row k - 1 of the difference table, as the two things that are asked of it.
struct TableLevel {
    double level = 0;
    bool both_signs = false;
};

std::vector<TableLevel> difference_table(VectorX values) {
    std::vector<TableLevel> table;
    double gamma = 1;
    for (Eigen::Index k = 1; k < values.size(); ++k) {
        const Eigen::Index count = values.size() - k;
        for (Eigen::Index i = 0; i < count; ++i) values[i] = values[i + 1] - values[i];
        gamma *= 0.5 * static_cast<double>(k) / static_cast<double>(2 * k - 1);
        const auto differences = values.head(count);
        table.push_back({std::sqrt(gamma / static_cast<double>(count)) * differences.stableNorm(),
                         differences.minCoeff() < 0 && differences.maxCoeff() > 0});
    }
    return table;
}

bool mostly_equal(const VectorX& values) {
    Eigen::Index equal = 0;
    for (Eigen::Index i = 0; i + 1 < values.size(); ++i) equal += values[i + 1] == values[i];
    return 2 * equal >= values.size();
}

// Least squares in the polynomials that are orthogonal over equally spaced points: each coefficient is found by itself.
void fit_derivatives(const VectorX& values, double spacing, NoiseLevel& result) {
    const double middle = 0.5 * static_cast<double>(values.size() - 1);
    const VectorX x = VectorX::LinSpaced(values.size(), -middle, middle);
    const VectorX centred = values.array() - values.mean();
    const VectorX square = x.array().square() - x.squaredNorm() / static_cast<double>(x.size());
    const VectorX cube = x.array().cube() - x.array().pow(4).sum() / x.squaredNorm() * x.array();
    const double per_square = 2 / (spacing * spacing), per_cube = 6 / (spacing * spacing * spacing);
    result.second_derivative = square.dot(centred) / square.squaredNorm() * per_square;
    result.third_derivative = cube.dot(centred) / cube.squaredNorm() * per_cube;
    result.second_derivative_error = result.noise / square.norm() * per_square;
    result.third_derivative_error = result.noise / cube.norm() * per_cube;
}

void judge(const VectorX& values, NoiseLevel& result) {
    const std::vector<TableLevel> table = difference_table(values);
    if (mostly_equal(values)) {
        result.noise = table.front().level;
        result.status = NoiseStatus::spacing_too_small;
        return;
    }
    result.noise = infinity;
    for (size_t k = 0; k + 2 < table.size(); ++k) {
        const auto [least, most] = std::minmax({table[k].level, table[k + 1].level, table[k + 2].level});
        if (table[k].both_signs && most <= 4 * least) {
            result.noise = table[k].level;
            result.status = NoiseStatus::detected;
            return;
        }
        result.noise = std::min(result.noise, table[k].level);
    }
    result.status = NoiseStatus::spacing_too_large;
}

}  // namespace

NoiseLevel estimate_noise(const VectorX& values, double spacing) {
    FETTLE_ASSERT(values.size() >= 5 && values.allFinite() && spacing > 0, "five values or more, all finite");
    NoiseLevel result;
    judge(values, result);
    fit_derivatives(values, spacing, result);
    return result;
}

std::vector<NoiseLevel> estimate_noise_by_column(const MatrixX& values, double spacing) {
    std::vector<NoiseLevel> result;
    for (Eigen::Index q = 0; q < values.cols(); ++q) result.push_back(estimate_noise(VectorX(values.col(q)), spacing));
    return result;
}

double best_forward_step(double noise, double second_derivative) {
    FETTLE_ASSERT(noise >= 0, "a noise level");
    if (second_derivative == 0) return infinity;
    return std::pow(8, 0.25) * std::sqrt(noise / std::abs(second_derivative));
}

double best_central_step(double noise, double third_derivative) {
    FETTLE_ASSERT(noise >= 0, "a noise level");
    if (third_derivative == 0) return infinity;
    return std::cbrt(3 * noise / std::abs(third_derivative));
}

const char* to_string(NoiseStatus status) {
    if (status == NoiseStatus::detected) return "detected";
    return status == NoiseStatus::spacing_too_small ? "spacing too small" : "spacing too large";
}

}  // namespace fettle::design::optimisers
