// SPDX-License-Identifier: MIT
/// Which designs within the bounds can be made at all: found by building models, before anything is simulated.
#pragma once

#include <string>
#include <vector>

#include "design/problem/design_problem.hpp"

namespace fettle::design::problem {

/// How far one parameter can be moved.
struct Reach {
    double value = 0;  ///< SI; the end itself, or, to 1e-3 of the way, where designs stop being buildable
    Errors obstacles;  ///< right behind it; none: all the way can be built, as far as was tried
};

/// Are there shapes that cost much to make (Shape::is_costly)?
bool has_costly_shapes(const description::Design& design);

/// Moves one parameter from p towards `end`, the others as in p, and tries designs at each quarter of the way (at its end alone where parts
/// are costly to make, Shape::is_costly) and, once one cannot be built, where that begins. Contract: p can be built.
Reach reach(const DesignProblem& problem, const VectorX& p, int parameter, double end);

/// An end of a parameter's range that cannot be reached from the start.
struct UnreachableBound {
    int parameter = 0;
    double bound = 0;  ///< SI
    Reach reach;
};

/// What keeps several designs from being made.
struct Obstacle {
    std::string where;  ///< body and dimension, or pair of bodies
    int designs = 0;
    Error example;
};

struct BoundsReport {
    std::vector<UnreachableBound> unreachable;  ///< by parameter, lower bound first
    int samples = 0, refused = 0;               ///< designs spread over the bounds, and how many of them cannot be made
    std::vector<Obstacle> obstacles;            ///< of those, the commonest first
};

/// Tries the designs that differ from the start in one parameter, on the way to each end of its bounds, and samples of all parameters
/// together (8 per parameter, at most 64, the same ones on every run: core/base/kronecker.hpp).
/// What an inequality between parameters excludes is not tried: it is no trap if the design says so itself. For parts that are costly to
/// make (Shape::is_costly) the ends themselves are tried, and 2 samples per parameter. Empty if the start itself cannot be built: its
/// evaluation says why.
BoundsReport try_bounds(const DesignProblem& problem);

/// The commonest first; of as many the first one met first.
std::vector<Obstacle> tally(const std::vector<Errors>& designs);

/// A line for each finding, for people; empty if everything that was tried can be made.
std::vector<std::string> described(const description::Design& design, const BoundsReport& report);
/// "body crank: crank/disc_radius: disc_radius is ..."
std::string described(const Error& error);

}  // namespace fettle::design::problem
