// SPDX-License-Identifier: MIT
// Pairs that the broad phase over time leaves out are far: against the least distance of each pair in each segment, searched by itself; and
// the least distance of all at once against each pair alone.
#include "core/clearance/near_windows.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/tumbling_boxes.hpp"

namespace fettle::core::clearance::near_windows_test {

using namespace fettle::tests::support;
using fettle::tests::clearance::tumbling;
using Scene = fettle::tests::clearance::TumblingBoxes;

namespace {

// The path of one segment alone.
stepper::Trajectory only(const stepper::Trajectory& trajectory, const PathPlace& place) {
    stepper::Trajectory part;
    part.timestep = trajectory.timestep;
    part.body_names = trajectory.body_names;
    const auto step = static_cast<std::size_t>(place.step), k = static_cast<std::size_t>(place.segment);
    part.poses = {trajectory.poses[step], trajectory.poses[step + 1]};
    part.steps.resize(1);
    part.steps[0].nodes = {trajectory.steps[step].nodes[k], trajectory.steps[step].nodes[k + 1]};
    return part;
}

bool holds(const std::vector<NearWindow>& windows, int a, int b, int place) {
    return std::any_of(windows.begin(), windows.end(),
                       [&](const NearWindow& w) { return w.a == a && w.b == b && w.first <= place && place < w.last; });
}

double least_alone(const Scene& scene, const ClearanceOptions& options) {
    std::vector<PairRequest> pairs;
    const int count = count_of(scene.model.bodies);
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (model::may_collide(scene.model, a, b)) pairs.push_back({a, b, 0});
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (const PairClearance& pair : certify(scene.model, scene.trajectory, pairs, options)) least = std::min(least, pair.lower);
    return least;
}

}  // namespace

TEST_CASE("what is not in a window is farther apart than the reach") {
    long left_out = 0, near = 0;
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        Scene scene = tumbling(6, 5, seed);
        if (seed > 3) {  // hardly turning: their boxes are others
            for (stepper::TrajectoryStep& step : scene.trajectory.steps)
                for (auto& node : step.nodes)
                    for (kinematics::ChartPoint& point : node) point.rotation_vector *= 2e-3;
        }
        const std::vector<PathPlace> places = path_places(scene.trajectory, true);
        ClearanceOptions options;
        options.motion = true;
        options.tolerance = 1e-3;
        options.sample_nodes = options.measure_overlap = false;
        for (const double reach : {0.0, 0.1, 1.0}) {
            const NearWindows found = near_windows(scene.model, scene.trajectory, places, reach);
            CHECK_FALSE(found.everything);
            for (int place = 0; place < count_of(places); ++place) {
                const stepper::Trajectory part = only(scene.trajectory, places[place]);
                for (int a = 0; a < 6; ++a) {
                    for (int b = a + 1; b < 6; ++b) {
                        if (!model::may_collide(scene.model, a, b)) {
                            REQUIRE_FALSE(holds(found.windows, a, b, place));
                            continue;
                        }
                        if (holds(found.windows, a, b, place)) {
                            ++near;
                            continue;
                        }
                        ++left_out;
                        CAPTURE(seed, reach, a, b, place);
                        REQUIRE(certify(scene.model, part, {{a, b, 0}}, options).front().upper > reach);
                    }
                }
            }
        }
    }
    CHECK(left_out > 500);  // it leaves something out, and not everything
    CHECK(near > 50);
}

TEST_CASE("a body that turns fast is somewhere between the ends of a segment") {
    Scene scene = tumbling(3, 1, 1);
    scene.model.bodies = {
        make_body("post", box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), make_pose({0, 0, 0}, {0, 1, 0}), scene::BodyType::static_body),
        make_body("arm", box_mesh({-0.05, -0.05, -0.05}, {0.85, 0.05, 0.05}), make_pose({0, 0, 0}, {0, 0, 0}))};
    scene.trajectory = as_assembled(scene.model);
    stepper::TrajectoryStep step;  // half a turn about z: at both ends it points away from the post, in between at it
    step.nodes = {{{{0, 1, 0}, Vector3::Zero()}, {Vector3::Zero(), Vector3::Zero()}},
                  {{{0, 1, 0}, Vector3::Zero()}, {Vector3::Zero(), {0, 0, 3.1}}}};
    scene.trajectory.steps = {step};
    scene.trajectory.poses.push_back(scene.trajectory.poses[0]);
    const NearWindows found = near_windows(scene.model, scene.trajectory, path_places(scene.trajectory, true), 0.06);
    CHECK(found.windows.size() == 1);
    CHECK(found.everything);
}

TEST_CASE("a body that hardly turns goes far where it is long") {
    Scene scene = tumbling(3, 1, 1);
    const auto found = [&](double turn, double gap) {
        scene.model.bodies = {make_body("post", box_mesh({-0.05, 0.05 + gap, -0.05}, {0.05, 1, 0.05}), make_pose({0, 0, 0}, {0.85, 0, 0}),
                                        scene::BodyType::static_body),
                              make_body("arm", box_mesh({-0.05, -0.05, -0.05}, {0.85, 0.05, 0.05}), make_pose({0, 0, 0}, {0, 0, 0}))};
        scene.trajectory = as_assembled(scene.model);
        stepper::TrajectoryStep step;
        step.nodes = {{{{0.85, 0, 0}, Vector3::Zero()}, {Vector3::Zero(), Vector3::Zero()}},
                      {{{0.85, 0, 0}, Vector3::Zero()}, {Vector3::Zero(), {0, 0, turn}}}};
        scene.trajectory.steps = {step};
        scene.trajectory.poses.push_back(scene.trajectory.poses[0]);
        return near_windows(scene.model, scene.trajectory, path_places(scene.trajectory, true), 0.06).windows.size();
    };
    for (const double turn : {1e-3, 5e-3, 1e-2, 2e-2, 4e-2}) {
        CAPTURE(turn);
        CHECK(found(turn, 0.06 + 0.84 * turn) == 1);  // the tip rises by 0.85 sin(turn): just within the reach
        CHECK(found(turn, 0.06 + 3 * turn) == 0);
        CHECK(found(-turn, 0.06 + 3 * turn) == 0);
    }
}

TEST_CASE("everything, nothing, and what cannot be measured") {
    Scene scene = tumbling(6, 4, 4);
    const std::vector<PathPlace> places = path_places(scene.trajectory, true);
    const double infinity = std::numeric_limits<double>::infinity();
    const NearWindows all = near_windows(scene.model, scene.trajectory, places, infinity);
    CHECK(all.everything);
    CHECK(all.windows.size() == 14);  // of 15 pairs one is of a group
    scene.trajectory.steps[2].nodes[1][3].position.x() = std::nan("");
    const NearWindows blind = near_windows(scene.model, scene.trajectory, places, 0);
    int of_three = 0;
    for (const NearWindow& window : blind.windows) {
        const bool three = window.a == 3 || window.b == 3;
        of_three += three;
        CHECK(window.measurable == !three);
        if (three) CHECK((window.first == 0 && window.last == count_of(places)));
    }
    CHECK(of_three == 5);
    ClearanceOptions options;
    options.motion = true;
    for (const PairClearance& pair : certify_near(scene.model, scene.trajectory, 0.1, options).windows) {
        if (pair.a == 3 || pair.b == 3) CHECK((pair.lower == 0 && pair.status == PairStatus::undecided));
    }
}

TEST_CASE("the least of all pairs at once is the least of each alone") {
    int apart = 0;
    for (unsigned seed = 1; seed < 12; ++seed) {
        const Scene scene = tumbling(5, 2, seed);
        ClearanceOptions options;
        options.motion = true;
        options.tolerance = 1e-4;
        options.sample_nodes = options.measure_overlap = false;
        const double alone = least_alone(scene, options);
        if (alone == 0) continue;  // they pass through each other
        ++apart;
        for (const double reach : {0.5 * alone, 2 * alone, 50.0}) {
            const NearClearances near = certify_near(scene.model, scene.trajectory, reach, options);
            double least = near.everything ? std::numeric_limits<double>::infinity() : reach;
            for (const PairClearance& pair : near.windows) least = std::min(least, pair.lower);
            CAPTURE(seed, reach, alone, near.windows.size());
            CHECK(least <= alone + 1e-4);
            CHECK(least >= std::min(reach, alone - 1e-4));
        }
    }
    CHECK(apart >= 3);
}

}  // namespace fettle::core::clearance::near_windows_test
