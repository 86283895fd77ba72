// SPDX-License-Identifier: MIT
#include "fettle/core/records/checkpoint_io.hpp"

#include <string>
#include <utility>
#include <vector>

namespace fettle::core::records {
namespace {

std::vector<Matrix34> read_rates(const files::JsonNode& node, std::size_t bodies, bool may_be_empty) {
    const auto numbers = node.numbers().value_or(std::vector<double>{});
    std::vector<Matrix34> out(numbers.size() / 12);
    for (std::size_t i = 0; i < 12 * out.size(); ++i) out[i / 12].reshaped()[static_cast<Eigen::Index>(i % 12)] = numbers[i];
    if (numbers.size() != 12 * bodies && !(may_be_empty && numbers.empty()))
        node.fail(base::ErrorCode::inconsistent, "12 numbers per body are wanted, " + std::to_string(numbers.size()) + " found");
    return out;
}

}  // namespace

void write_checkpoint(files::JsonWriter& out, const stepper::Checkpoint& checkpoint) {
    const energy::History& history = checkpoint.state.history;
    out.text += '{';
    out.key("step");
    out.number(checkpoint.step);
    out.key("kappa");
    out.number(checkpoint.state.kappa);
    for (const auto& [name, list] : {std::pair{"velocities", &history.velocities},
                                     {"poses_before", &history.poses_before},
                                     {"velocities_before", &history.velocities_before},
                                     {"accelerations", &history.accelerations}}) {
        out.key(name);
        out.list(12 * list->size(), ",", [&](std::size_t i) { out.number((*list)[i / 12].reshaped()[static_cast<Eigen::Index>(i % 12)]); });
    }
    out.text += '}';
}

stepper::Checkpoint read_checkpoint(const files::JsonNode& node, const stepper::Trajectory& trajectory) {
    node.allow_keys({"step", "kappa", "velocities", "poses_before", "velocities_before", "accelerations"});
    const std::size_t bodies = trajectory.body_names.size();
    stepper::Checkpoint out;
    out.step = node.require("step").integer(0, static_cast<int>(trajectory.steps.size())).value_or(0);
    out.state.time = out.step * trajectory.timestep;
    out.state.kappa = node.require("kappa").number(files::positive).value_or(1);
    out.state.history = {trajectory.poses[static_cast<std::size_t>(out.step)], read_rates(node.require("velocities"), bodies, false),
                         read_rates(node.require("poses_before"), bodies, true),
                         read_rates(node.require("velocities_before"), bodies, true),
                         read_rates(node.require("accelerations"), bodies, true)};
    return out;
}

}  // namespace fettle::core::records
