// SPDX-License-Identifier: MIT
#include "core/stepper/branch_warnings.hpp"

#include <cmath>
#include <utility>

#include "core/base/units.hpp"
#include "core/model/branch_of_joint.hpp"

namespace fettle::core::stepper {

namespace {

// The first end of a step by which a branch has come to where its sides meet; -1: none.
int dead_centre(const model::Model& model, const constraint::Branch& branch, const Trajectory& trajectory) {
    constexpr double straight = 1e-6, mirrored = 0.2;
    double before = 0, last = 0;
    for (int t = 0; t < count_of(trajectory.poses); ++t) {
        const double side = branch.sign * side_of(branch, measure::placed(model.mechanism.set.frames, trajectory.poses[t]));
        if (side <= straight) return t;
        // A motion that goes over between two ends of steps comes back as its mirror image.
        const double onwards = 2 * last - before;
        if (t >= 2 && onwards < -straight && std::abs(side + onwards) < mirrored * -onwards) return t;
        before = std::exchange(last, side);
    }
    return -1;
}

}  // namespace

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
    for (const constraint::Branch& branch : model::branches_left_open(model))
        if (const int t = dead_centre(model, branch, trajectory); t >= 0)
            out.push_back(
                "the linkage passes a dead centre by t = " + base::format_quantity(time_at(trajectory, t), "s", 4) + ": until then " +
                words_of_side(model.mechanism, branch, branch.sign) +
                "; from there it can go on in two ways, and which one it takes is chance. What is said of this motion holds for the "
                "one that it took. Let something decide it: another crank, a gear, a spring, or a motion that ends before");
    return out;
}

}  // namespace fettle::core::stepper
