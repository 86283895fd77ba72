// SPDX-License-Identifier: MIT
/// Reference motions of tests that have no closed form: ordinary differential equations, integrated apart from fettle.
#pragma once

#include <functional>
#include <vector>

namespace fettle::tests::support {

using State = std::vector<double>;
using Rates = std::function<State(const State&)>;

/// The state after `time`, by Runge's and Kutta's classical method of fourth order.
/// @param steps  for motions of mechanisms in a second, 40000 are exact to 1e-10
inline State integrated(State y, const Rates& rates, double time, int steps = 40000) {
    const double h = time / steps;
    const auto on = [](const State& from, double factor, const State& along) {
        State out = from;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += factor * along[i];
        return out;
    };
    for (int t = 0; t < steps; ++t) {
        const State a = rates(y), b = rates(on(y, h / 2, a)), c = rates(on(y, h / 2, b)), d = rates(on(y, h, c));
        for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    }
    return y;
}

}  // namespace fettle::tests::support
