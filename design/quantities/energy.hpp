// SPDX-License-Identifier: MIT
/// Energies at each step's end, those that follow from where bodies are at the start too, of all bodies with mass, joints and springs [J]:
///   kinetic     sum 1/2 tr(V M V^T),   V the integrator's end velocity (adjoint/stepper/velocities.hpp)   (none in quasi-statics)
///   potential   - sum a . (P' M e4) + f . q'              gravity a and constant forces f, zero at the world's origin
///   spring      sum g(m')                                 of springs and stops (core/energy/measure_terms.hpp)
///   total       their sum
#pragma once

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

enum class EnergyKind { kinetic, potential, spring, total };

class Energy : public StepSeries {
public:
    Energy(EnergyKind kind, const Reduction& reduction) : StepSeries(reduction), kind_(kind) {}

    EnergyKind kind() const { return kind_; }
    Dimension instant_dimension() const override { return Dimension::energy; }
    bool has_start() const override { return !has(EnergyKind::kinetic); }
    /// Kinetic energy in quasi-statics; masses that are not those of solids of their density.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    bool has_kinetic(const core::model::Model& model) const;
    bool has(EnergyKind kind) const { return kind_ == kind || kind_ == EnergyKind::total; }

    EnergyKind kind_;
};

}  // namespace fettle::design::quantities
