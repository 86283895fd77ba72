// SPDX-License-Identifier: MIT
#include "adjoint/stepper/seeded_sweep.hpp"

#include <algorithm>

#include "adjoint/stepper/reverse_sweep.hpp"

namespace fettle::adjoint::stepper {

namespace {

bool is_zero(const std::vector<Matrix34>& bars) {
    return std::all_of(bars.begin(), bars.end(), [](const Matrix34& bar) { return bar.isZero(0); });
}

bool reaches_past_start(const TrajectoryGradient& seed) {
    for (std::size_t t = 1; t < seed.pose_bar.size(); ++t)
        if (!is_zero(seed.pose_bar[t])) return true;
    for (const auto* of_steps : {&seed.velocity_bar, &seed.lag_bar})
        if (!std::all_of(of_steps->begin(), of_steps->end(), is_zero)) return true;
    for (const VectorX& bar : seed.multiplier_bar)
        if (bar.size() > 0 && !bar.isZero(0)) return true;
    return false;
}

void add_start(const TrajectoryGradient& seed, ModelGradient& sum) {
    for (std::size_t i = 0; i < sum.bodies.size(); ++i) sum.bodies[i].pose_start_bar += seed.pose_bar[0][i];
}

}  // namespace

Result<std::vector<ModelGradient>> seeded_sweep(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                std::vector<Seeds> seeds) {
    for (const Seeds& seed : seeds)
        if (!seed.refusal.empty()) return core::base::Error{core::base::ErrorCode::unsupported, "gradient", seed.refusal};
    std::vector<ModelGradient> result;
    std::vector<TrajectoryGradient> moving;
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < seeds.size(); ++k) {
        result.push_back(std::move(seeds[k].model_bar));
        if (!reaches_past_start(seeds[k].trajectory_bar)) {
            add_start(seeds[k].trajectory_bar, result.back());
            continue;
        }
        moving.push_back(std::move(seeds[k].trajectory_bar));
        of.push_back(k);
    }
    if (moving.empty()) return result;
    const Result<std::vector<ModelGradient>> parts = reverse_sweep(model, trajectory, moving);
    if (!parts) return parts.errors();
    for (std::size_t j = 0; j < of.size(); ++j) add(result[of[j]], (*parts)[j]);
    return result;
}

}  // namespace fettle::adjoint::stepper
