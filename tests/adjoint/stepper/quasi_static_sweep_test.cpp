// SPDX-License-Identifier: MIT
// The sweeps of quasi-static simulations and of damped ones: backwards against forwards, and both against differences of whole simulations.
#include <catch2/catch.hpp>

#include "adjoint/energy/body_terms_adjoint.hpp"
#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/energy/body_terms.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::stepper::quasi_static_sweep_test {

using namespace fettle::tests::adjoint;

namespace {

using core::scene::BodyType;
using fettle::adjoint::stepper::reverse_sweep;
using fettle::adjoint::stepper::tangent_sweep;
using tests::support::box_mesh;
using tests::support::make_body;
using tests::support::make_pose;
using tests::support::prescribe;

SweepScene still(const std::string& name, std::vector<core::model::Body> bodies, int steps) {
    SweepScene scene{name, {}, steps};
    scene.model.bodies = std::move(bodies);
    scene.model.gravity = {-2, -3, -9.81};
    scene.model.timestep = 0.01;
    scene.model.dhat = 2e-3;
    scene.model.kappa = 2e4;
    scene.model.velocity_tolerance = 1e-6;
    scene.model.diagonal = 0.3;
    scene.model.integrator = core::scene::Integrator::quasi_static;
    scene.model.proximal_weight = core::model::choose_proximal_weight(scene.model);
    return scene;
}

// A block lies in a corner of a floor and two walls, one of which comes nearer and turns; another block lies on it.
SweepScene corner() {
    core::model::Body floor = make_body("floor", box_mesh({-0.3, -0.3, -0.1}, {0.4, 0.3, 0}), {}, BodyType::static_body);
    core::model::Body wall =
        make_body("wall", box_mesh({-0.1, -0.3, 0.001}, {0, 0.4, 0.2}), make_pose({0, 0, 0}, {-0.04, 0, 0.0021}), BodyType::static_body);
    core::model::Body pusher = make_body("pusher", box_mesh({-0.3, -0.1, 0.002}, {0.35, 0, 0.2}),
                                         make_pose({0, 0, 0.02}, {0, -0.05, 0.0021}), BodyType::kinematic_body);
    prescribe(pusher, 1, 0.2);
    prescribe(pusher, 5, 0.3);
    core::model::Body block =
        make_body("block", box_mesh({-0.035, -0.04, -0.03}, {0.04, 0.03, 0.05}), make_pose({0, 0, 0.05}, {0, 0.01, 0.0315}));
    core::model::Body rider =
        make_body("rider", box_mesh({-0.02, -0.03, -0.02}, {0.03, 0.02, 0.02}), make_pose({0, 0, 0.1}, {-0.01, 0.02, 0.1035}));
    block.force = {0.2, -0.1, 0.1};
    return still("corner", {floor, wall, pusher, block, rider}, 6);
}

// A lever on a hinge, driven down at the hinge, leans on an edge; a block that nothing but the lever touches is pushed along.
SweepScene lever() {
    core::model::Body beam = make_body("beam", box_mesh({-0.02, -0.02, -0.01}, {0.15, 0.025, 0.01}), make_pose({0, 0.1, 0}, {0, 0, 0.03}));
    for (const int dof : {0, 1, 3, 5}) prescribe(beam, dof);
    prescribe(beam, 2, -0.1);
    core::model::Body edge = make_body("edge", box_mesh({-0.02, -0.05, -0.02}, {0.02, 0.06, 0.02}), make_pose({0, 0.8, 0}, {0.1, 0, -0.02}),
                                       BodyType::static_body);
    return still("lever", {beam, edge}, 8);
}

// A motor pushes a block over a floor: along the floor nothing holds it, and nothing pushes it but the motor.
SweepScene slide() {
    core::model::Body floor = make_body("floor", box_mesh({-0.3, -0.3, -0.1}, {0.4, 0.35, 0}), {}, BodyType::static_body);
    core::model::Body paddle =
        make_body("paddle", box_mesh({-0.02, -0.01, -0.02}, {0.12, 0.012, 0.02}), make_pose({0, 0, 0.2}, {0, 0, 0.0215}));
    for (const int dof : {0, 1, 3, 4}) prescribe(paddle, dof);
    prescribe(paddle, 5, 0.5);
    core::model::Body box =
        make_body("box", box_mesh({-0.02, -0.02, -0.021}, {0.02, 0.025, 0.03}), make_pose({0, 0, 0.3}, {0.07, 0.075, 0.0222}));
    SweepScene scene = still("slide", {floor, paddle, box}, 10);
    scene.model.gravity = {0, 0, -9.81};
    // Rounding turns the contacts' normals by about 1e-14, and W makes a way of that: softer than it need be here.
    scene.model.proximal_weight /= 50;
    return scene;
}

// A block is driven along under a body that rises on an incline of 60 degrees: the normal force of one round of friction makes
// mu tan(60 deg) of the next one's.
SweepScene wedge(double mu) {
    const double rise = std::acos(0.5);
    const core::kinematics::Pose incline = make_pose({0, -rise, 0}, Vector3::Zero());
    const Vector3 above = incline.rotation * Vector3(-0.05, 0, 0.0012);
    core::model::Body block = make_body("block", box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.02}), {incline.rotation, above});
    for (const int dof : {1, 3, 4, 5}) prescribe(block, dof);
    prescribe(block, 0, 0.1);
    SweepScene scene =
        still("wedge", {make_body("incline", box_mesh({-0.1, -0.1, -0.05}, {0.1, 0.1, 0}), incline, BodyType::static_body), block}, 3);
    scene.model.gravity = {0, 0, -9.81};
    scene = rubbed(scene);
    scene.model.friction.mu.setConstant(mu);
    return scene;
}

SweepScene damped(SweepScene scene) {
    scene.name += ", damped";
    double rate = 20;
    for (core::model::Body& body : scene.model.bodies) body.damping = {rate, 1.7 * rate}, rate *= 0.8;
    return scene;
}

// T about what damps a contact of these scenes critically.
SweepScene with_damped_contacts(SweepScene scene) {
    scene.name += ", contacts damped";
    scene.model.contact_damping_time = 0.005;
    return scene;
}

core::stepper::Simulation simulation_of(const SweepScene& scene, const core::model::Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    return core::stepper::simulate(model, options);
}

std::vector<TrajectoryGradient> random_seeds(const SweepScene& scene, std::mt19937_64& random) {
    std::vector<TrajectoryGradient> seeds;
    for (int s = 0; s < 3; ++s) seeds.push_back(random_seed(scene, random));
    return seeds;
}

// Along a direction, backwards and forwards; @return the derivatives of the seeds' objectives.
Vector3 check_sweeps(const SweepScene& scene, const core::stepper::Trajectory& trajectory, const std::vector<TrajectoryGradient>& seeds,
                     const ModelTangent& direction, double tolerance = 1e-9) {
    const auto gradients = reverse_sweep(scene.model, trajectory, seeds);
    const auto tangents = tangent_sweep(scene.model, trajectory, direction);
    REQUIRE(gradients);
    REQUIRE(tangents);
    Vector3 backwards, forwards;
    for (int s = 0; s < 3; ++s) {
        backwards[s] = pairing(scene, (*gradients)[s], direction);
        forwards[s] = pairing(seeds[s], trajectory, *tangents);
    }
    CAPTURE(backwards.transpose(), forwards.transpose());
    CHECK((backwards - forwards).norm() <= tolerance * forwards.norm());
    return backwards;
}

void check_differences(const SweepScene& scene, const std::vector<TrajectoryGradient>& seeds, const ModelTangent& direction,
                       const VectorX& derivative) {
    const auto objectives = [&](const VectorX& s) {
        const core::stepper::Simulation trial = simulation_of(scene, moved(scene, direction, s[0]));
        VectorX out = VectorX::Constant(3, std::numeric_limits<double>::quiet_NaN());
        if (trial.report.status == core::stepper::SimulationStatus::ok)
            for (int k = 0; k < 3; ++k) out[k] = objective(seeds[k], trial.trajectory);
        return out;
    };
    const auto check = tests::support::check_directional(objectives, VectorX::Zero(1), VectorX::Ones(1), derivative, {1e-4, 0.3, 9});
    CAPTURE(check.step, check.analytic, check.difference);
    CHECK(check.relative_error < 1e-6);
}

void check_scene(const SweepScene& scene, bool differences) {
    const core::stepper::Simulation simulation = simulation_of(scene, scene.model);
    INFO(scene.name << ": " << simulation.report.message);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    std::mt19937_64 random(31);
    const std::vector<TrajectoryGradient> seeds = random_seeds(scene, random);
    const bool still = scene.model.integrator == core::scene::Integrator::quasi_static;
    for (const ParameterKind kind : kinds_of(scene)) {
        const ModelTangent direction = random_direction(scene, kind, random);
        CAPTURE(scene.name, to_string(kind));
        const Vector3 derivative = check_sweeps(scene, simulation.trajectory, seeds, direction);
        const bool unknown = kind == ParameterKind::velocity_start && still;
        if (unknown) CHECK(derivative.norm() == 0);  // it has no velocities
        if (kind == ParameterKind::vertices || kind == ParameterKind::pose_start || kind == ParameterKind::gravity)
            CHECK(derivative.norm() > 0);
        const bool unfelt = kind == ParameterKind::friction && derivative.norm() < 1e-12;  // what is only pushed along goes as it is pushed
        if (differences && !unknown && !unfelt) check_differences(scene, seeds, direction, derivative);
    }
}

}  // namespace

TEST_CASE("quasi-static sweeps: backwards and forwards agree", "[adjoint][quasi_static]") {
    for (const SweepScene& scene : {corner(), lever()}) check_scene(scene, false);
}
TEST_CASE("quasi-static differences: a block in a corner", "[adjoint][quasi_static][slow]") { check_scene(corner(), true); }
TEST_CASE("quasi-static differences: a lever on an edge", "[adjoint][quasi_static]") { check_scene(lever(), true); }

TEST_CASE("quasi-static sweeps: what slides freely goes along with everything", "[adjoint][quasi_static]") {
    // Along the floor the block is held by nothing: whatever tilts floor or gravity is a load, and moves it by W per acceleration, far out
    // of what differences can resolve. The derivative of moving and turning everything in the plane is known, though.
    const SweepScene scene = slide();
    const core::stepper::Simulation simulation = simulation_of(scene, scene.model);
    INFO(simulation.report.message);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    const core::stepper::Trajectory& trajectory = simulation.trajectory;
    CHECK((trajectory.poses.back()[2].position - trajectory.poses.front()[2].position).norm() > 5e-4);
    std::mt19937_64 random(5);
    const std::vector<TrajectoryGradient> seeds = random_seeds(scene, random);
    const Vector3 shift(0.3, -0.2, 0), turn(0, 0, 0.7);
    const double conditioned = 1e-7;  // W kappa/m times the unit roundoff, some contacts: what a solve can give along sliding
    ModelTangent all = fettle::adjoint::zero_model_tangent(scene.model, scene.steps), motor = all;
    for (std::size_t i = 0; i < scene.model.bodies.size(); ++i)
        all.bodies[i].pose_start_dot << shift + turn.cross(scene.model.bodies[i].pose_start.position), turn;
    check_sweeps(scene, trajectory, seeds, all, conditioned);
    const auto tangents = tangent_sweep(scene.model, trajectory, all);
    REQUIRE(tangents);
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
        for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
            Vector6 expected;
            expected << shift + turn.cross(trajectory.poses[t][i].position), turn;
            CAPTURE(t, i);
            CHECK(((*tangents)[t][i] - expected).norm() < conditioned);
        }
    for (Vector6& increment : motor.bodies[1].increment_dot) increment[5] = 0.05;
    CHECK(check_sweeps(scene, trajectory, seeds, motor, conditioned).norm() > 0);
}

TEST_CASE("quasi-static sweeps with friction: backwards, forwards and differences agree", "[adjoint][quasi_static]") {
    check_scene(rubbed(corner()), false);
    for (const SweepScene& scene : {rubbed(lever()), rubbed(slide()), wedge(0.3)}) check_scene(scene, true);
}
TEST_CASE("quasi-static differences with friction: a block in a corner", "[adjoint][quasi_static][slow]") {
    check_scene(rubbed(corner()), true);
}

TEST_CASE("friction that jams is refused, not differentiated as if it had settled", "[adjoint][quasi_static]") {
    const SweepScene scene = wedge(0.95 / std::tan(std::acos(0.5)));
    const core::stepper::Simulation simulation = simulation_of(scene, scene.model);
    INFO(simulation.report.message);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    CHECK(simulation.report.steps.back().friction_rounds == 100);
    CHECK(simulation.trajectory.steps.back().friction_rounds.size() == 2);
    std::mt19937_64 random(1);
    const auto result = reverse_sweep(scene.model, simulation.trajectory, {random_seed(scene, random)});
    REQUIRE(result.errors().size() == 1);
    CHECK(result.errors()[0].message.find("friction jams") != std::string::npos);
    CHECK_FALSE(tangent_sweep(scene.model, simulation.trajectory, fettle::adjoint::zero_model_tangent(scene.model, scene.steps)));
}

TEST_CASE("damped sweeps: backwards and forwards agree", "[adjoint][damping]") {
    for (const SweepScene& scene : all_scenes()) check_scene(damped(scene), false);
}
TEST_CASE("damped differences: free flight", "[adjoint][damping]") { check_scene(damped(free_flight()), true); }
TEST_CASE("damped differences: a motor that may tilt", "[adjoint][damping][slow]") { check_scene(damped(tilting_motor()), true); }

TEST_CASE("sweeps with damped contacts: backwards and forwards agree", "[adjoint][contact_damping]") {
    for (const SweepScene& scene : {stack(), twisted_pair(), tilting_motor(), double_motor(), pusher()})
        check_scene(with_damped_contacts(scene), false);
    check_scene(with_damped_contacts(damped(pusher())), false);
    check_scene(rubbed(with_damped_contacts(damped(stack()))), false);
}
TEST_CASE("differences with damped contacts: a motor that may tilt", "[adjoint][contact_damping]") {
    check_scene(with_damped_contacts(tilting_motor()), true);
}
TEST_CASE("differences with damped contacts: stack, twisted pair, double motor, pusher", "[adjoint][contact_damping][slow]") {
    for (const SweepScene& scene : {stack(), twisted_pair(), double_motor(), pusher()}) check_scene(with_damped_contacts(scene), true);
}

TEST_CASE("damping's moments follow the mass's", "[adjoint][damping]") {
    core::model::Body body = make_body("brick", box_mesh({-0.1, -0.2, -0.1}, {0.3, 0.2, 0.4}), {});
    body.damping = {3, 5};
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto symmetric = [&] {
        const Matrix4 m = Matrix4::NullaryExpr([&] { return uniform(random); });
        return Matrix4(m + m.transpose());
    };
    const Matrix4 dot = symmetric(), bar = symmetric();
    const Matrix4 tangent = fettle::adjoint::energy::damping_moments_tangent(body, dot);
    const double h = 1e-5;
    const auto at = [&](double s) {
        core::model::Body moved = body;
        moved.moments += s * dot;
        return core::energy::damping_moments(moved);
    };
    CHECK(((at(h) - at(-h)) / (2 * h) - tangent).norm() < 1e-7 * tangent.norm());
    const double pairing = fettle::adjoint::energy::damping_moments_adjoint(body, bar).cwiseProduct(dot).sum();
    CHECK(pairing == Approx(bar.cwiseProduct(tangent).sum()).epsilon(1e-12));
}

}  // namespace fettle::adjoint::stepper::quasi_static_sweep_test
