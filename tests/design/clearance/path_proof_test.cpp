// SPDX-License-Identifier: MIT
#include "design/clearance/path_proof.hpp"

#include <catch2/catch.hpp>

#include "tests/support/box_mesh.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::design::clearance::path_proof_test {

namespace {

// A box above a plate that goes down to each of these heights in turn, in a step each, and up again.
struct Hopping {
    core::model::Model model;
    core::stepper::Simulation run;

    explicit Hopping(const std::vector<double>& lows) {
        using namespace tests::support;
        using core::kinematics::ChartPoint;
        model.dhat = 1e-3;
        model.bodies = {ground_plate(),
                        make_body("box", box_mesh(Vector3(-0.1, -0.1, 0), Vector3(0.1, 0.1, 0.2)), make_pose({0, 0, 0}, {0, 0, 1}))};
        run.trajectory.body_names = {"plate", "box"};
        run.trajectory.timestep = 0.1;
        const std::vector<core::kinematics::Pose> poses{model.bodies[0].pose_start, model.bodies[1].pose_start};
        run.trajectory.poses = {poses};
        for (const double low : lows) {
            const auto at = [&](double z) {
                return std::vector<ChartPoint>{{model.bodies[0].pose_start.position, Vector3::Zero()}, {Vector3(0, 0, z), Vector3::Zero()}};
            };
            core::stepper::TrajectoryStep step;
            step.nodes = {at(1), at(low), at(1)};
            run.trajectory.steps.push_back(step);
            run.trajectory.poses.push_back(poses);
            run.report.steps.emplace_back().minimum_distance = 1;
        }
    }
};

}  // namespace

TEST_CASE("A path is proven while it is simulated, stretch by stretch") {
    const std::vector<double> lows{0.9, 0.5, 3e-4, 0.2, 0.01, 7e-4, 2e-4, 0.3};
    const double least = 2e-4;
    const auto never = [] { return false; };
    const auto following = [&](const Hopping& whole, int stretch, const std::function<bool()>& should_stop) {
        auto prover = std::make_unique<PathProver>(whole.model, should_stop, stretch);
        for (std::size_t steps = 1; steps <= whole.run.trajectory.steps.size(); ++steps) {
            core::stepper::Simulation so_far = whole.run;
            so_far.trajectory.steps.resize(steps);
            so_far.trajectory.poses.resize(steps + 1);
            so_far.report.steps.resize(steps);
            prover->follow(so_far);
        }
        return prover;
    };
    const Hopping hopping(lows);
    for (const int stretch : {1, 2, 3, 5, 8, 100}) {
        CAPTURE(stretch);
        const PathProof proof = following(hopping, stretch, never)->finish(hopping.run);
        CHECK(proof.state == ProofState::proven);
        CHECK(proof.steps == 8);
        CHECK((*proof.lower >= 0.98 * least && *proof.lower <= least));
    }
    SECTION("what crosses in the middle is found, and where it begins") {
        std::vector<double> crossing = lows;
        crossing[3] = -0.1;
        const Hopping through(crossing);
        for (const int stretch : {1, 2, 3, 5, 8, 100}) {
            CAPTURE(stretch);
            const PathProof proof = following(through, stretch, never)->finish(through.run);
            CHECK(proof.state == ProofState::not_certified);
            CHECK(proof.reason.find("pass through each other") != std::string::npos);
            CHECK(proof.steps == 3 / stretch * stretch);
        }
    }
    SECTION("of a mesh that is not closed the surfaces are proven, and that one may lie inside the other is told") {
        Hopping open(lows);
        auto& around = open.model.bodies[0];  // in place of the plate a block that the box is in, with a hole in it
        const auto block = tests::support::box_mesh(Vector3(-5, -5, -5), Vector3(5, 5, 5));
        auto faces = block.triangles;
        faces.pop_back();
        around = tests::support::make_body("plate", core::geometry::make_mesh("block", block.vertices, faces), around.pose_start);
        around.type = core::scene::BodyType::static_body;
        for (const int stretch : {1, 3, 100}) {
            CAPTURE(stretch);
            const PathProof proof = following(open, stretch, never)->finish(open.run);
            CHECK(proof.state == ProofState::surfaces);
            CHECK(proof.steps == 8);
            CHECK((*proof.lower > 3.7 && *proof.lower <= 3.8));
            CHECK(proof.reason.find("of \"plate\" and \"box\": whether one lies inside the other cannot be verified") == 0);
        }
        Hopping leaving = open;  // through the surface of the open block
        leaving.run.trajectory.steps[3].nodes[1][1].position.z() = 7;
        CHECK(following(leaving, 3, never)->finish(leaving.run).state == ProofState::not_certified);
        around.mass_kind = core::scene::MassKind::area;
        CHECK(following(open, 3, never)->finish(open.run).state == ProofState::proven);
    }
    SECTION("one that is hardly apart is looked at closer") {
        std::vector<double> close = lows;
        close[3] = 1e-9;
        const Hopping touching(close);
        for (const int stretch : {1, 3, 100}) {
            CAPTURE(stretch);
            const PathProof proof = following(touching, stretch, never)->finish(touching.run);
            CHECK(proof.state == ProofState::proven);
            CHECK((*proof.lower > 0.9e-9 && *proof.lower <= 1e-9));
        }
    }
    SECTION("stopped, it holds up to there") {
        bool stop = false;
        const auto prover = following(hopping, 3, [&] { return stop; });
        stop = true;
        const PathProof proof = prover->finish(hopping.run);
        CHECK(proof.state == ProofState::stopped);
        CHECK(proof.steps == 6);
        CHECK((*proof.lower >= 0.98 * 3e-4 && *proof.lower <= 3e-4));
        stop = false;  // it may still be finished
        CHECK(prover->finish(hopping.run).state == ProofState::proven);
    }
}

TEST_CASE("A path is proven, refuted or left open: never taken for granted") {
    core::model::Model model = Hopping({}).model;
    core::stepper::Simulation run;
    const auto to = [&](double lowest) {
        run = Hopping({lowest}).run;
        return prove_path(model, run, [] { return false; });
    };
    CHECK(to(0.5).state == ProofState::proven);
    // As well told wherever the least distance lies beside the contact's width and what the ends of the steps saw.
    for (const double lowest : {0.9, 0.3, 0.02, 2e-3, 1e-3, 7e-4, 3e-4, 1e-4, 2e-5}) {
        const auto told = to(lowest);
        CAPTURE(lowest, *told.lower);
        CHECK(told.state == ProofState::proven);
        CHECK((*told.lower >= 0.98 * lowest && *told.lower <= lowest));
    }
    const auto near = to(1e-7);  // far closer than the ends of the steps saw
    CHECK(near.state == ProofState::proven);
    CHECK(*near.lower > 0.9e-7);
    const auto crossing = to(-0.1);
    CHECK(crossing.state == ProofState::not_certified);
    CHECK(crossing.reason.find("box") != std::string::npos);
    model.dmin = 1e-3;
    CHECK(to(0.5e-3).state == ProofState::not_certified);
    CHECK(to(1.001e-3).state == ProofState::proven);
    const auto stopped = prove_path(model, run, [] { return true; });
    CHECK(stopped.state == ProofState::stopped);
    CHECK_FALSE(stopped.lower);
    model.bodies.pop_back();
    run.trajectory.poses[0].pop_back();
    CHECK(prove_path(model, run, [] { return false; }).state == ProofState::nothing);
}

}  // namespace fettle::design::clearance::path_proof_test
