// SPDX-License-Identifier: MIT
#include "design/tolerances/variance_components.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::tolerances {

namespace {

constexpr double components_confidence = 0.95;
using NoPromotion = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

double root(double variance) { return std::sqrt(std::max(0.0, variance)); }

}  // namespace

double chi_square_quantile(int freedom, double p) { return 2 * boost::math::gamma_p_inv(freedom / 2.0, p, NoPromotion()); }

double f_quantile(int freedom1, int freedom2, double p) {
    double complement = 0;
    const double x = boost::math::ibeta_inv(freedom1 / 2.0, freedom2 / 2.0, p, &complement, NoPromotion());
    return freedom2 * x / (freedom1 * complement);
}

VarianceComponents variance_components(const MeanSquares& squares) {
    const double between = squares.between, within = squares.within, n = squares.size;
    const int f1 = squares.between_freedom, f2 = squares.within_freedom;
    FETTLE_ASSERT(f1 >= 1 && f2 >= 1 && n >= 1 && between >= 0 && within >= 0, "mean squares with their degrees of freedom");
    const double upper = (1 + components_confidence) / 2, lower = 1 - upper;
    const auto variance = [&](double p) { return f1 * (between - f_quantile(f1, f2, p) * within) / (n * chi_square_quantile(f1, p)); };
    // With F / F_p = 1 + n B / W; no within at all: everything is shared.
    const auto share = [&](double divisor) {
        const double excess = std::max(0.0, between - divisor * within);
        return excess > 0 ? excess / (excess + n * divisor * within) : 0;
    };
    VarianceComponents out;
    out.between = {root((between - within) / n), root(variance(upper)), root(variance(lower))};
    out.share = {share(1), share(f_quantile(f1, f2, upper)), share(f_quantile(f1, f2, lower))};
    const double parts[] = {between / n, (n - 1) / n * within};
    const int freedoms[] = {f1, f2};
    double squared = 0;
    for (int i = 0; i < 2; ++i) {
        const double h = freedoms[i] / chi_square_quantile(freedoms[i], 1 - components_confidence) - 1;
        squared += h * h * parts[i] * parts[i];
    }
    out.total = std::max(root(parts[0] + parts[1]), root(within));
    out.total_bound = root(parts[0] + parts[1] + std::sqrt(squared));
    return out;
}

}  // namespace fettle::design::tolerances
