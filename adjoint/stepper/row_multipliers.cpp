// SPDX-License-Identifier: MIT
#include "fettle/adjoint/stepper/row_multipliers.hpp"

#include "fettle/adjoint/stepper/step_linearisation.hpp"

namespace fettle::adjoint::stepper {

std::vector<VectorX> row_multipliers(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    std::vector<VectorX> out;
    if (model.mechanism.rows.empty()) return out;
    StepSolver solver(model);
    const SweepHistory history = sweep_history(model, trajectory);
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t)
        out.push_back(linearise_step(model, trajectory, static_cast<int>(t), history, solver).multipliers);
    return out;
}

}  // namespace fettle::adjoint::stepper
