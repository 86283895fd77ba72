// SPDX-License-Identifier: MIT
/// A derivative along one line, judged by central differences and by the slope of Taylor's remainder
///   R(h) = f(h) - f(0) - h g,   g the derivative to be judged,
/// over two decades of steps in which the function's second-order term can be seen to stand alone. What differences are taken, and which
/// decades, follows from the function: the derivative to be judged has no part in it, so that no choice can hide a wrong one.
#pragma once

#include <functional>

namespace fettle::tests::support {

/// Step sizes h tried, to both sides: largest, largest 10^(-1/4), ... for so many decades.
struct LineSweep {
    double largest = 1e-1;
    int decades = 7;
};

struct LineCheck {
    double difference = 0;      ///< f'(0): central differences, extrapolated (Ridders 1982), the best by their own estimate
    double relative_error = 0;  ///< |g - difference| / max(|g|, |difference|); infinity if there is none
    /// Is there a range of two decades over which E(h) = (f(h) + f(-h))/2 - f(0) is h^2 times the same number to 10 %, and
    /// (f(h) - f(-h))/2 - h difference at most a fifth of it? The one of the smallest steps is taken, which sees the least error of g.
    bool tells = false;
    double smallest = 0, largest = 0;  ///< its ends
    double slope = 0;                  ///< of ln |R| over ln |h| in it: of the side where it is farther from 2

    /// What a right derivative passes.
    bool is_right() const { return relative_error < 5e-7 && (!tells || (slope > 1.9 && slope < 2.1)); }
};

/// @param change  h -> f(h) - f(0), best without the cancellation of a difference of two values; not finite where there is no f(h).
LineCheck check_line(const std::function<double(double)>& change, double derivative, const LineSweep& sweep = {});

}  // namespace fettle::tests::support
