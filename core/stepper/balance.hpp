// SPDX-License-Identifier: MIT
/// Do energy and momentum balance over a simulation? What they changed by against what forces did: what is left is the error of the time
/// integration and of the solver together. docs/method.md section 3.
#pragma once

#include <optional>
#include <string>

#include "fettle/core/stepper/simulation.hpp"

namespace fettle::core::stepper {

/// Over the steps that a simulation has outputs of. Work and dissipation are sums by the trapezoidal rule of the powers at the ends of
/// steps, right to second order in the step.
struct Balance {
    double energy_start = 0, energy_end = 0;  ///< kinetic, of gravity and constant forces, of springs, stops and contacts [J]
    double work = 0;                          ///< by motors, prescribed coordinates, torques and forces that have no potential [J]
    double dissipated = 0;                    ///< by friction and dampers [J]
    double energy_error = 0;                  ///< energy_end - energy_start - work + dissipated: > 0 comes from nowhere, < 0 is lost [J]
    double energy_scale = 0;                  ///< what passed through the motion: largest kinetic + stored energy, |work|, dissipated [J]
    double momentum_error = 0;                ///< |sum over the steps of StepOutputs::momentum_defect| [kg m/s]
    double angular_momentum_error = 0;        ///< the same of angular_momentum_defect, about the world's origin [kg m^2/s]
    double angular_momentum_scale = 0;        ///< largest |angular momentum| about the world's origin [kg m^2/s]
};

/// @return nullopt: no outputs, or a quasi-static model, which knows no kinetic energy.
std::optional<Balance> balance_of(const model::Model& model, const Simulation& simulation);

/// What a user should know of it, with a remedy; empty: nothing. Energy that comes from nowhere is always told, from 1% of the scale on;
/// what implicit Euler or BDF2 lose only where the balance is asked for, for both stop what collides by losing its energy; angular
/// momentum from 5% on.
std::string balance_warning(const model::Model& model, const Balance& balance);

}  // namespace fettle::core::stepper
