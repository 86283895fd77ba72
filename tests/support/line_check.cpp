// SPDX-License-Identifier: MIT
#include "tests/support/line_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::tests::support {
namespace {

constexpr int per_decade = 4, points_of_range = 2 * per_decade + 1;

struct Point {
    double h = 0, above = 0, below = 0;  // f(h) - f(0), f(-h) - f(0)
    double even() const { return 0.5 * (above + below); }
    double odd() const { return 0.5 * (above - below); }
    bool is_finite() const { return std::isfinite(above) && std::isfinite(below); }
};

// Ridders' table over the central differences; anew after a step without f.
double central_difference(const std::vector<Point>& points) {
    constexpr std::size_t most_orders = 5;
    const double ratio_squared = std::pow(10.0, 2.0 / per_decade);
    double best = std::numeric_limits<double>::quiet_NaN(), least = std::numeric_limits<double>::infinity();
    std::vector<double> previous, row;
    for (const Point& p : points) {
        row.clear();
        if (p.is_finite()) row.push_back(p.odd() / p.h);
        double factor = ratio_squared;
        for (std::size_t j = 1; !row.empty() && j <= std::min(previous.size(), most_orders - 1); ++j, factor *= ratio_squared) {
            row.push_back(row[j - 1] + (row[j - 1] - previous[j - 1]) / (factor - 1));
            const double error = std::max(std::abs(row[j] - row[j - 1]), std::abs(row[j] - previous[j - 1]));
            if (error >= least) continue;
            least = error;
            best = row[j];
        }
        previous = row;
    }
    return best;
}

bool second_order_stands_alone(const std::vector<Point>& points, std::size_t first, double difference) {
    constexpr double clean = 0.1;
    std::vector<double> curvature;
    for (std::size_t k = first; k < first + points_of_range; ++k) {
        const Point& p = points[k];
        if (!p.is_finite() || !(std::abs(p.odd() - p.h * difference) < 2 * clean * std::abs(p.even()))) return false;
        curvature.push_back(p.even() / (p.h * p.h));
    }
    std::vector<double> sorted = curvature;
    std::nth_element(sorted.begin(), sorted.begin() + points_of_range / 2, sorted.end());
    const double middle = sorted[points_of_range / 2];
    return std::all_of(curvature.begin(), curvature.end(), [&](double c) { return std::abs(c / middle - 1) < clean; });
}

// @param side  1 or -1
double slope_of(const std::vector<Point>& points, std::size_t first, double side, double derivative) {
    double mean_h = 0, mean_r = 0, covariance = 0, variance = 0;
    std::vector<double> log_h, log_r;
    for (std::size_t k = first; k < first + points_of_range; ++k) {
        const Point& p = points[k];
        log_h.push_back(std::log(p.h));
        log_r.push_back(std::log(std::abs((side > 0 ? p.above : p.below) - side * p.h * derivative)));
        mean_h += log_h.back() / points_of_range;
        mean_r += log_r.back() / points_of_range;
    }
    for (std::size_t k = 0; k < log_h.size(); ++k) {
        covariance += (log_h[k] - mean_h) * (log_r[k] - mean_r);
        variance += (log_h[k] - mean_h) * (log_h[k] - mean_h);
    }
    return covariance / variance;
}

}  // namespace

LineCheck check_line(const std::function<double(double)>& change, double derivative, const LineSweep& sweep) {
    std::vector<Point> points;
    for (int k = 0; k <= sweep.decades * per_decade; ++k) {
        const double h = sweep.largest * std::pow(10.0, -static_cast<double>(k) / per_decade);
        points.push_back({h, change(h), change(-h)});
    }
    LineCheck check;
    check.difference = central_difference(points);
    const double error = std::abs(derivative - check.difference), scale = std::max(std::abs(derivative), std::abs(check.difference));
    check.relative_error = error == 0 ? 0 : error / scale;
    if (!std::isfinite(check.relative_error)) check.relative_error = std::numeric_limits<double>::infinity();
    for (std::size_t first = points.size() - points_of_range + 1; first-- > 0 && !check.tells;) {
        if (!second_order_stands_alone(points, first, check.difference)) continue;
        check.tells = true;
        check.largest = points[first].h;
        check.smallest = points[first + points_of_range - 1].h;
        const double above = slope_of(points, first, 1, derivative), below = slope_of(points, first, -1, derivative);
        check.slope = std::abs(above - 2) > std::abs(below - 2) ? above : below;
    }
    return check;
}

}  // namespace fettle::tests::support
