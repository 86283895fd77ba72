// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/clearance.hpp"

#include <catch2/catch.hpp>

#include "fettle/core/base/parallel.hpp"
#include "fettle/tests/core/clearance/clearance_oracle.hpp"

using namespace fettle;
using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;

namespace {

core::model::Model model_of(const std::vector<Solid>& solids, const std::vector<Vector3>& positions) {
    core::model::Model model;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        core::model::Body body;
        body.name = "body " + std::to_string(i);
        body.mesh = solids[i].mesh;
        body.hierarchy = solids[i].hierarchy;
        body.pose_start.position = positions[i];
        model.bodies.push_back(body);
    }
    model.dhat = 1e-4;
    return model;
}

ClearanceOptions options_with(double tolerance) {
    ClearanceOptions options;
    options.tolerance = tolerance;
    return options;
}

// Body 0 at rest, body 1 visiting the nodes within one step.
core::stepper::Trajectory one_step(const core::model::Model& model, const std::vector<core::kinematics::ChartPoint>& nodes) {
    core::stepper::Trajectory trajectory = as_assembled(model);
    trajectory.timestep = 0.5;
    trajectory.time_start = 2;
    core::stepper::TrajectoryStep step;
    for (const auto& node : nodes) step.nodes.push_back({{model.bodies[0].pose_start.position, Vector3::Zero()}, node});
    trajectory.steps.push_back(step);
    trajectory.poses.push_back(trajectory.poses[0]);
    trajectory.poses[1][1] = {core::kinematics::rotation(nodes.back().rotation_vector), nodes.back().position};
    return trajectory;
}

}  // namespace

TEST_CASE("Boxes as assembled: bounds, status and witness", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5}), box({1, 1, 1})}, {{0, 0, 0}, {2, 0.1, 0.2}, {0, 2.00005, 0}});
    const auto start = as_assembled(model);
    CHECK(start.steps.empty());
    CHECK(start.body_names[2] == "body 2");
    const auto results =
        certify_clearance(model, start, {{0, 1, 0.4}, {0, 1, 0.6}, {1, 0, 0.5}, {0, 1, 0}, {0, 2, 0}, {1, 2, 0.1}}, options_with(1e-6));
    const std::vector<PairStatus> expected{PairStatus::clear, PairStatus::violated, PairStatus::undecided,
                                           PairStatus::clear, PairStatus::contact,  PairStatus::clear};
    for (std::size_t i = 0; i < results.size(); ++i) {
        CAPTURE(i, results[i].lower, results[i].upper);
        CHECK(std::string(to_string(results[i].status)) == to_string(expected[i]));
        CHECK(results[i].upper - results[i].lower <= 1e-6);
        CHECK(results[i].lower <= results[i].upper);
        CHECK(std::abs((results[i].witness.point_a - results[i].witness.point_b).norm() - results[i].upper) < 1e-12);
        CHECK(results[i].witness.step == -1);
    }
    CHECK(results[0].upper == Approx(0.5).epsilon(0).margin(1e-12));
    CHECK(results[2].upper == Approx(0.5).epsilon(0).margin(1e-12));
    CHECK(results[2].a == 1);
    CHECK(results[4].upper == Approx(5e-5).epsilon(0).margin(1e-12));
    CHECK(results[5].upper == Approx(std::hypot(0.5, 0.40005)).epsilon(0).margin(1e-12));
}

TEST_CASE("A pin in a bore as assembled: distance of polygons", "[clearance]") {
    const int n = 24;
    const double pin = 0.005, bore = 0.0053;
    const auto model = model_of({prism(n, pin, 0.03), ring(n, bore, 0.01, 0.02)}, {{0, 0, 0}, {0, 0, 0}});
    const auto result = certify_clearance(model, as_assembled(model), {{0, 1, 3e-4}}, options_with(1e-9))[0];
    const double exact = (bore - pin) * std::cos(M_PI / n);
    CHECK(result.lower <= exact);
    CHECK(result.lower >= exact - 1e-9);
    CHECK(result.upper == Approx(exact).epsilon(0).margin(1e-14));
    CHECK(result.status == PairStatus::violated);  // 0.30 mm between round parts is less between the flats of polygons
}

TEST_CASE("Over the motion: intermediate nodes, time of the witness", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {3, 0, 0}});
    // Nearest at the middle node, (1.7, 0, 0): the ends alone would not show it.
    const auto trajectory = one_step(model, {{{3, 0, 0}, Vector3::Zero()}, {{1.7, 0, 0}, Vector3::Zero()}, {{2.5, 1, 0}, {0, 0, 0.3}}});
    ClearanceOptions options;
    options.motion = true;
    const auto over_motion = certify_clearance(model, trajectory, {{0, 1, 0.1}}, options)[0];
    CHECK(over_motion.upper == Approx(0.2).epsilon(0).margin(1e-6));
    CHECK(over_motion.lower == Approx(0.2).epsilon(0).margin(1e-6));
    CHECK(over_motion.witness.step == 0);
    CHECK(over_motion.witness.time == Approx(2.25).epsilon(0).margin(1e-5));
    options.motion = false;
    const auto as_it_starts = certify_clearance(model, trajectory, {{0, 1, 0.1}}, options)[0];
    CHECK(as_it_starts.upper == Approx(1.5).epsilon(0).margin(1e-12));
    CHECK(as_it_starts.witness.time == 2);
}

TEST_CASE("A lever's tip on an arc: the least distance is that of the arc, not of its chord", "[clearance]") {
    const double reach = std::hypot(1, 0.01);
    const auto model = model_of({box({0.1, 2, 2}), box({1, 0.01, 0.3})}, {{1.2, 0, 0}, {0, 0, 0}});
    auto trajectory = one_step(model, {{{0, 0, 0}, Vector3::Zero()}, {{0, 0, 0}, {0, 0, 2.5 * M_PI}}});  // more than a turn
    trajectory.poses[1][1].rotation = core::kinematics::rotation(Vector3(0, 0, 2.5 * M_PI));
    ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-9;
    const auto result = certify_clearance(model, trajectory, {{0, 1, 0.01}}, options)[0];
    CHECK(result.lower <= 1.1 - reach);
    CHECK(result.upper >= 1.1 - reach);
    CHECK(result.upper - result.lower <= 1e-9);
}

TEST_CASE("The number of threads and the order of pairs change no bit", "[clearance]") {
    std::mt19937 random(4);
    std::vector<Solid> solids;
    std::vector<Vector3> positions;
    for (int i = 0; i < 6; ++i) {
        solids.push_back(random_solid(random, 1));
        positions.push_back(Vector3(3.0 * (i % 3), 3.0 * (i / 3), 0));
    }
    const auto model = model_of(solids, positions);
    std::vector<PairRequest> pairs;
    for (int a = 0; a < 6; ++a)
        for (int b = a + 1; b < 6; ++b) pairs.push_back({a, b, 0.1});
    const auto run = [&](int threads, const std::vector<PairRequest>& requests) {
        const core::base::ThreadLimit limit(threads);
        int reports = 0;
        ClearanceOptions options;
        options.on_pair = [&](int, int of) { reports += of == static_cast<int>(requests.size()); };
        const auto results = certify_clearance(model, as_assembled(model), requests, options);
        CHECK(reports == static_cast<int>(requests.size()));
        return results;
    };
    const auto one = run(1, pairs), four = run(4, pairs);
    const auto reversed = run(2, {pairs.rbegin(), pairs.rend()});
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& last = reversed[pairs.size() - 1 - i];
        CHECK((one[i].lower == four[i].lower && one[i].upper == four[i].upper && one[i].witness.point_a == four[i].witness.point_a));
        CHECK((one[i].lower == last.lower && one[i].upper == last.upper));
    }
}
