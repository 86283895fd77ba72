// SPDX-License-Identifier: MIT
/// What runs through numbers y_0, y_1, .. at equal intervals: in each interval the cubic with the two numbers at its ends and slopes there,
///   d_k = 2 s_k-1 s_k/(s_k-1 + s_k)   where the slopes s_k = y_k+1 - y_k on both sides have one sign, else 0,
/// at the first and last number (3 s_0 - s_1)/2, brought to between 0 and 3 s_0 (Fritsch and Butland 1984; known as PCHIP). It rises where
/// the numbers rise and falls where they fall, so that it takes a value between two numbers once, and no value that lies between none;
/// its slope is continuous. Where the numbers are those of a smooth motion its error is O(h^3), and O(h^2) beside an extreme.
#pragma once

#include <array>
#include <vector>

namespace fettle::design::quantities {

/// The value at a place, and its derivatives.
struct Interpolated {
    double value = 0;
    double slope = 0;                           ///< d value / d place, per interval
    int first = 0;                              ///< index of the first of the four numbers; may be -1: there the weight is 0
    std::array<double, 4> weights{0, 0, 0, 0};  ///< d value / d y[first + k]; sum 1
};
/// @param place  Counted in intervals from the first number. Contract: 0 <= place <= y.size() - 1.
Interpolated interpolated(const std::vector<double>& y, double place);

/// Where what runs through the numbers goes from one side of 0 to the other.
struct Crossing {
    double place = 0;         ///< counted in intervals from the first number
    bool rises = true;        ///< to the positive side
    bool is_at_rest = false;  ///< two numbers or more lie on 0 in between, so that no place is the crossing's
};
/// In their order. A number that is within room_on_zero of 0 is on neither side: to begin there, to end there or to touch it is no
/// crossing. Contract: all are finite.
std::vector<Crossing> crossings_of_zero(const std::vector<double>& y);
/// 1e-9 of the numbers' range. Contract: not empty.
double room_on_zero(const std::vector<double>& y);

}  // namespace fettle::design::quantities
