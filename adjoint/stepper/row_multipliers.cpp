// SPDX-License-Identifier: MIT
#include "adjoint/stepper/row_multipliers.hpp"

#include "adjoint/stepper/step_linearisation.hpp"

namespace fettle::adjoint::stepper {

std::vector<VectorX> row_multipliers(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                     std::vector<double>* weights) {
    std::vector<VectorX> out;
    if (model.mechanism.rows.empty()) return out;
    StepSolver solver(model);
    const SweepHistory history = sweep_history(model, trajectory);
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const LinearisedStep step = linearise_step(model, trajectory, static_cast<int>(t), history, solver);
        out.push_back(by_number(step, step.multipliers));
        if (weights != nullptr) weights->push_back(step.problem.weight);
    }
    return out;
}

}  // namespace fettle::adjoint::stepper
