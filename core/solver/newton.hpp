// SPDX-License-Identifier: MIT
/// Projected Newton for one time step, with curved CCD in its line search: every accepted point, and the path to it, is free of
/// intersections. docs/method/solver.md.
///
/// Prescribed coordinates are equality constraints y_k = target, met exactly at the solution, or to 1e-9 of the scene's size where
/// contact leaves no more (they stall, or what remains is all the gap there is). Each iteration moves them by the remainder, and the free
/// ones by the Newton step given that motion: dy_f = -H_ff^-1 (g_f + H_fk dy_k); by a share of what remains where contact stops larger
/// ones. The step length is the longest that CCD allows, then backtracked on the exact penalty E + nu |remaining| (Nocedal and Wright,
/// Numerical Optimization, section 18.4). The exact Hessian is used wherever it is positive definite, the projected one elsewhere, shifted
/// by a multiple of the inertia where that is not definite either: a matrix of finite numbers is always factorised.
///
/// A step's error must be the integrator's, not the solver's: what is left after each solve is a velocity that adds up over the steps, and
/// a force that no one exerts. So `accuracy` asks that no more than a small share of the forces on each body is left unbalanced
/// (Direction::unbalanced), where the solve stands, or predicted for the end of the next whole Newton step: Newton's error is squared, in
/// units of the least gap, of the slip that friction sticks by, or of the body.
///
/// Friction is solved in rounds: normal forces and tangents of the start, then of the round before (model::Friction::rounds). With
/// friction in play, of contacts or of joints, velocities are resolved to a tenth of eps_v whatever the scene's tolerance: it is eps_v that
/// distinguishes sticking from sliding. A step of bodies that slide begins where they coast to (coasting.hpp).
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/energy/incremental_potential.hpp"
#include "core/solver/newton_workspace.hpp"

namespace fettle::core::solver {

enum class NewtonStatus { converged, blocked, not_held, not_converged, interrupted };

struct NewtonOptions {
    double velocity_tolerance = 0;  ///< stop when the next step moves no point faster than this [m/s]
    double accuracy = 0;            ///< and, if > 0, when no more than this share of the forces on any body is left unbalanced
    int max_iterations = 3000;
    bool keep_rounds = false;  ///< of friction: where each one ends. With caution they go on until the ends of two agree to rounding
    bool to_rounding = false;  ///< go on with exact steps until the residual is at rounding level: "converged" has at most 1e-8
    double caution =
        0;  ///< > 0: begin with this shift of the Hessian in units of the inertia, and let it fall as steps do what they promise
    std::vector<kinematics::ChartPoint> start;                     ///< where to begin; empty: where the step starts
    double farthest = std::numeric_limits<double>::infinity();     ///< a free body that goes this far from the step's start [m], or turns
    double widest_turn = std::numeric_limits<double>::infinity();  ///< as much as this [rad], is not held by anything
    std::function<bool()> should_stop;
};

struct NewtonResult {
    NewtonStatus status = NewtonStatus::converged;
    std::string message;                                    ///< cause, with body names, when not converged
    std::vector<std::vector<kinematics::ChartPoint>> path;  ///< where it began and every accepted point
    std::vector<kinematics::Pose> poses;                    ///< at the end of the path
    int iterations = 0;
    int friction_rounds = 0;
    std::vector<std::vector<kinematics::ChartPoint>> round_ends;  ///< of friction, if they are to be kept
    std::vector<KnownContacts> round_contacts;                    ///< there
    contact::ContactSet contacts;                                 ///< at the end of the path
    contact::FrictionSet friction;                                ///< of the last round: what the solution was solved with
    VectorX multipliers;                                          ///< per row of the mechanism, of the potential times its weight
    double shift = 0;     ///< largest that made a Hessian definite, in units of the bodies' inertia (newton_direction.hpp); 0: none needed
    double residual = 0;  ///< where derivatives were taken last: |gradient over free DOFs| (rotations divided by the body's radius) / sum
                          ///< of the forces' magnitudes
};

/// How far bodies may leave a search's segments before they need another: what lets later, shorter steps do
/// without, [m].
double candidate_allowance(const model::Model& model);

/// @param problem  its friction is lagged here, and left in the result: the problem has none after
/// @param targets  per body: chart coordinates (q, theta) of the prescribed DOFs at the end of the step (free entries are ignored).
NewtonResult minimise(energy::StepProblem& problem, const std::vector<Vector6>& targets, NewtonWorkspace& workspace,
                      const NewtonOptions& options);

}  // namespace fettle::core::solver
