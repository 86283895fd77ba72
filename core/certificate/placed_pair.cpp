// SPDX-License-Identifier: MIT
#include "core/certificate/placed_pair.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t most_pairs = 36;  // of vertices that are looked at one by one

TaylorModel along(const Vector3& n, const Model3& x) { return scaled(n[0], x[0]) + scaled(n[1], x[1]) + scaled(n[2], x[2]); }

// How far the values of a set of vertices reach, in n.x.
struct ValueReach {
    std::vector<TaylorModel> values;
    std::array<double, most_variables> middle{};  // of their slopes

    void find_middle() {
        for (std::size_t k = 0; k < middle.size(); ++k) {
            double low = infinity, high = -infinity;
            for (const TaylorModel& x : values) {
                low = std::min(low, x.slopes[k]);
                high = std::max(high, x.slopes[k]);
            }
            middle[k] = 0.5 * low + 0.5 * high;
        }
    }
    // sign 1: least of them without the middle's part; -1: the same of -x.
    double least(double sign) const {
        double out = infinity;
        for (const TaylorModel& x : values) {
            double spread = x.rest, size = std::abs(x.center) + x.rest;
            for (std::size_t k = 0; k < middle.size(); ++k) {
                spread += std::abs(x.slopes[k] - middle[k]);
                size += std::abs(x.slopes[k]) + std::abs(middle[k]);
            }
            const double value = sign * x.center - spread - rounding_of_sums * size;
            if (!(value >= out)) out = value;  // also what is no number
        }
        return out;
    }
};

double least_of_pairs(const ValueReach& a, const ValueReach& b) {
    double out = infinity;
    for (const TaylorModel& x : a.values)
        for (const TaylorModel& y : b.values) {
            double spread = x.rest + y.rest, size = std::abs(x.center) + std::abs(y.center) + spread;
            for (std::size_t k = 0; k < x.slopes.size(); ++k) {
                spread += std::abs(x.slopes[k] - y.slopes[k]);
                size += std::abs(x.slopes[k]) + std::abs(y.slopes[k]);
            }
            const double value = x.center - y.center - spread - rounding_of_sums * size;
            if (!(value >= out)) out = value;
        }
    return out;
}

double least_of_pieces(ValueReach& a, ValueReach& b) {
    a.find_middle();
    b.find_middle();
    double common = 0, size = 0;
    for (std::size_t k = 0; k < a.middle.size(); ++k) {
        common += std::abs(a.middle[k] - b.middle[k]);
        size += std::abs(a.middle[k]) + std::abs(b.middle[k]);
    }
    const double of_a = a.least(1), of_b = b.least(-1);
    return of_a + of_b - common - rounding_of_sums * (size + std::abs(of_a) + std::abs(of_b));
}

}  // namespace

double least_along(const PlacedPair& at, const Vector3& n, std::span<const int> a, std::span<const int> b) {
    if (!at.is_known) return -infinity;
    const ModelMatrix columns = transposed(at.rotation);
    const Model3 f{along(n, columns[0]), along(n, columns[1]), along(n, columns[2])};
    const TaylorModel offset = along(n, at.place);
    ValueReach of_a, of_b;
    for (const int v : a) of_a.values.push_back(dot(f, at.models->a[v]) + offset);
    for (const int v : b) of_b.values.push_back(along(n, at.models->b[v]));
    const double least = a.size() * b.size() <= most_pairs ? least_of_pairs(of_a, of_b) : least_of_pieces(of_a, of_b);
    return std::isnan(least) ? -infinity : least;
}

double least_turning(const PlacedPair& at, const Model3& n, std::span<const int> a, std::span<const int> b) {
    if (!at.is_known || a.size() * b.size() > most_pairs) return -infinity;
    const geometry::Interval length = dot(n, n).interval();
    double least = infinity;
    for (const int v : a) {
        const Model3 x = times(at.rotation, at.models->a[v]) + at.place;
        for (const int w : b) {
            const double low = dot(n, x - at.models->b[w]).interval().low;
            if (!(low >= least)) least = low;  // also what is no number
        }
    }
    if (!(least > 0) || !(length.high < 1e12)) return -infinity;
    return geometry::lower(least / geometry::upper(std::sqrt(length.high)));
}

Model3 turning_vector(std::span<const Vector3> vectors) {
    Model3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        out[i].center = vectors[0][row];
        for (std::size_t k = 1; k < vectors.size(); ++k) out[i].slopes[k - 1] = vectors[k][row];
    }
    return out;
}

}  // namespace fettle::core::certificate
