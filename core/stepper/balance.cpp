// SPDX-License-Identifier: MIT
#include "core/stepper/balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.hpp"

namespace fettle::core::stepper {
namespace {

double stored_energy(const energy::TermReport& r) { return r.spring_energy + r.contact_energy; }
double energy_of(const energy::TermReport& r) { return r.kinetic_energy + r.potential_energy + stored_energy(r); }

}  // namespace

BalanceSum::BalanceSum(const energy::TermReport& start, double h, double largest_work, double contact_work)
    : h_(h),
      largest_work_(largest_work),
      at_start_(stored_energy(start) + start.kinetic_energy + contact_work),
      most_stored_(stored_energy(start) + start.kinetic_energy),
      start_potential_(start.potential_energy),
      least_potential_(start.potential_energy),
      most_potential_(start.potential_energy) {
    sum_.energy_start = sum_.energy_end = energy_of(start);
    sum_.energy_available = at_start_;
}

void BalanceSum::add(const StepOutputs& step) {
    if (!std::exchange(has_steps_, true)) {  // what acts at the very start is known at the first step's end only
        supplied_ = step.supplied_power;
        dissipated_ = step.dissipated_power;
    }
    const double work = 0.5 * h_ * (supplied_ + step.supplied_power), error_before = sum_.energy_error;
    sum_.work += work;
    work_supplied_ += std::max(0.0, work);
    sum_.dissipated += 0.5 * h_ * (dissipated_ + step.dissipated_power);
    supplied_ = step.supplied_power;
    dissipated_ = step.dissipated_power;
    most_stored_ = std::max(most_stored_, stored_energy(step) + step.kinetic_energy);
    sum_.energy_end = energy_of(step);
    sum_.energy_error = sum_.energy_end - sum_.energy_start - sum_.work + sum_.dissipated;
    most_work_ = std::max(most_work_, std::abs(sum_.work));
    least_potential_ = std::min(least_potential_, step.potential_energy);
    most_potential_ = std::max(most_potential_, step.potential_energy);
    sum_.energy_available = at_start_ + (start_potential_ - least_potential_) + work_supplied_;
    add_loss(error_before - sum_.energy_error, step);
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
    const double potential = std::max(std::abs(least_potential_), std::abs(most_potential_));
    sum_.energy_rounding = rounding * (most_stored_ + most_work_ + sum_.dissipated + potential + largest_work_);
    defect_ += step.momentum_defect;
    angular_defect_ += step.angular_momentum_defect;
    sum_.momentum_error = defect_.norm();
    sum_.angular_momentum_error = angular_defect_.norm();
    most_angular_ = std::max(most_angular_, step.angular_momentum_size);
    angular_impulses_ += step.angular_impulse;
    most_impulse_ = std::max(most_impulse_, step.angular_impulse);
    angular_rounding_ += step.angular_momentum_rounding;
    sum_.angular_momentum_scale = most_angular_ + angular_impulses_;
    sum_.angular_momentum_uncertainty = 0.5 * most_impulse_ + angular_rounding_;
}

void BalanceSum::add_loss(double lost, const StepOutputs& step) {
    constexpr int steps_of_a_jump =
        4;  // BDF2's forces answer a jump for three steps, and a step's power is in the work of the next one too
    if (step.drive_jumps) not_judged_ = steps_of_a_jump;
    if (not_judged_ > 0) {
        --not_judged_;
        return;
    }
    sum_.energy_lost += lost;
    if (!(lost > sum_.largest_loss)) return;
    sum_.largest_loss = lost;
    sum_.largest_loss_time = step.time;
}

double largest_work(const model::Model& model) {
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon(), of_places = 1e-14;  // of the scene's size
    const double speed = of_places * model.diagonal / model.timestep;                            // of what is at rest, by rounding
    double sum = 0;
    for (const model::Body& body : model.bodies) {
        if (!energy::has_free_dof(body)) continue;
        const double mass = body.moments(3, 3);
        sum += (mass * model.gravity.norm() + body.force.norm()) * model.diagonal + body.torque.norm();
        sum += mass * speed * speed / rounding;
    }
    return sum;
}

bool is_of_nowhere(const Balance& balance) {
    constexpr double most = 1;
    return !(balance.energy_error <= most * balance.energy_available + balance.energy_rounding);
}

namespace {

// Do joints, motors and prescribed coordinates leave nothing free? Then no loss of energy changes the motion, but what drives it does more.
bool is_driven_throughout(const model::Model& model) {
    std::size_t free = 0;
    for (const model::Body& body : model.bodies)
        for (int k = 0; k < 6; ++k) free += is_free(body, k) ? 1 : 0;
    return free <= model.mechanism.rows.size();
}

std::string gain_text(const model::Model& model, const Balance& balance) {
    return base::formatted(
               "the motion has gained energy from nowhere, %.3g J where %.3g J were there or were supplied: a shorter `timestep` makes it "
               "less",
               balance.energy_error, balance.energy_available) +
           (model.integrator == scene::Integrator::newmark
                ? ", and `\"integrator\": \"bdf2\"` or `\"implicit_euler\"` loses energy where parts meet, where `newmark` may gain it"
                : "");
}

std::string loss_text(const model::Model& model, const Balance& balance) {
    std::string text =
        base::formatted("the time integration has lost %.3g J, ", balance.energy_lost) +
        base::percent(balance.energy_lost / balance.energy_available) +
        base::formatted(" of the %.3g J that were there or were supplied, beside what friction and dampers take: ",
                        balance.energy_available) +
        "a shorter `timestep`" +
        (model.integrator == scene::Integrator::implicit_euler ? ", or `\"integrator\": \"bdf2\"`, keeps more" : " keeps more");
    if (is_driven_throughout(model))
        return text +
               "; joints and drives leave no motion free that this could change, but the forces and efforts that they need have it "
               "in them";
    const double share = balance.largest_loss / balance.energy_lost;
    if (share < 0.5) return text;
    return text + "; " + base::percent(std::min(1.0, share)) +
           base::formatted(" of it went in the step that ends at %.6g s", balance.largest_loss_time) +
           ", in a blow, whose rebound follows from the time step unless `contact.damping_time` states its loss";
}

}  // namespace

std::string balance_warning(const model::Model& model, const Balance& balance) {
    constexpr double gain = 0.01, loss = 0.05, angular = 0.05;
    if (!std::isfinite(balance.energy_error)) return "energies are not finite numbers";
    if (balance.energy_error > gain * balance.energy_available + balance.energy_rounding) return gain_text(model, balance);
    if (balance.energy_lost > loss * balance.energy_available + balance.energy_rounding) return loss_text(model, balance);
    if (balance.angular_momentum_error > angular * balance.angular_momentum_scale + balance.angular_momentum_uncertainty)
        return "the time integration has changed the angular momentum by " +
               base::percent(balance.angular_momentum_error / balance.angular_momentum_scale) +
               " of what moves and acts: a shorter `timestep`" +
               (model.integrator == scene::Integrator::implicit_euler
                    ? ", or `\"integrator\": \"bdf2\"` or `\"newmark\"`, makes it less (implicit Euler brakes what turns)"
                    : " makes it less");
    return {};
}

}  // namespace fettle::core::stepper
