// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/step_series.hpp"

#include <numeric>

#include "fettle/core/base/contract.hpp"
#include "fettle/design/quantities/stroke.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

namespace {

std::vector<double> negated(std::vector<double> y) {
    for (double& v : y) v = -v;
    return y;
}

// The greatest of y, of -y, or of both.
struct SignedExtreme {
    Extreme extreme;
    double sign = 1;

    double value() const { return sign * extreme.value; }
};

SignedExtreme extreme_of(Over over, const std::vector<double>& y) {
    const Extreme up = over == Over::least ? Extreme{} : smooth_maximum(y),
                  down = over == Over::largest ? Extreme{} : smooth_maximum(negated(y));
    return over == Over::largest || (over == Over::peak && up.value >= down.value) ? SignedExtreme{up, 1} : SignedExtreme{down, -1};
}

bool is_extreme(Over over) { return over == Over::largest || over == Over::least || over == Over::peak; }

double number(Over over, const std::vector<double>& y) {
    FETTLE_ASSERT(!y.empty(), "a number of each step needs a step");
    const double sum = std::accumulate(y.begin(), y.end(), 0.0);
    switch (over) {
        case Over::end:
            return y.back();
        case Over::sum:
            return sum;
        case Over::mean:
            return sum / static_cast<double>(y.size());
        case Over::largest:
        case Over::least:
            return extreme_of(over, y).value();
        case Over::peak:
            return extreme_of(over, y).extreme.value;
    }
    return 0;
}

std::vector<double> weights_of(Over over, const std::vector<double>& y) {
    std::vector<double> out(y.size(), over == Over::sum ? 1.0 : over == Over::mean ? 1 / static_cast<double>(y.size()) : 0.0);
    if (over == Over::end) out.back() = 1;
    if (!is_extreme(over)) return out;
    const auto [extreme, sign] = extreme_of(over, y);
    for (size_t k = 0; k < 3; ++k)
        if (extreme.weights[k] != 0)
            out[static_cast<size_t>(extreme.first) + k] = over == Over::peak ? sign * extreme.weights[k] : extreme.weights[k];
    return out;
}

}  // namespace

Measurement StepSeries::value(const Simulated& simulated) const { return description::computed(number(over_, series(simulated))); }

void StepSeries::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    std::vector<double> weights = weights_of(over_, series(simulated));
    for (double& weight : weights) weight *= scale;
    add_series_seeds(simulated, weights, seeds);
}

Errors StepSeries::check(const core::model::Model&, int steps) const {
    if (steps >= 1) return {};
    return {{ErrorCode::out_of_range, "", "what a step reports needs a step"}};
}

}  // namespace fettle::design::quantities
