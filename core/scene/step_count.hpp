// SPDX-License-Identifier: MIT
/// How many time steps a duration takes: the one rule, for simulations, scripts, designs and the command line.
#pragma once

#include "core/base/result.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::scene {

/// Steps of a scene that does not say how long.
inline constexpr int default_step_count = 1000;

/// The least number of steps that cover `duration` [s]: 1 s takes four steps of 0.3 s. What exceeds a whole number by 1e-9 or less is that
/// number, so that a duration of 100 h takes 100 steps whatever its rounding; a duration above 0 takes one at least.
/// Errors: more than the largest int (out_of_range, without a place). Contract: duration >= 0, timestep > 0.
base::Result<int> step_count(double duration, double timestep);

/// The scene's steps: those of its end time; default_step_count where it has none, or one that is no number of steps.
int step_count(const Scene& scene);

}  // namespace fettle::core::scene
