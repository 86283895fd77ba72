// SPDX-License-Identifier: MIT
/// What a quasi-static step's proximal term carries, against the loads: whether bodies are held by what the scene has, or by nothing.
/// docs/method/energy.md#quasi-static-steps.
#pragma once

#include <vector>

#include "fettle/core/energy/step_problem.hpp"

namespace fettle::core::energy {

/// Per body, of where a quasi-static step ended: |force| + |torque| / r of the proximal term, over its free coordinates in the step's
/// chart, over the body's reference load (model::reference_loads); r the body's radius, at least dhat. 0 of bodies that are prescribed
/// altogether, and of all in a scene without loads, where nothing can be pushed off. Above model::allowed_proximal_share a body is not
/// held.
std::vector<double> proximal_shares(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                    const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::energy
