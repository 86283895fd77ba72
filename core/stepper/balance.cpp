// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/balance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

std::optional<Balance> balance_of(const model::Model& model, const Simulation& simulation) {
    if (simulation.outputs.empty() || !simulation.start || model.integrator == scene::Integrator::quasi_static) return std::nullopt;
    const double h = model.timestep;
    Balance out;
    const energy::TermReport* before = &*simulation.start;
    out.energy_start = energy_of(*before);
    Vector3 defect = Vector3::Zero(), angular_defect = Vector3::Zero();
    double stored_most = stored_energy(*before) + before->kinetic_energy;
    for (std::size_t t = 0; t < simulation.outputs.size(); ++t) {
        const StepOutputs& at = simulation.outputs[t];
        const StepOutputs& earlier = simulation.outputs[t > 0 ? t - 1 : 0];  // what acts at the very start is known at its end only
        out.work += 0.5 * h * (earlier.supplied_power + at.supplied_power);
        out.dissipated += 0.5 * h * (earlier.dissipated_power + at.dissipated_power);
        defect += at.momentum_defect;
        angular_defect += at.angular_momentum_defect;
        stored_most = std::max(stored_most, stored_energy(at) + at.kinetic_energy);
        out.angular_momentum_scale = std::max(out.angular_momentum_scale, at.angular_momentum.norm());
    }
    out.energy_end = energy_of(simulation.outputs.back());
    out.energy_error = out.energy_end - out.energy_start - out.work + out.dissipated;
    out.energy_scale = std::max({stored_most, std::abs(out.work), out.dissipated});
    out.momentum_error = defect.norm();
    out.angular_momentum_error = angular_defect.norm();
    return out;
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
