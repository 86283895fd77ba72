// SPDX-License-Identifier: MIT
/// What an optimiser sees of a design: a smooth function with bounds and constraints, each evaluation of which is expensive and can fail.
/// No physics here, so that optimisers are tested on problems with known answers. Made from a design by design_problem.hpp.
///   minimise f(x)   subject to   lower <= x <= upper,   constraint_lower <= c(x) <= constraint_upper
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "fettle/core/base/types.hpp"

namespace fettle::design::optimisers {

/// f, c and their derivatives at one point; or the reason why there are none. Plain values: it is what the history keeps.
struct Evaluation {
    bool usable = false;  ///< false: the point cannot be evaluated (not buildable, blocked ...); then only `reason` means anything
    std::string reason;
    double objective = 0;  ///< f
    VectorX gradient;      ///< n
    VectorX constraints;   ///< c, m
    MatrixX jacobian;      ///< dc/dx, m x n
    double violation = 0;  ///< largest violation of the true requirements, in their own scale (constraint.hpp); 0: feasible
};

struct Problem {
    VectorX start, lower, upper;                 ///< n; finite, lower <= start <= upper
    VectorX constraint_lower, constraint_upper;  ///< m; what the optimiser aims at; infinite where there is none
    std::function<Evaluation(const VectorX&)> evaluate;
    /// Optional: the nearest point that can be written down exactly (to a few units of rounding), the one that is evaluated in its place.
    std::function<VectorX(const VectorX&)> representable;
};

/// Thrown by Problem::evaluate when the user interrupts: the point is neither good nor bad, and is not recorded.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace fettle::design::optimisers
