// SPDX-License-Identifier: MIT
/// How the numbers y_1 .. y_T at the steps' ends, at the times h, 2h, .. Th, become one: in this order the derivative in time, the window,
/// and what is taken `over` it. Every weight d(number)/dy_t is exact.
///
///     Reduction taken{Over::peak, 2};   the largest absolute second derivative ..
///     taken.from = 0.2;                 .. of the steps that end at 0.2 s or later
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"
#include "fettle/core/base/units.hpp"
#include "fettle/design/quantities/extreme.hpp"

namespace fettle::design::quantities {

/// Of the window's steps. The extremes are those of extreme.hpp: of what runs through the steps' numbers, smooth in the parameters.
enum class Over {
    end,  ///< the last
    sum,
    mean,  ///< their sum over their number
    largest,
    least,
    peak,     ///< the largest absolute value: the greater of `largest` and -`least`, never negative
    rms,      ///< the root of the mean square
    integral  ///< in time, from `from` to `to`: of what is linear between the steps' ends, and before the first one constant
};

struct Reduction {
    // Implicit: what is said of most series is the one word.
    Reduction(Over over = Over::end, int derivative = 0) : over(over), derivative(derivative) {}  // NOLINT(google-explicit-constructor)

    Over over;
    int derivative;                  ///< in time, 0 to 2: of the parabola through a step and its neighbours (time_derivative)
    std::optional<double> from, to;  ///< the window: the steps that end within these times [s]; default: the whole motion
    std::optional<double> at;        ///< y at this time [s], linear between the steps' ends; before the first one y_1

    /// Is nothing said but the derivative, so that it may stand for its steps in a step_expression.hpp?
    bool is_plain() const { return over == Over::end && !from && !to && !at; }
    bool operator==(const Reduction&) const = default;
};

/// The dimension of the number, y's given; none: it has no unit.
std::optional<Dimension> dimension_of(const Reduction& reduction, Dimension of_steps);

/// `at` beside others; a derivative, time or window that the motion of so many steps of `timestep` [s] does not have; no unit.
Errors check(const Reduction& reduction, Dimension of_steps, double timestep, int steps);

/// Steps [first, second) of the window, counted from 0. Contract: check() finds nothing.
std::pair<int, int> window_of(const Reduction& reduction, double timestep, int steps);

/// The extreme of a window's steps that `largest`, `least` or `peak` is: sign * extreme.value, of the numbers sign * y; `peak` has no sign.
struct SignedExtreme {
    Extreme extreme;
    double sign = 1;
};
/// Contract: one of these three; there is a step, and all are finite.
SignedExtreme extreme_of(Over over, const std::vector<double>& y);
/// Is it one of these three?
inline bool is_extreme(Over over) { return over == Over::largest || over == Over::least || over == Over::peak; }

/// Of y after the derivative. NaN where a step that it depends on has no finite number. Contract: check() finds nothing.
double number_of(const Reduction& reduction, const std::vector<double>& y, double timestep);
/// d(number_of)/dy_t.
std::vector<double> weights_of(const Reduction& reduction, const std::vector<double>& y, double timestep);

/// The derivative in time, at each step's end, of the parabola through it and its two neighbours; at the first and last step, of the
/// parabola through the first and last three. Of numbers or vectors; of order 0 y itself. Errors O(h^2), of the second derivative at the
/// two ends O(h). Contract: three steps, where the order is not 0.
template <class T>
std::vector<T> time_derivative(const std::vector<T>& y, double timestep, int order) {
    if (order == 0) return y;
    std::vector<T> out;
    out.reserve(y.size());
    for (std::size_t k = 0; k < y.size(); ++k) {
        const std::size_t i = std::min(std::max<std::size_t>(k, 1), y.size() - 2);
        const T bend = (y[i + 1] - 2 * y[i] + y[i - 1]) / (timestep * timestep);
        if (order == 2) {
            out.push_back(bend);
            continue;
        }
        const double away = timestep * (static_cast<double>(k) - static_cast<double>(i));
        out.push_back((y[i + 1] - y[i - 1]) / (2 * timestep) + away * bend);
    }
    return out;
}

/// Its transpose: the weights of y, given those of the derivative.
template <class T>
std::vector<T> time_derivative_adjoint(const std::vector<T>& bar, double timestep, int order) {
    if (order == 0) return bar;
    std::vector<T> out(bar.size(), T(0 * bar.front()));
    for (std::size_t k = 0; k < bar.size(); ++k) {
        const std::size_t i = std::min(std::max<std::size_t>(k, 1), bar.size() - 2);
        const double away = timestep * (static_cast<double>(k) - static_cast<double>(i));
        const T bend = (order == 2 ? 1.0 : away) / (timestep * timestep) * bar[k];
        const T slope = (order == 2 ? 0.0 : 1.0) / (2 * timestep) * bar[k];
        out[i + 1] += bend + slope;
        out[i] -= 2 * bend;
        out[i - 1] += bend - slope;
    }
    return out;
}

}  // namespace fettle::design::quantities
