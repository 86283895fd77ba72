// SPDX-License-Identifier: MIT
/// The largest of numbers y_i at equal intervals, as the largest of what runs through them: closer to the truth than the largest number
/// itself, and smooth in the parameters where that jumps from one step's to the next's.
///
/// With y_0 the largest of the numbers, a = y_0 - y_-1 and b = y_0 - y_1 what it is above its neighbours, and the bends
/// c_k = 2 y_k - y_k-1 - y_k+1, the value is y_0 + v P + (1 - v) K.
///
/// - **A bend that the steps resolve**: P = (a - b)^2/(8 c_0), that of the parabola through the three. Its error for a cosine is at most
///   3 (omega h)^4/128 of the amplitude, where that of y_0 is (omega h)^2/8.
/// - **A steady rise that ends in a cliff**, as of a latch that lets go. A parabola is wrong there by up to an eighth of the first
///   interval's fall. K is where the straight lines of either side meet in the interval after y_0, a c_1/(c_0 + c_1), or before it,
///   b c_-1/(c_0 + c_-1): exact if both sides are straight.
/// - **Neither**, such as a single number above others, or a jump: P and K fade to 0, and y_0 is left. A line from either side would reach
///   `doubt`, min(a, b), above it before the next number; it too fades where one of the two above holds.
///
/// v fades from 1, where both neighbours bend at least half as much as y_0, to 0, where one does not bend. K fades to 0 where the lesser of
/// the slopes that meet is 0.1 to 0.3 of their difference (four to a wave are no cliff), and where the number on the far side bends too.
/// The second neighbours of a number next to an end are missing: then v is that of the others, and K is 0.
#pragma once

#include <array>
#include <vector>

namespace fettle::design::quantities {

/// An extreme, and its derivative in up to five consecutive numbers.
struct Extreme {
    double value = 0;
    int first = 0;                                 ///< index of the first of the five; may be -1 or -2: there the weights are 0
    std::array<double, 5> weights{0, 0, 0, 0, 0};  ///< d value / d y[first + k]; sum 1
    double doubt = 0;                              ///< how much larger it may be between the numbers, which do not show it
};
/// The largest values of the sequence in the sense above, one for each number that those beside it are below (the first of equal ones); at
/// the first or last number, the number itself. The largest comes first, of equal ones the earliest. Contract: not empty.
std::vector<Extreme> smooth_maxima(const std::vector<double>& y);
/// The first of them. It has a kink where another one becomes larger.
Extreme smooth_maximum(const std::vector<double>& y);

}  // namespace fettle::design::quantities
