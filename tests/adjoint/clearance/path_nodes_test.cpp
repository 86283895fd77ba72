// SPDX-License-Identifier: MIT
// Nodes inside a step: where a prescribed motion changes the certified clearance of whole simulations is differentiated as it is; what a
// free body did on its way has no derivative, which is said.
#include "adjoint/clearance/path_nodes.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "adjoint/clearance/clearance_adjoint.hpp"
#include "adjoint/stepper/seeded_sweep.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"
#include "tests/support/text.hpp"

namespace fettle::adjoint::clearance::path_nodes_test {

namespace {

using namespace fettle::tests::support;
using core::clearance::PairClearance;
using core::model::Model;
using core::scene::BodyType;

constexpr int arm = 0, post = 1, ball = 2, steps = 3;

// The arm goes towards the post, turning, turns round inside the second step and goes back; there it is nearest. Its turn stops inside the
// step, later. The ball flies where nothing is.
Model there_and_back() {
    Model model;
    model.bodies = {
        make_body("arm", box_mesh({-0.3, -0.1, -0.05}, {0.3, 0.1, 0.05}), make_pose({0.4, -0.3, 0.2}, {0, 0.1, 0}),
                  BodyType::kinematic_body),
        make_body("post", box_mesh({-0.1, -0.1, -0.3}, {0.1, 0.1, 0.3}), make_pose({-0.2, 0.5, 0.1}, {1.3, 0, 0.1}), BodyType::static_body),
        make_body("ball", box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), make_pose({0.1, 0, 0}, {0, 5, 0}))};
    auto& motion = model.bodies[arm].prescribed;
    motion[0] = core::scene::MotionCurve{0.2, {0, 0.13, 0.3}, {0, 0.4, 0}, std::nullopt};
    motion[1] = core::scene::MotionCurve{0, {0, 0.13, 0.3}, {0, 0.05, 0.2}, std::nullopt};
    motion[5] = core::scene::MotionCurve{0.5, {}, {}, 0.16};
    set_velocity(model.bodies[ball], {0, 0.3, 0}, {0, 0.2, 1});
    model.timestep = 0.1;
    model.end_time = 0.1 * steps;
    model.dhat = 1e-3;
    model.diagonal = 4;
    model.gravity = Vector3::Zero();
    model.velocity_tolerance = 1e-4;
    model.kappa = core::model::choose_kappa(model);
    return model;
}

core::stepper::Trajectory simulated(const Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = steps;
    options.for_gradient = true;
    const core::stepper::Simulation run = core::stepper::simulate(model, options);
    INFO(run.report.message);
    REQUIRE(run.report.status == core::stepper::SimulationStatus::ok);
    return run.trajectory;
}

PairClearance certified(const Model& model, const core::stepper::Trajectory& trajectory, int a, int b) {
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-10;
    return core::clearance::certify(model, trajectory, {{a, b, 0}}, options).front();
}

// Start poses of arm and post, rates of the arm's x and turn about z, one vertex in four of both.
constexpr Eigen::Index poses_end = 12, rates_end = 14;
Eigen::Index coordinate_count(const Model& model) {
    return rates_end + 3 * (model.bodies[arm].mesh.vertices.cols() + model.bodies[post].mesh.vertices.cols());
}

Model moved(Model model, const VectorX& d) {
    Eigen::Index at = rates_end;
    for (const int i : {arm, post}) {
        core::model::Body& body = model.bodies[i];
        body.pose_start.position += d.segment<3>(6 * i);
        body.pose_start.rotation = core::kinematics::rotation(Vector3(d.segment<3>(6 * i + 3))) * body.pose_start.rotation;
        for (Eigen::Index v = 0; v < body.mesh.vertices.cols(); ++v, at += 3) body.mesh.vertices.col(v) += d.segment<3>(at);
        refresh(body);
    }
    model.bodies[arm].prescribed[0]->rate += d[poses_end];
    model.bodies[arm].prescribed[5]->rate += d[poses_end + 1];
    return model;
}

// d(increments)/d(rate) of a step, as whoever has a rate for a parameter chains them.
double running(const core::scene::MotionCurve& curve, int t) {
    const double begin = 0.1 * t, end = 0.1 * (t + 1), stop = curve.stop_time.value_or(end);
    return std::min(end, stop) - std::min(begin, stop);
}

VectorX gradient_of(const Model& model, const core::stepper::Trajectory& trajectory, const PairClearance& pair) {
    std::vector<Seeds> seeds{zero_seeds(model, steps)};
    REQUIRE(clearance_adjoint(model, trajectory, pair, 1, seeds[0].trajectory_bar, seeds[0].model_bar).empty());
    const auto swept = stepper::seeded_sweep(model, trajectory, seeds);
    REQUIRE(swept);
    VectorX out = VectorX::Zero(coordinate_count(model));
    Eigen::Index at = rates_end;
    for (const int i : {arm, post}) {
        const BodyGradient& bar = swept->front().bodies[i];
        const Matrix3& rotation = model.bodies[i].pose_start.rotation;
        out.segment<3>(6 * i) = bar.pose_start_bar.col(3);
        for (int k = 0; k < 3; ++k)
            out[6 * i + 3 + k] = (bar.pose_start_bar.leftCols<3>().transpose() * cross_matrix(Vector3::Unit(k)) * rotation).trace();
        for (Eigen::Index v = 0; v < bar.vertices_bar.cols(); ++v, at += 3) out.segment<3>(at) = bar.vertices_bar.col(v);
    }
    const BodyGradient& bar = swept->front().bodies[arm];
    for (int t = 0; t < steps; ++t) {
        out[poses_end] += bar.increment_bar[t][0] * running(*model.bodies[arm].prescribed[0], t);
        out[poses_end + 1] += bar.increment_bar[t][5] * running(*model.bodies[arm].prescribed[5], t);
    }
    return out;
}

}  // namespace

TEST_CASE("Where a prescribed motion turns round inside a step, the clearance there has its derivative", "[clearance][adjoint]") {
    Model model = there_and_back();
    for (const bool stops_first : {false, true}) {
        if (stops_first) model.bodies[arm].prescribed[5]->stop_time = 0.12;
        const auto trajectory = simulated(model);
        const PairClearance pair = certified(model, trajectory, arm, post);
        REQUIRE(trajectory.steps[1].nodes.size() == 4);
        CAPTURE(pair.witness.step, pair.witness.segment, pair.witness.s, pair.upper);
        REQUIRE(pair.witness.step == 1);
        REQUIRE(pair.witness.time == Approx(0.13));
        const VectorX gradient = gradient_of(model, trajectory, pair);
        const auto upper = [&](const VectorX& d) {
            const Model other = moved(model, d);
            return certified(other, simulated(other), arm, post).upper;
        };
        StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 4;
        const auto check = check_gradient(upper, VectorX::Zero(gradient.size()), gradient, sweep);
        CAPTURE(check.column, check.analytic, check.difference, check.step);
        CHECK(check.relative_error < 1e-7);
        CHECK(gradient.segment<3>(3).norm() > 1e-2);  // how the arm is turned at the start counts
        CHECK(std::abs(gradient[poses_end]) > 0.1);   // and how far the rate has led it
        CHECK(std::abs(gradient[poses_end + 1]) > 1e-3);
    }
}

TEST_CASE("A body that moves freely through a step that is cut has no derivative inside it", "[clearance][adjoint]") {
    Model model = there_and_back();
    model.bodies[ball].pose_start.position = {1.1, 0.1, 0};
    set_velocity(model.bodies[ball], {0, 0, 0}, {0, 0.01, 0.02});
    const auto trajectory = simulated(model);
    const PairClearance pair = certified(model, trajectory, arm, ball);
    CAPTURE(pair.witness.step, pair.witness.segment, pair.witness.s);
    REQUIRE(pair.witness.step == 1);
    std::vector<Seeds> seeds{zero_seeds(model, steps)};
    const std::string refusal = clearance_adjoint(model, trajectory, pair, 1, seeds[0].trajectory_bar, seeds[0].model_bar);
    CHECK(contains(refusal, "step 2: 'arm' and 'ball' are nearest beside a node inside the step"));
    // Through the sweep of a whole evaluation too.
    seeds[0].refusal = refusal;
    const auto swept = stepper::seeded_sweep(model, trajectory, seeds);
    REQUIRE(!swept);
    CHECK(swept.errors()[0].message == refusal);
}

namespace {

// A cube thrown past an edge, spinning: corners and edges of the two meet, and the way round them bends inside steps.
Model thrown(std::mt19937& random) {
    std::uniform_real_distribution<double> u(-1, 1);
    const auto vector = [&] { return Vector3(u(random), u(random), u(random)); };
    Model model;
    model.bodies = {
        make_body("cube", box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), make_pose(vector(), {-0.35, 0.1 * u(random), 0})),
        make_body("edge", box_mesh({-0.1, -0.1, -0.3}, {0.1, 0.1, 0.3}), make_pose(0.5 * vector(), {0, 0, 0}), BodyType::static_body)};
    set_velocity(model.bodies[0], Vector3(2, 0, 0) + 0.3 * vector(), 12 * vector());
    model.timestep = 0.02;
    model.end_time = 0.02 * 12;
    model.dhat = 2e-3;
    model.diagonal = 1;
    model.gravity = Vector3::Zero();
    model.velocity_tolerance = 1e-4;
    model.kappa = core::model::choose_kappa(model);
    return model;
}

core::stepper::Trajectory thrown_path(const Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = 12;
    options.for_gradient = true;
    return core::stepper::simulate(model, options).trajectory;
}

}  // namespace

TEST_CASE("Through contact a clearance's derivative is that of whole simulations, or is refused", "[clearance][adjoint]") {
    int right = 0, refused = 0, cut = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        std::mt19937 random(seed);
        const Model model = thrown(random);
        const auto trajectory = thrown_path(model);
        if (trajectory.steps.size() != 12) continue;
        const PairClearance pair = certified(model, trajectory, 0, 1);
        for (const auto& step : trajectory.steps) cut += step.nodes.size() > 2;
        std::vector<Seeds> seeds{zero_seeds(model, 12)};
        const std::string refusal = clearance_adjoint(model, trajectory, pair, 1, seeds[0].trajectory_bar, seeds[0].model_bar);
        CAPTURE(seed, pair.witness.step, pair.witness.segment, pair.witness.s, pair.upper, refusal);
        refused += !refusal.empty();
        if (!refusal.empty()) continue;
        const auto swept = stepper::seeded_sweep(model, trajectory, seeds);
        REQUIRE(swept);
        const Vector3 along = Vector3(0.3, 0.8, -0.5).normalized();
        const double derivative = along.dot(swept->front().bodies[0].velocity_start_bar.col(3));
        const auto upper = [&](double h) {
            Model other = model;
            other.bodies[0].velocity_start.col(3) += h * along;
            return certified(other, thrown_path(other), 0, 1).upper;
        };
        double best = 1e9;
        for (const double h : {1e-4, 1e-5, 1e-6})
            best = std::min(best, std::abs((upper(h) - upper(-h)) / (2 * h) - derivative) / (std::abs(derivative) + 1e-3));
        CAPTURE(derivative, best);
        CHECK(best < 1e-4);
        right += best < 1e-4;
    }
    CAPTURE(right, refused, cut);
    CHECK(right >= 10);
    CHECK(refused >= 1);
}

}  // namespace fettle::adjoint::clearance::path_nodes_test
