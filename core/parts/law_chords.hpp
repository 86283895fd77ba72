// SPDX-License-Identifier: MIT
/// How far the curve of a law leaves its chords, proven: the law is evaluated on ranges of its parameter (range.hpp), which are cut until
/// the bound is near to what samples find.
///
/// For a curve c over a step of length h, with c'' where it exists, jumps J of c' and places of the length w -> 0 where c is only known to
/// within G,
///     |c - chord|  <=  max |c''| h^2 / 8 + sum |J| h / 4 + max G.
/// Source: the remainder of linear interpolation; its kernel is at most h / 4 and has the integral h^2 / 8 at most.
#pragma once

#include "core/parts/curve.hpp"

namespace fettle::core::parts {

struct ChordDeviation {
    double distance = 0;  ///< infinity: it could not be bounded
    int side = 0;         ///< 1, -1: the curve turns left, right all along as its parameter rises, and is on one side of its chords
};

/// The deviation of the chords of `count` even steps between the two parameters. Contract: low < high, count > 0.
ChordDeviation chord_deviation(const Law& law, double low, double high, int count);

}  // namespace fettle::core::parts
