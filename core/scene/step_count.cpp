// SPDX-License-Identifier: MIT
#include "core/scene/step_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/units.hpp"

namespace fettle::core::scene {

base::Result<int> step_count(double duration, double timestep) {
    FETTLE_ASSERT(duration >= 0 && timestep > 0, "a duration and a time step");
    constexpr int most = std::numeric_limits<int>::max();
    const double steps = std::ceil(duration / timestep - 1e-9);
    if (steps < most) return static_cast<int>(std::max(steps, duration > 0 ? 1.0 : 0.0));
    return base::Error{base::ErrorCode::out_of_range,
                       {},
                       base::format_quantity(duration, "s", 4) + " in time steps of " + base::format_quantity(timestep, "s", 4) +
                           " are more than " + std::to_string(most) + " steps: take a shorter time, or a larger time step"};
}

int step_count(const Scene& scene) {
    if (!scene.end_time) return default_step_count;
    const base::Result<int> steps = step_count(*scene.end_time, scene.timestep);
    return steps ? *steps : default_step_count;
}

}  // namespace fettle::core::scene
