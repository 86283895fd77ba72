// SPDX-License-Identifier: MIT
/// What a simulation is asked and answers. Running one: simulate.hpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/solver/newton_workspace.hpp"
#include "core/stepper/balance.hpp"
#include "core/stepper/step_outputs.hpp"
#include "core/stepper/step_state.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

enum class SimulationStatus {
    ok,
    blocked,        ///< a prescribed body cannot follow its script: something is in the way
    not_held,       ///< quasi-static: loads push a body off, and nothing but the proximal term stands against them
    not_converged,  ///< a step's equations could not be solved
    energy_gained,  ///< more energy came from nowhere than was there and was supplied (is_of_nowhere): watched for with `outputs`, and of
                    ///< Newmark's steps always
    interrupted     ///< `should_stop` said so; the trajectory up to there is usable
};
const char* to_string(SimulationStatus status);

struct Progress {
    int step = 0;                               ///< steps done
    int steps = 0;                              ///< of how many
    const struct Simulation* so_far = nullptr;  ///< what there is by now: trajectory up to this step, last checkpoint
};

/// A simulation up to a step from which it goes on with the same bits.
struct Checkpoint {
    int step = 0;  ///< steps done
    StepState state;
};

/// Every so many steps nothing but the state is carried on (no search results), so that a run may be taken up there.
inline constexpr int checkpoint_interval = 32;

struct SimulationOptions {
    int steps = -1;                                ///< in all; negative: the model's end_time (1000 steps if that is not given)
    bool for_gradient = false;                     ///< solve each step to rounding level with the true Hessian (what the adjoint needs)
    bool outputs = false;                          ///< energies, momenta and forces of each step too
    bool last_outputs_only = false;                ///< they are kept of the last step alone: for an on_step that writes them as they come
    const struct Simulation* resume = nullptr;     ///< an earlier run of this model: goes on from its checkpoint, ends as one run would
    std::function<void(const Progress&)> on_step;  ///< optional
    std::function<bool()> should_stop;             ///< optional, asked often, on any thread
};

struct StepReport {
    int newton_iterations = 0;
    int friction_rounds = 0;
    int contacts = 0;             ///< active pairs at the end of the step
    double minimum_distance = 0;  ///< of the active pairs at the end of the step [m]; infinity if there are none
    double residual = 0;  ///< norm of the gradient of the incremental potential over the free DOFs, scaled (see newton.hpp): not of the
                          ///< last point where a short exact step ended the solve
    double proximal_share = 0;  ///< quasi-static: the largest that the proximal term carries of a body's load (energy/body_terms.hpp)
    double shift = 0;           ///< largest that made a Hessian of the step definite (solver/newton_direction.hpp); 0: none was needed
    double joint_gap = 0;       ///< how far joints are from being met at the step's end [m]
    double path_joint_gap = 0;  ///< bound on how far joints part between the nodes of the path (joint_outputs.hpp) [m]
};

struct SimulationReport {
    SimulationStatus status = SimulationStatus::ok;
    std::string message;  ///< names step, bodies, closest pair and cause when not ok
    std::vector<StepReport> steps;
    int newton_iterations = 0;
    double wall_seconds = 0;
    base::PhaseClock<solver::SolvePhase>::Seconds phase_seconds{};  ///< of the solver, by solver::SolvePhase
};

struct Simulation {
    Trajectory trajectory;
    SimulationReport report;
    std::vector<StepOutputs> outputs;  ///< per step, or of the last one alone, if asked for
    std::optional<Balance> balance;    ///< of these steps' energy and momentum, where they are watched; none in quasi-statics
    Checkpoint checkpoint;             ///< the last one passed
};

}  // namespace fettle::core::stepper
