// SPDX-License-Identifier: MIT
/// A robust design: one some of whose numbers are asked for over its tolerances. Beside the design as drawn stands the same one as made,
/// which has a parameter for each number with a tolerance; from its derivatives in these follow the reserves (over_tolerances.hpp).
#pragma once

#include <functional>
#include <vector>

#include "design/description/design.hpp"
#include "design/description/tolerance.hpp"
#include "design/tolerances/robust_offset.hpp"

namespace fettle::design::description {

/// Mean, covariance and limits of the deviations, one per tolerance.
struct Deviations {
    VectorX mean, lower, upper;
    MatrixX covariance;

    VectorX standard_deviations() const { return covariance.diagonal().cwiseSqrt(); }
};
Deviations deviations_of(const std::vector<Tolerance>& tolerances);

/// @param side  1: for an upper bound, and a number that is minimised; -1: for a lower bound, and one that is maximised.
tolerances::RobustOffset offset_of(const OverTolerances& over, const VectorX& gradient, const Deviations& deviations, int side);

struct MadeDesign {
    /// Its parameters: those of the design as drawn, in their order, then those that tolerances alone have. Its constraints: the same ones,
    /// then one without bounds for each term of the objective that is asked for over the tolerances, in their order. It has no relations.
    Design design;
    std::vector<Tolerance> tolerances;
    Deviations deviations;

    /// The parameters as made, without a deviation, of parameters as drawn.
    VectorX extended(const VectorX& drawn) const;
    /// What of a gradient in the parameters as made is in the deviations.
    VectorX by_deviation(const VectorX& gradient) const;
    /// The change of the parameters as made with these deviations.
    VectorX moved_by(const VectorX& deviations) const;
};

bool asks_over_tolerances(const Design& design);

/// The side that a bound over tolerances has. Contract: one of the two is finite.
int side_of(const Bounds& bounds);

/// The design as drawn, with itself as made. A requirement over the tolerances that has two bounds becomes two, "name, at least" and "name,
/// at most": they are about different numbers. A relation becomes one with its reserve, whose derivative is exact up to that of central
/// differences of exact gradients.
/// Contract: both are the same design but for the parameters that tolerances alone have; no bounds over tolerances are an equation.
Design over_tolerances(Design drawn, Design as_made, std::vector<Tolerance> tolerances);

/// The same change to all scenes of the design: its own, its scenarios', and those of the design as made.
void change_scenes(Design& design, const std::function<void(core::scene::Scene&)>& change);

}  // namespace fettle::design::description
