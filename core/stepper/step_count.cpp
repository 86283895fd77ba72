// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fettle/core/base/contract.hpp"

namespace fettle::core::stepper {

int step_count(double duration, double timestep) {
    FETTLE_ASSERT(duration >= 0 && timestep > 0, "a duration and a time step");
    constexpr int most = std::numeric_limits<int>::max();
    const double steps = std::ceil(duration / timestep - 1e-9);
    return steps < most ? static_cast<int>(std::max(steps, duration > 0 ? 1.0 : 0.0)) : most;
}

}  // namespace fettle::core::stepper
