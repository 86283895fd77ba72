// SPDX-License-Identifier: MIT
/// A convex quadratic programme whose rows may be violated at a price, so that it always has a solution:
///   minimise g.d + 1/2 d.H d + penalty sum_i v_i   subject to   box_lower <= d <= box_upper,
///   v_i = max(0, lower_i - (A d)_i, (A d)_i - upper_i)
/// A row whose value is the least of several functions has cuts C_j d >= cut_lower_j beside it, all under the same v_i (their lower
/// side's):
///   v_i = max(0, lower_i - (A d)_i, max_j (cut_lower_j - (C d)_j)) + max(0, (A d)_i - upper_i)
/// A function that is the greatest of several adds its kink u_t = max(0, max_j (cut_lower_j - (C d)_j)) to what is minimised.
/// Solved by Ipopt (Waechter and Biegler 2006), to 1e-9 of the numbers in it; n and m are tens.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::optimisers {

struct Cuts {
    MatrixX rows;         ///< C, k x n
    VectorX lower;        ///< k, finite
    std::vector<int> of;  ///< k: i >= 0: of row i, whose lower side is finite; -1 - t: of kink t
};

struct QuadraticProgram {
    VectorX gradient;              ///< g, n
    MatrixX hessian;               ///< H, n x n, positive semi-definite
    MatrixX rows;                  ///< A, m x n
    VectorX lower, upper;          ///< m; infinite where there is none
    VectorX box_lower, box_upper;  ///< n; finite, box_lower <= 0 <= box_upper
    double penalty = 1;            ///< > 0
    Cuts cuts = {};                ///< none, unless told otherwise
};

struct QuadraticSolution {
    bool solved = false;  ///< false: Ipopt failed, a number is not finite, or the box is a point; then nothing else means anything
    VectorX step;         ///< d
    VectorX multipliers;  ///< y, m: g + H d = A^T y + z (without cuts); y_i > 0 where the lower side holds, < 0 where the upper does, |y_i|
                          ///< <= penalty
    std::vector<int> cut_of;  ///< k: Cuts::of
    VectorX cut_multipliers;  ///< k, >= 0: g + H d = A^T y + C^T w + z; of one row (or kink) and its cuts the sum is at most its price
    VectorX box_multipliers;  ///< z, n: what the box has to hold, > 0 at its lower side, < 0 at its upper
    double violation = 0;     ///< sum_i v_i at d
    double kinks = 0;         ///< sum_t u_t at d
    double decrease = 0;      ///< of the function to be minimised, from d = 0; at least 0
};

/// Deterministic. Only one of several threads computes at a time (run_ipopt).
QuadraticSolution solve(const QuadraticProgram& program);

/// sum_i v_i of rows with these values.
double row_violation(const VectorX& values, const VectorX& lower, const VectorX& upper);

}  // namespace fettle::design::optimisers
