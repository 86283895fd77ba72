// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/balance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace fettle::core::stepper {
namespace {

double stored_energy(const energy::TermReport& r) { return r.spring_energy + r.contact_energy; }
double energy_of(const energy::TermReport& r) { return r.kinetic_energy + r.potential_energy + stored_energy(r); }

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g%%", 100 * share);
    return text;
}

}  // namespace

BalanceSum::BalanceSum(const energy::TermReport& start, double h) : h_(h), most_stored_(stored_energy(start) + start.kinetic_energy) {
    sum_.energy_start = sum_.energy_end = energy_of(start);
    sum_.energy_scale = most_stored_;
    sum_.angular_momentum_scale = start.angular_momentum.norm();
}

void BalanceSum::add(const StepOutputs& step) {
    if (!std::exchange(has_steps_, true)) {  // what acts at the very start is known at the first step's end only
        supplied_ = step.supplied_power;
        dissipated_ = step.dissipated_power;
    }
    sum_.work += 0.5 * h_ * (supplied_ + step.supplied_power);
    sum_.dissipated += 0.5 * h_ * (dissipated_ + step.dissipated_power);
    supplied_ = step.supplied_power;
    dissipated_ = step.dissipated_power;
    most_stored_ = std::max(most_stored_, stored_energy(step) + step.kinetic_energy);
    sum_.energy_end = energy_of(step);
    sum_.energy_error = sum_.energy_end - sum_.energy_start - sum_.work + sum_.dissipated;
    sum_.energy_scale = std::max({most_stored_, std::abs(sum_.work), sum_.dissipated});
    defect_ += step.momentum_defect;
    angular_defect_ += step.angular_momentum_defect;
    sum_.momentum_error = defect_.norm();
    sum_.angular_momentum_error = angular_defect_.norm();
    sum_.angular_momentum_scale = std::max(sum_.angular_momentum_scale, step.angular_momentum.norm());
}

std::string balance_warning(const model::Model& model, const Balance& balance) {
    constexpr double gain = 0.01, angular = 0.05;
    if (!std::isfinite(balance.energy_error)) return "energies are no finite numbers";
    if (balance.energy_error > gain * balance.energy_scale)
        return "the motion has gained energy from nowhere, " + percent(balance.energy_error / balance.energy_scale) +
               " of what it has at most: a shorter `timestep` makes it less";
    if (balance.angular_momentum_error > angular * balance.angular_momentum_scale)
        return "the time integration has changed the angular momentum by " +
               percent(balance.angular_momentum_error / balance.angular_momentum_scale) + " of its largest: a shorter `timestep`" +
               (model.integrator == scene::Integrator::implicit_euler
                    ? ", or `\"integrator\": \"bdf2\"` or `\"newmark\"`, makes it less (implicit Euler brakes what turns)"
                    : " makes it less");
    return {};
}

}  // namespace fettle::core::stepper
