// SPDX-License-Identifier: MIT
#include "design/quantities/curve_slope.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::quantities {

using core::scene::Curve;
using core::scene::CurveKind;

namespace {

// Between which the table is one polynomial each, increasing.
std::vector<double> ends_of_pieces(const Curve& curve) {
    const std::vector<double>& entries = curve.times;
    if (entries.size() < 2) return entries;
    int parts = 1;
    if (curve.kind == CurveKind::trapezoid) parts = 3;
    if (curve.kind == CurveKind::control_points) parts = count_of(curve.values) - 3;
    std::vector<double> ends;
    for (std::size_t k = 0; k + 1 < entries.size(); ++k)
        for (int i = 0; i < parts; ++i) ends.push_back(entries[k] + (entries[k + 1] - entries[k]) * i / parts);
    ends.push_back(entries.back());
    return ends;
}

}  // namespace

double curve_slope(const Curve& curve, double place) {
    const std::vector<double> ends = ends_of_pieces(curve);
    const auto after = std::upper_bound(ends.begin(), ends.end(), place);
    if (after == ends.begin() || after == ends.end()) return 0;
    const double begin = *(after - 1), length = *after - begin;
    // Inside of the piece, where rounding puts no place into the next one.
    constexpr std::array<double, 4> shares{0.05, 0.35, 0.65, 0.95};
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) values[i] = curve_value(curve, begin + shares[i] * length);
    const double s = (place - begin) / length;
    double slope = 0;  // of Lagrange's polynomial
    for (std::size_t i = 0; i < 4; ++i) {
        double sum = 0, scale = 1;
        for (std::size_t j = 0; j < 4; ++j) {
            if (j == i) continue;
            scale *= shares[i] - shares[j];
            double product = 1;
            for (std::size_t k = 0; k < 4; ++k)
                if (k != i && k != j) product *= s - shares[k];
            sum += product;
        }
        slope += values[i] * sum / scale;
    }
    return slope / length;
}

}  // namespace fettle::design::quantities
