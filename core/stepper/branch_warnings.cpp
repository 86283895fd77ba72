// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/branch_warnings.hpp"

#include "fettle/core/base/units.hpp"
#include "fettle/core/model/branch_of_joint.hpp"

namespace fettle::core::stepper {

std::vector<std::string> branch_warnings(const model::Model& model, const Trajectory& trajectory) {
    std::vector<std::string> out;
    for (const constraint::Branch& branch : model.mechanism.branches)
        for (int t = 0; t < count_of(trajectory.poses); ++t) {
            if (is_on_side(model.mechanism, branch, trajectory.poses[t])) continue;
            out.push_back(
                "the linkage has gone over to its other assembly by t = " + base::format_quantity(time_at(trajectory, t), "s", 4) + ": " +
                words_of_side(model.mechanism, branch, -branch.sign) + " there, and the scene asks at the start that " +
                words_of_side(model.mechanism, branch, branch.sign) +
                "; it passes a dead centre on the way, where small changes decide which way it goes");
            break;
        }
    return out;
}

}  // namespace fettle::core::stepper
