// SPDX-License-Identifier: MIT
/// What a step holds constant of joints, springs and motors: turns counted so far, what dampers and joint friction measure rates from,
/// what rows are to come to. docs/method/joints.md#rows.
#pragma once

#include <vector>

#include "fettle/core/energy/time_integration.hpp"
#include "fettle/core/model/model.hpp"

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

}  // namespace fettle::core::energy
