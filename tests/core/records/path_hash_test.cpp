// SPDX-License-Identifier: MIT
#include "core/records/path_hash.hpp"

#include <catch2/catch.hpp>
#include <functional>

namespace fettle::core::records::path_hash_test {

namespace {

stepper::Trajectory two_steps() {
    stepper::Trajectory out;
    out.timestep = 0.1;
    out.body_names = {"a", "b"};
    for (const double x : {0.0, 1.0, 2.0}) out.poses.push_back({{Matrix3::Identity(), {x, 0, 0}}, {Matrix3::Identity(), {0, x, 0}}});
    for (const double x : {0.0, 1.0}) {
        stepper::TrajectoryStep step;
        for (const double s : {0.0, 0.25, 1.0}) step.nodes.push_back({{{x + s, 0, 0}, Vector3::Zero()}, {{0, x + s, 0}, Vector3::Zero()}});
        out.steps.push_back(step);
    }
    return out;
}

}  // namespace

TEST_CASE("Every number of a path is in its hash, and nothing else", "[records]") {
    const stepper::Trajectory path = two_steps();
    const std::uint64_t hash = path_hash(path);
    const auto after = [&](const std::function<void(stepper::Trajectory&)>& change) {
        stepper::Trajectory changed = path;
        change(changed);
        return path_hash(changed);
    };
    CHECK(after([](auto&) {}) == hash);
    CHECK(after([](auto& p) { std::swap(p.body_names[0], p.body_names[1]); }) == hash);
    CHECK(after([](auto& p) { p.timestep = 0.2; }) != hash);
    CHECK(after([](auto& p) { p.time_start = 1; }) != hash);
    CHECK(after([](auto& p) { p.times = {0, 0.1, 0.2}; }) != hash);
    CHECK(after([](auto& p) { p.poses[2][1].rotation(2, 1) = 1e-300; }) != hash);
    CHECK(after([](auto& p) { p.steps[1].nodes[1][0].rotation_vector[2] = -0.0; }) != hash);
    CHECK(after([](auto& p) { p.steps[0].fractions = {0, 0.25, 1}; }) != hash);
    CHECK(after([](auto& p) { std::swap(p.steps[0], p.steps[1]); }) != hash);
    CHECK(after([](auto& p) { p.steps.pop_back(), p.poses.pop_back(); }) != hash);
}

TEST_CASE("A path's hash grows with it", "[records]") {
    const stepper::Trajectory path = two_steps();
    PathHash grown(path.timestep, path.time_start, path.times, path.poses[0]);
    grown.add_step(path.steps[0], nullptr, path.poses[1]);
    stepper::Trajectory first = path;
    first.steps.pop_back(), first.poses.pop_back();
    CHECK(grown.value() == path_hash(first));
    grown.add_step(path.steps[1], nullptr, path.poses[2]);
    CHECK(grown.value() == path_hash(path));
}

TEST_CASE("A witness's time follows the nodes' fractions", "[stepper]") {
    stepper::Trajectory path = two_steps();
    CHECK(stepper::time_at(path, 1, 1, 0.5) == Approx(0.175));
    path.steps[1].fractions = {0, 0.25, 1};
    CHECK(stepper::time_at(path, 1, 0, 1) == Approx(0.125));
    CHECK(stepper::time_at(path, 1, 1, 0.5) == Approx(0.1625));
    path.times = {0, 1, 3};
    CHECK(stepper::time_at(path, 1, 1, 0.5) == Approx(2.25));
}

}  // namespace fettle::core::records::path_hash_test
