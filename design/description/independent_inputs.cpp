// SPDX-License-Identifier: MIT
#include "design/description/independent_inputs.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::description {

using tolerances::Moments;

namespace {

bool is_shared(const Tolerance& tolerance) { return !tolerance.group.empty() && tolerance.correlation != 0; }

Moments normal_moments(double mean, double variance) { return {mean, std::sqrt(variance), 0, 3 * variance * variance}; }

}  // namespace

IndependentInputs independent_inputs(const std::vector<Tolerance>& tolerances) {
    IndependentInputs out;
    for (const Tolerance& tolerance : tolerances)
        if (is_shared(tolerance) && std::find(out.groups.begin(), out.groups.end(), tolerance.group) == out.groups.end())
            out.groups.push_back(tolerance.group);
    const int n = count_of(tolerances), shared = count_of(out.groups);
    out.map = MatrixX::Zero(n, n + shared);
    for (int j = 0; j < n; ++j) {
        const Tolerance& tolerance = tolerances[j];
        const Moments all = moments_of(tolerance.deviation);
        out.map(j, j) = 1;
        if (!is_shared(tolerance)) {
            out.moments.push_back(all);
            continue;
        }
        FETTLE_ASSERT(tolerance.deviation.kind == tolerances::DistributionKind::normal, "deviations that are shared are normal");
        const double share = std::abs(tolerance.correlation), variance = all.standard_deviation * all.standard_deviation;
        out.moments.push_back(normal_moments(all.mean, (1 - share) * variance));
        const auto group = std::find(out.groups.begin(), out.groups.end(), tolerance.group) - out.groups.begin();
        out.map(j, n + group) = std::copysign(std::sqrt(share) * all.standard_deviation, tolerance.correlation);
    }
    for (int g = 0; g < shared; ++g) out.moments.push_back(normal_moments(0, 1));
    return out;
}

DeviationSamples::DeviationSamples(const std::vector<Tolerance>& tolerances, std::uint64_t seed)
    : tolerances_(tolerances), inputs_(independent_inputs(tolerances)), points_(inputs_.count(), seed) {}

VectorX DeviationSamples::at(int k) const {
    const VectorX u = points_.point(static_cast<std::uint32_t>(k));
    VectorX x(inputs_.count());
    for (int j = 0; j < inputs_.count(); ++j) {
        const bool is_own = j < count_of(tolerances_) && !is_shared(tolerances_[j]);
        x[j] = is_own ? quantile(tolerances_[j].deviation, u[j])
                      : inputs_.moments[j].mean + inputs_.moments[j].standard_deviation * tolerances::normal_quantile(u[j]);
    }
    return inputs_.map * x;
}

}  // namespace fettle::design::description
