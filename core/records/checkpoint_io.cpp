// SPDX-License-Identifier: MIT
#include "core/records/checkpoint_io.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/files/hash.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;

constexpr double largest_number = 1e30;

std::vector<Matrix34> read_rates(const files::JsonNode& node, std::size_t bodies, bool may_be_empty) {
    const auto numbers = node.numbers().value_or(std::vector<double>{});
    std::vector<Matrix34> out(numbers.size() / 12);
    for (std::size_t i = 0; i < 12 * out.size(); ++i) out[i / 12].reshaped()[i % 12] = numbers[i];
    if (numbers.size() != 12 * bodies && !(may_be_empty && numbers.empty()))
        node.fail(ErrorCode::inconsistent, "12 numbers per body are expected, " + std::to_string(numbers.size()) + " found");
    for (const double x : numbers) {
        if (std::abs(x) <= largest_number) continue;
        node.fail(ErrorCode::out_of_range, "numbers beyond 1e30 are refused");
        break;
    }
    return out;
}

std::string hash_of(const stepper::Checkpoint& checkpoint, const std::vector<ScenePart>& scene) {
    files::Fnv1a hash;
    hash.add(static_cast<std::uint64_t>(checkpoint.step));
    hash.add(checkpoint.state.kappa);
    const energy::History& history = checkpoint.state.history;
    const auto add = [&](const Matrix34& matrix) {
        for (const double x : matrix.reshaped()) hash.add(x);
    };
    for (const kinematics::Pose& pose : history.poses) add(pose_matrix(pose));
    for (const auto* list : {&history.velocities, &history.poses_before, &history.velocities_before, &history.accelerations}) {
        hash.add(static_cast<std::uint64_t>(list->size()));
        for (const Matrix34& rate : *list) add(rate);
    }
    for (const ScenePart& part : scene) hash.add(part.name + part.hash);
    return files::hexadecimal(hash.value());
}

std::vector<ScenePart> read_scene(const files::JsonNode& node) {
    std::vector<ScenePart> out;
    for (const files::JsonNode& part : node.elements()) {
        part.allow_keys({"part", "hash"});
        out.push_back({part.require("part").string().value_or(""), part.require("hash").string().value_or("")});
    }
    return out;
}

}  // namespace

void write_checkpoint(files::JsonWriter& out, const stepper::Checkpoint& checkpoint, const std::vector<ScenePart>& scene) {
    const energy::History& history = checkpoint.state.history;
    out.text += '{';
    out.key("step");
    out.number(checkpoint.step);
    out.key("kappa");
    out.number(checkpoint.state.kappa);
    for (const auto& entry : {std::pair{"velocities", &history.velocities},
                              {"poses_before", &history.poses_before},
                              {"velocities_before", &history.velocities_before},
                              {"accelerations", &history.accelerations}}) {
        out.key(entry.first);
        const auto& list = *entry.second;
        out.list(12 * list.size(), ",", [&](std::size_t i) { out.number(list[i / 12].reshaped()[i % 12]); });
    }
    out.key("scene");
    out.list(scene.size(), ",", [&](std::size_t i) {
        out.text += '{';
        out.key("part");
        out.string(scene[i].name);
        out.key("hash");
        out.string(scene[i].hash);
        out.text += '}';
    });
    out.key("hash");
    out.string(hash_of(checkpoint, scene));
    out.text += '}';
}

StoredCheckpoint read_checkpoint(const files::JsonNode& node, const stepper::Trajectory& trajectory) {
    node.allow_keys({"step", "kappa", "velocities", "poses_before", "velocities_before", "accelerations", "scene", "hash"});
    const std::size_t bodies = trajectory.body_names.size();
    StoredCheckpoint out;
    stepper::Checkpoint& checkpoint = out.checkpoint;
    checkpoint.step = node.require("step").integer(0, count_of(trajectory.steps)).value_or(0);
    checkpoint.state.time = checkpoint.step * trajectory.timestep;
    checkpoint.state.kappa = node.require("kappa").number({0, largest_number, true}).value_or(1);
    checkpoint.state.history = {trajectory.poses[checkpoint.step], read_rates(node.require("velocities"), bodies, false),
                                read_rates(node.require("poses_before"), bodies, true),
                                read_rates(node.require("velocities_before"), bodies, true),
                                read_rates(node.require("accelerations"), bodies, true)};
    out.scene = read_scene(node.require("scene"));
    const auto stored = node.require("hash").string();
    if (stored && *stored != hash_of(checkpoint, out.scene))
        node["hash"].fail(ErrorCode::inconsistent, "it is not that of the checkpoint and its step's poses: the file was changed");
    return out;
}

}  // namespace fettle::core::records
