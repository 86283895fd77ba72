// SPDX-License-Identifier: MIT
/// Models of the same mechanism that are smoother than the design's own: for optimisers to begin with, and to be compared with in the end.
///
/// Where contact is far narrower than the play of a fit, frictionless parts rattle in it: the function is smooth over microns only, and its
/// exact gradient misleads. With contact nearly as wide as the play the parts float in their fits, and the function is smooth. So: widths
/// from widest_share of the play, each half of the one before, down to the design's own, which alone is reported and certified.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/problem/design_problem.hpp"
#include "design/problem/fits.hpp"

namespace fettle::design::problem {

inline constexpr double widest_share = 0.93;

struct SmootherDesign {
    std::string name;  ///< for people and the history: "contact 0.28 mm wide"
    double dhat = 0;   ///< [m]
    DesignProblem problem;
};

/// The play that contact is to be as wide as at p [m]: the median of the clearances as assembled, of the pairs of bodies that may collide
/// and are closer than fit_reach activation distances, fits or not; 0 if there are none, or the parts cannot be made.
double play_of_fits(const DesignProblem& problem, const VectorX& p);

/// The smoothest first, of facets as they are; none where contact is as wide as the play already. A width that the scene as written cannot
/// be built with is left out.
std::vector<SmootherDesign> smoother_models(const DesignProblem& problem, const VectorX& p);

/// The model in which the play of a design's fits (fits.hpp) is taken up: contact of the same kind as the design's own, nearly as wide as
/// the play at these parameters, so that parts stay in the middle of their fits. It shows the effect of the play where nothing else has
/// wider contact that matters: not where a contact that is none of a fit's carries a load, nor where it would reach across parts that are
/// near.
struct PlayTakenUp {
    std::optional<SmootherDesign> model;  ///< none: there is no fit, contact is as wide as the play already, or:
    std::string why_not = {};             ///< a sentence without its full stop: why there is none, though there are fits
};
/// @param at  Evaluated, usable.
PlayTakenUp play_taken_up(const DesignProblem& problem, const DesignEvaluation& at);

}  // namespace fettle::design::problem
