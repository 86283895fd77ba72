// SPDX-License-Identifier: MIT
/// Models of the same mechanism that are smoother than the design's own: for optimisers to begin with.
///
/// Where contact is far narrower than the play of a fit, frictionless parts rattle in it: the function is smooth over microns only, and its
/// exact gradient misleads. With contact nearly as wide as the play the parts float in their fits, and the function is smooth. So: widths
/// from widest_share of the play, each half of the one before, down to the design's own, which alone is reported and certified.
#pragma once

#include <string>
#include <vector>

#include "fettle/design/problem/design_problem.hpp"

namespace fettle::design::problem {

inline constexpr double widest_share = 0.93;

struct SmootherDesign {
    std::string name;  ///< for people and the history: "contact 0.28 mm wide"
    double dhat = 0;   ///< [m]
    DesignProblem problem;
};

/// The play of the fits at p [m]: the median of the clearances as assembled, of the pairs of bodies that may collide and are closer than
/// fit_reach activation distances; 0 if there are none, or the parts cannot be made.
double play_of_fits(const DesignProblem& problem, const VectorX& p);
inline constexpr double fit_reach = 10;

/// The smoothest first; none where contact is as wide as the play already. A width that the scene as written cannot be built with is left
/// out.
std::vector<SmootherDesign> smoother_models(const DesignProblem& problem, const VectorX& p);

}  // namespace fettle::design::problem
