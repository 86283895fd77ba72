// SPDX-License-Identifier: MIT
#include "design/quantities/gap.hpp"

#include "adjoint/clearance/contact_gap_adjoint.hpp"
#include "core/clearance/contact_gap.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<double> Gap::series(const Simulated& simulated) const {
    std::vector<double> out;
    for (const auto& poses : simulated.trajectory.poses)
        out.push_back(core::clearance::contact_gap(simulated.model, poses, of_.a, of_.b).gap);
    return out;
}

void Gap::add_series_seeds(const Simulated& simulated, const std::vector<double>& weights, Seeds& seeds) const {
    for (std::size_t t = 0; t < weights.size(); ++t) {
        if (weights[t] == 0) continue;
        const auto& poses = simulated.trajectory.poses[t];
        const auto gap = core::clearance::contact_gap(simulated.model, poses, of_.a, of_.b);
        adjoint::clearance::contact_gap_adjoint(simulated.model, poses, gap, weights[t], seeds.trajectory_bar.pose_bar[t], seeds.model_bar);
    }
}

Errors Gap::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const int body : {of_.a, of_.b})
        for (const Error& error : description::check_body(model, body)) errors.push_back(error);
    if (!errors.empty()) return errors;
    if (of_.a == of_.b)
        errors.push_back({ErrorCode::inconsistent, "", "a gap is between two bodies"});
    else if (!may_collide(model, of_.a, of_.b))
        errors.push_back({ErrorCode::inconsistent, "",
                          "\"" + model.bodies[of_.a].name + "\" and \"" + model.bodies[of_.b].name +
                              "\" never collide, so that contact has no gap between them"});
    return errors;
}

}  // namespace fettle::design::quantities
