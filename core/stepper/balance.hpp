// SPDX-License-Identifier: MIT
/// Do energy and momentum balance over a simulation? Their change is compared with the work and the impulse of the forces: the difference
/// is the error of the time integration and of the solver together, measured against what was there and was supplied.
/// docs/method/energy.md#integrators.
#pragma once

#include <string>

#include "core/stepper/step_outputs.hpp"

namespace fettle::core::stepper {

/// Over steps that have outputs. Work and dissipation are sums by the trapezoidal rule of the powers at the ends of steps, right to second
/// order in the step.
struct Balance {
    double energy_start = 0, energy_end = 0;  ///< kinetic, of gravity and constant forces, of springs, stops and contacts [J]
    double work = 0;                          ///< by motors, prescribed coordinates, torques and forces that have no potential [J]
    double dissipated = 0;                    ///< by friction and dampers [J]
    double energy_error = 0;                  ///< energy_end - energy_start - work + dissipated: > 0 comes from nowhere, < 0 is lost [J]
    /// The energy that was there and was supplied, none of it made by the time integration: kinetic and stored energy at the start, the
    /// most that gravity and constant forces gave up of theirs, the supply while it was positive, and the work of gravity and those forces
    /// over the contact distance, within which contact does not tell energies [J].
    double energy_available = 0;
    double energy_rounding = 0;  ///< of the energies that energy_error is the difference of [J]
    /// -energy_error without the steps in which a drive starts, stops or jumps (StepOutputs::drive_jumps) and the three after them [J].
    double energy_lost = 0;
    double largest_loss = 0, largest_loss_time = 0;  ///< the step with the largest share of that: how much, and when it ends [J], [s]
    double momentum_error = 0;                       ///< |sum over the steps of StepOutputs::momentum_defect| [kg m/s]
    double angular_momentum_error = 0;               ///< the same of angular_momentum_defect, about the world's origin [kg m^2/s]
    /// The largest sum of the bodies' |angular momentum| and the sum of what forces did to them (StepOutputs::angular_impulse) [kg m^2/s].
    double angular_momentum_scale = 0;
    /// To what angular_momentum_error is known: half of the largest step's impulse, and rounding [kg m^2/s].
    double angular_momentum_uncertainty = 0;
};

/// The balance of steps that are added one by one.
class BalanceSum {
public:
    /// @param start       energies and momenta where the first step begins (start_report).
    /// @param h           time step [s].
    /// @param largest_work  the work of all loads and weights over a way as long as the scene: energies are known to its rounding [J].
    /// @param contact_work  the same over the contact distance [J].
    BalanceSum(const energy::TermReport& start, double h, double largest_work = 0, double contact_work = 0);
    void add(const StepOutputs& step);
    const Balance& balance() const { return sum_; }

private:
    void add_loss(double lost, const StepOutputs& step);

    double h_ = 0, largest_work_ = 0;
    bool has_steps_ = false;
    int not_judged_ = 0;                                                                        // steps after a drive's jump
    double at_start_ = 0, work_supplied_ = 0;                                                   // [J]
    double supplied_ = 0, dissipated_ = 0;                                                      // powers at the end of the step before [W]
    double most_stored_ = 0;                                                                    // or in motion [J]
    double most_work_ = 0, start_potential_ = 0, least_potential_ = 0, most_potential_ = 0;     // [J]
    double most_angular_ = 0, angular_impulses_ = 0, most_impulse_ = 0, angular_rounding_ = 0;  // [kg m^2/s]
    Vector3 defect_ = Vector3::Zero(), angular_defect_ = Vector3::Zero();
    Balance sum_;
};

/// The largest work on the bodies that are solved for: (weight + force) times the scene's size, and torques [J].
double largest_work(const model::Model& model);

/// Has the motion gained more energy from nowhere than was there and was supplied? Then it is none of this scene's.
bool is_of_nowhere(const Balance& balance);

/// A warning for the user, with a remedy; empty: none. Energy that comes from nowhere is reported from 1% of what was available on, energy
/// that is lost, and angular momentum, from 5% on, and nothing that is within rounding or less than is known of it.
std::string balance_warning(const model::Model& model, const Balance& balance);

}  // namespace fettle::core::stepper
