// SPDX-License-Identifier: MIT
/// The constants of a step while its incremental potential is minimised, and the coordinates that it is minimised over: each body's (q,
/// theta) in the chart of the step, R = exp([theta]) R_t0. Joints, springs and motors add the turns counted so far, the values that dampers
/// and joint friction measure rates from, and the targets of constraints (docs/method/joints.md#rows).
#pragma once

#include <vector>

#include "core/contact/barrier.hpp"
#include "core/contact/contact_damping.hpp"
#include "core/contact/friction.hpp"
#include "core/energy/time_integration.hpp"
#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::core::energy {

struct MechanismStep {
    std::vector<double> angles;    ///< per measure: at the step's start, with turns; others 0
    std::vector<double> measures;  ///< per measure: m_slip, so that (m - m_slip)/slip_time is the rate that the integrator means
    double end_time = 0;           ///< [s]
    VectorX row_targets;           ///< per row, then
};

/// m_slip is m at the start; of BDF2 (4 m(P0) - m(P_-1))/3, of Newmark m(P0) + h/2 (dm/dP)(P0) V0.
MechanismStep mechanism_step(const model::Model& model, const History& history);

/// dm/dt per measure, of bodies at `poses` with velocities Pdot.
std::vector<double> measure_rates(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                                  const std::vector<Matrix34>& velocities);

void set_end_time(const model::Mechanism& mechanism, double time, MechanismStep& step);

struct StepProblem : IntegrationStep {
    const model::Model* model = nullptr;
    std::vector<kinematics::Pose> poses_t0;
    double kappa = 0;  ///< [N/m], or [N/m^3] if area-weighted
    contact::BarrierParameters barrier;
    contact::FrictionSet friction;            ///< empty: none
    contact::ContactDamping contact_damping;  ///< factor 0: none
    MechanismStep mechanism;                  ///< joints, springs, motors; empty: none
};

/// The step that follows `history`, without friction until it is lagged (contact/friction.hpp).
StepProblem step_problem(const model::Model& model, const History& history, double kappa);

/// When the step ends: what curves drive follows from it. Without it they are at time 0.
void set_end_time(StepProblem& problem, double time);

/// The barrier's stiffness from here on.
void set_kappa(StepProblem& problem, double kappa);

/// The implicit Euler step from `poses` with velocities Pdot, with the model's kappa.
StepProblem implicit_euler_problem(const model::Model& model, std::vector<kinematics::Pose> poses_t0,
                                   const std::vector<Matrix34>& velocities_t0);

/// Rotations to rounding, however many steps there were before; what has not turned keeps its bits.
std::vector<kinematics::Pose> poses_of(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points);
kinematics::Pose pose_of(const StepProblem& problem, int body, const kinematics::ChartPoint& point);

/// Is anything of this body solved for? Terms of one body leave out those of which nothing is.
bool has_free_dof(const model::Body& body);

}  // namespace fettle::core::energy
