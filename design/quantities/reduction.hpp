// SPDX-License-Identifier: MIT
/// How the numbers of a motion's instants, the start and the steps' ends, become one: in this order the derivative in time, the window, and
/// what is taken `over` it. Every weight d(number)/dy_k is exact.
///
/// Where something is has a number at the start too: a position, an angle, a law, what a spring stores. How it moves and what acts on it
/// are a step's, the first of which ends at h: speeds, forces, efforts. Every reduction is of all the instants that have a number.
///
///     Reduction taken{Over::peak, 2};   the largest absolute second derivative ..
///     taken.from = 0.2;                 .. of the instants from 0.2 s on
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"
#include "design/quantities/extreme.hpp"

namespace fettle::design::quantities {

/// Numbers of the window's instants. The extremes are as in extreme.hpp: of what runs through the numbers, smooth in the parameters.
enum class Over {
    end,  ///< the last
    sum,
    mean,  ///< their sum over their number
    largest,
    least,
    peak,     ///< the largest absolute value: the greater of `largest` and -`least`, never negative
    rms,      ///< the root of the mean square
    integral  ///< in time, from `from` to `to`: of what is linear between the instants, and constant over the first step where none is at 0
};

struct Reduction {
    // Implicit: what is said of most series is the one word.
    Reduction(Over over = Over::end, int derivative = 0) : over(over), derivative(derivative) {}  // NOLINT(google-explicit-constructor)

    Over over;
    int derivative;                  ///< in time, 0 to 2: of the parabola through an instant and its neighbours (time_derivative)
    std::optional<double> from, to;  ///< the window: the instants within these times [s]; default: the whole motion
    std::optional<double> at;        ///< y at this time [s], linear between the instants

    /// Is nothing said but the derivative, so that it may stand for its numbers in a step_expression.hpp?
    bool is_plain() const { return over == Over::end && !from && !to && !at; }
    bool operator==(const Reduction&) const = default;
};

/// When the numbers y_0, y_1, .. are known: y_k at (first + k) timestep.
struct Instants {
    double timestep = 0;  ///< [s]
    int first = 0;        ///< 0: the start has a number; 1: the first step's end has the first
};

/// The dimension of the number, y's given; none: it has no unit.
std::optional<Dimension> dimension_of(const Reduction& reduction, Dimension of_instants);

/// `at` beside others; a derivative, time or window that the motion of so many steps does not have; no unit.
Errors check(const Reduction& reduction, Dimension of_instants, const Instants& instants, int steps);

/// y_k of the window: k in [first, second), of so many numbers. Contract: check() finds nothing.
std::pair<int, int> window_of(const Reduction& reduction, const Instants& instants, int count);

/// The extreme of a window's numbers that `largest`, `least` or `peak` is: sign * extreme.value, of the numbers sign * y; `peak` has no
/// sign.
struct SignedExtreme {
    Extreme extreme;
    double sign = 1;
};
/// All of the window's, that one first. Contract: one of these three; there is a number, and all are finite.
std::vector<SignedExtreme> extremes_of(Over over, const std::vector<double>& y);
SignedExtreme extreme_of(Over over, const std::vector<double>& y);
/// What it comes to, and its derivative in the window's numbers.
double value_of(Over over, const SignedExtreme& extreme);
std::vector<double> weights_of(Over over, const SignedExtreme& extreme, std::size_t count);
/// Is it one of these three?
inline bool is_extreme(Over over) { return over == Over::largest || over == Over::least || over == Over::peak; }

/// The number of y after the derivative. NaN where an instant that it depends on has no finite number. Contract: check() finds nothing.
double number_of(const Reduction& reduction, const std::vector<double>& y, const Instants& instants);
/// d(number_of)/dy_k.
std::vector<double> weights_of(const Reduction& reduction, const std::vector<double>& y, const Instants& instants);

/// The derivative in time, at each instant, of the parabola through it and its two neighbours; at the first and last one, of the parabola
/// through the first and last three. y has numbers or vectors; order 0 is y itself. Errors O(h^2), of the second derivative at the two ends
/// O(h). Contract: three instants, where the order is not 0.
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
