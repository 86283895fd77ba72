// SPDX-License-Identifier: MIT
/// What an optimiser sees of a design: a smooth function with bounds and constraints, each evaluation of which is expensive and can fail.
/// No physics here, so that optimisers are tested on problems with known answers. Made from a design by design_problem.hpp.
///   minimise f(x)   subject to   lower <= x <= upper,   constraint_lower <= c(x) <= constraint_upper,
///                                relation_lower <= r(x) <= relation_upper
/// r and what `refusal` says are cheap, and known before f and c are.
#pragma once

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::optimisers {

/// Branches of functions that are the least or the greatest of several smooth ones: those near the one that is taken (its branches),
/// linearised. To first order the function is their least (or greatest) at any point near.
struct Branches {
    std::vector<int> of;  ///< k: which function each belongs to; those of one stand together
    VectorX values;       ///< k
    MatrixX jacobian;     ///< k x n
};

/// f, c and their derivatives at one point; or the reason why there are none. Plain values: it is what the history keeps.
struct Evaluation {
    bool usable = false;  ///< false: the point cannot be evaluated (not buildable, blocked ...); then only `reason` means anything
    std::string reason;
    double objective = 0;  ///< f
    VectorX gradient;      ///< n
    VectorX constraints;   ///< c, m
    MatrixX jacobian;      ///< dc/dx, m x n
    VectorX measured;      ///< m, of what c stands for, for people, where c goes on beyond it (description::Continuation); empty: it is c
    /// f's squared deviations r_i^2 are part of it (each with its weight's root in it): r and dr/dx. Empty where f has none.
    VectorX residuals;
    MatrixX residual_jacobian;
    /// Branches of constraints that are the least of several (clearances, by their witnesses), c_i <= values(k) for k of i, or the greatest
    /// (Problem::is_greatest), c_i >= values(k): the other branches, c_i and its gradient being the first. Only of those that have a lower
    /// bound, or, of the greatest, an upper one.
    Branches constraint_branches;
    /// Branches of the terms of f that are the greatest of several (a clearance to be made large), by their numbers: all branches, first
    /// the one whose value and gradient are part of f and `gradient`.
    Branches objective_branches;
    /// false: values alone were asked for (Problem::values); gradient, jacobian, residuals and branches are empty.
    bool has_derivatives = true;
    double violation = 0;  ///< largest violation of the true requirements, relations too, in their own scale (constraint.hpp); 0: feasible
};

/// Values that cost nothing, at one point: relations between the variables alone, constraints of the parts as assembled.
struct Rows {
    VectorX values;    ///< k
    MatrixX jacobian;  ///< k x n
};

/// A model of the same thing that is smoother than the one asked for: optimisers begin there.
struct SmootherModel {
    std::string name;  ///< for people
    std::function<Evaluation(const VectorX&)> evaluate;
    std::function<Evaluation(const VectorX&)> values = {};  ///< as Problem::values
};

struct Problem {
    VectorX start, lower, upper;  ///< n; finite, lower <= start <= upper
    /// n: whether all is the same at `lower` and `upper` of a variable, an angle's, so that neither is a wall; empty: none are so.
    std::vector<bool> periodic = {};
    VectorX constraint_lower, constraint_upper;  ///< m; what the optimiser aims at; infinite where there is none
    std::vector<bool> is_greatest = {};          ///< m: a constraint's branches are those of a value that is the greatest; empty: of none
    VectorX relation_lower, relation_upper;      ///< k; what the optimiser aims at; infinite where there is none
    VectorX constraint_margin, relation_margin;  ///< m, k: by how much these lie inside of what is required; empty: they are that
    std::function<Evaluation(const VectorX&)> evaluate;
    /// Optional: the same numbers without derivatives, for less. An optimiser that uses none is not charged for them.
    std::function<Evaluation(const VectorX&)> values;
    double objective_floor =
        -std::numeric_limits<double>::infinity();  ///< f is known not to be below it: a start that attains it is the end
    std::vector<SmootherModel> smoother;           ///< the smoothest first; empty: none
    /// Optional: the nearest point that meets all that can be known without a simulation, as far as it was found. Starts are moved there.
    std::function<VectorX(const VectorX&)> prepared;
    std::function<Rows(const VectorX&)> relations;  ///< pure and cheap; null where k = 0. Numbers that are not finite: no such point
    /// Optional: why `evaluate` would fail at a point (a part that cannot be made, parts that intersect), without the cost of an
    /// evaluation; empty: nothing known against it. Pure, so that a driver can shorten its step first.
    std::function<std::string(const VectorX&)> refusal;
    /// Optional: the nearest point that can be written down exactly (to a few units of rounding), the one that is evaluated in its place.
    std::function<VectorX(const VectorX&)> representable;
};

/// Thrown by Problem::evaluate when the user interrupts: the point is neither good nor bad, and is not recorded.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace fettle::design::optimisers
