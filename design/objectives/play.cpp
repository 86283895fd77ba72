// SPDX-License-Identifier: MIT
#include "fettle/design/objectives/play.hpp"

#include "fettle/adjoint/clearance/clearance_adjoint.hpp"

namespace fettle::design::objectives {

Quantity Play::value(const Simulated& s) const {
    core::clearance::ClearanceOptions options;
    options.tolerance = s.clearance_tolerance;
    options.sample_nodes = false;
    const auto pair = core::clearance::certify_clearance(s.model, s.trajectory, {{a_, b_, 0}}, options).front();
    return {pair.upper, pair.lower, pair.upper, pair};
}

void Play::add_seeds(const Simulated& s, const Quantity& quantity, double scale, Seeds& seeds) const {
    adjoint::clearance::clearance_adjoint(s.model, s.trajectory, *quantity.clearance, scale, seeds.trajectory_bar, seeds.model_bar);
}

}  // namespace fettle::design::objectives
