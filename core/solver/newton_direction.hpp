// SPDX-License-Identifier: MIT
/// The direction of one Newton iteration (newton.hpp): the step of the prescribed coordinates, that of the free ones given it,
///   dy_k = drive (target_k - y_k),   H_ff dy_f = -g_f - H_fk dy_k,
/// made definite where it must be, and shortened where it would carry bodies round the world.
#pragma once

#include <optional>
#include <vector>

#include "core/energy/incremental_potential.hpp"
#include "core/solver/newton_workspace.hpp"

namespace fettle::core::solver {

/// Where the solver stands.
struct Iterate {
    std::vector<kinematics::ChartPoint> points;
    std::vector<kinematics::Pose> poses;  ///< of `points`
    contact::ContactSet contacts;         ///< at `poses`
};

struct Direction {
    std::vector<Vector6> step;       ///< per body
    std::vector<Vector6> remaining;  ///< of the prescribed coordinates: target - y
    double remaining_norm = 0;       ///< l1, rotations times the body's radius [m]
    double drive = 1;                ///< share of what remains that the step takes
    double slope = 0;                ///< g . step
    double motion = 0;               ///< bound on the largest motion of a point of a body that is solved for [m]
    std::vector<double> unbalanced;  ///< per body: what is left of the forces on it at this point, as a share of their magnitudes
    double residual = 0;             ///< NewtonResult::residual, here
    double rounding = 0;             ///< of the potential's value here: what a difference of two values may be wrong by
    double shift = 0;                ///< added to the Hessian to make it definite, or by request, in units of the bodies' inertia; 0: none
    double inertia = 0;              ///< step . (inertia of each body) step: the curvature along the step is -slope over this
    contact::HessianKind kind = contact::HessianKind::exact;
};

/// Which Hessian is asked for.
struct HessianChoice {
    contact::HessianKind kind = contact::HessianKind::exact;
    std::optional<double> shift;  ///< at least this much of the inertia is added
    int exact_shifts = 1;         ///< how many are tried on the exact Hessian before the projected one is taken
};

/// @param hessian  the one to try first. Without a shift: where the exact one is not positive definite the projected one is taken; where
///                 that is not definite either (a body in unstable balance is left without stiffness in a direction; rounding), it is
///                 shifted by
///                   shift * (inertia of each body + 1e-10 |diagonal|),   shift = 1e-2, 1, 100, ...
///                 until it is. With one: exact + shift * (the same), the shift growing tenfold from the one asked for, then the projected
///                 one likewise. (Where inertia is negligible, the projected one is far too stiff along what slides: quasi-statics.)
/// @param targets  as for minimise.
/// @param drive    share of what remains of the prescribed coordinates to take, in [0, 1].
/// @return nullopt if gradient, Hessian or what follows from them are not finite: nothing else stops it.
std::optional<Direction> newton_direction(const energy::StepProblem& problem, const Iterate& at, const std::vector<Vector6>& targets,
                                          const HessianChoice& hessian, double drive, NewtonWorkspace& workspace);

/// points[body] + fraction * step; a whole step that takes all that remains puts the prescribed coordinates on their targets, bit for bit.
kinematics::ChartPoint moved(int body, const std::vector<kinematics::ChartPoint>& points, const Direction& direction, double fraction,
                             const std::vector<Vector6>& targets, const linear::FreeDofs& dofs);

/// NewtonResult::residual at this point.
double residual_at(const energy::StepProblem& problem, const Iterate& at, NewtonWorkspace& workspace);

/// Bound on how far points of the body move with this step of its coordinates [m].
double motion_of(const model::Body& body, const Vector6& step);

/// What is left to solve at a point, by first derivatives alone.
struct Remainder {
    std::vector<double> motion;      ///< [k] bound on the motion of the points of bodies[k] in the step that it would make if its inertia
                                     ///< were all that stands against what is left of the forces: other stiffness makes it shorter [m];
                                     ///< infinity without inertia, 0 where nothing is free
    std::vector<double> unbalanced;  ///< [k] Direction::unbalanced, here
    double residual = 0;             ///< NewtonResult::residual
};
Remainder remainder_at(const energy::StepProblem& problem, const Iterate& at, const std::vector<int>& bodies, NewtonWorkspace& workspace);

}  // namespace fettle::core::solver
