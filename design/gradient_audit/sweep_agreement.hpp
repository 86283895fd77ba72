// SPDX-License-Identifier: MIT
/// The two ways to a derivative of a design's own simulation against each other: backwards, as gradients are made, and forwards
/// (adjoint/stepper/tangent_sweep.hpp), along random directions of what a model is made of. No simulation is needed.
#pragma once

#include <string>

#include "design/problem/design_problem.hpp"

namespace fettle::design::gradient_audit {

struct SweepAgreement {
    /// Largest |backwards - forwards| of all quantities and directions, relative to the larger of the two, and to no less than a hundredth
    /// of their parts' sum (by body and kind of number) and to a millionth of the change of the quantity if all bodies moved by their sizes
    /// and what joints and motors carry came and went. Infinity if either is no number.
    double disagreement = 0;
    std::string quantity;  ///< whose it is
    std::string failure;   ///< why nothing could be compared; empty: it could
};

/// Along vertices, start poses and velocities, densities, forces, gravity, friction and prescribed increments of all bodies together, twice
/// at random; the same on every run.
/// @param at  Evaluated with gradients.
SweepAgreement compare_sweeps(const problem::DesignProblem& problem, const problem::DesignEvaluation& at);

}  // namespace fettle::design::gradient_audit
