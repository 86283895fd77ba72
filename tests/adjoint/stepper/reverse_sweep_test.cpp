// SPDX-License-Identifier: MIT
#include "adjoint/stepper/reverse_sweep.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::stepper::reverse_sweep_test {

using namespace fettle::tests::adjoint;

namespace {

using fettle::adjoint::stepper::reverse_sweep;
using fettle::adjoint::stepper::tangent_sweep;

core::stepper::Trajectory trajectory_of(const SweepScene& scene) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    core::stepper::Simulation simulation = core::stepper::simulate(scene.model, options);
    INFO(scene.name << ": " << simulation.report.message);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    return std::move(simulation.trajectory);
}

// Position component `axis` of `body` at the end.
TrajectoryGradient end_position(const SweepScene& scene, int body, int axis) {
    TrajectoryGradient seed = fettle::adjoint::zero_trajectory_gradient(scene.steps, count_of(scene.model.bodies));
    seed.pose_bar.back()[body](axis, 3) = 1;
    return seed;
}

}  // namespace

TEST_CASE("the scenes reach every kind of contact", "[adjoint][stepper]") {
    ContactCount sum;
    for (const SweepScene& scene : all_scenes()) {
        const ContactCount count = count_contacts(scene.model, trajectory_of(scene));
        if (scene.name == "twisted pair") CHECK(count.mollified >= 20);
        sum.vertex_face += count.vertex_face;
        sum.edge_edge += count.edge_edge;
        sum.mollified += count.mollified;
    }
    CHECK(sum.vertex_face > 300);
    CHECK(sum.edge_edge > 150);
    CHECK(sum.mollified > 30);
}

TEST_CASE("contacts that a trajectory keeps change no bit of a gradient", "[adjoint][stepper]") {
    std::vector<SweepScene> scenes = all_scenes();
    for (const SweepScene& scene : all_scenes())
        if (scene.name != "free flight") scenes.push_back(rubbed(scene));
    int contacts = 0;
    for (const SweepScene& scene : scenes) {
        INFO(scene.name);
        core::stepper::Trajectory trajectory = trajectory_of(scene);
        std::mt19937_64 random(23);
        const std::vector<TrajectoryGradient> seeds{random_seed(scene, random)};
        const auto with = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(with);
        for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
            core::stepper::TrajectoryStep& step = trajectory.steps[t];
            if (!scene.model.area_weighted) {
                REQUIRE(step.contacts.size() == std::max<std::size_t>(step.friction_rounds.size(), 1));
                CHECK(are_of(*step.contacts.back(), scene.model, trajectory.poses[t + 1]));
                contacts += step.contacts.back()->contacts.count;
            }
            step.contacts.clear();
        }
        const auto without = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(without);
        for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
            CHECK((*with)[0].bodies[i].vertices_bar == (*without)[0].bodies[i].vertices_bar);
            CHECK((*with)[0].bodies[i].pose_start_bar == (*without)[0].bodies[i].pose_start_bar);
        }
    }
    CHECK(contacts > 1000);
}

TEST_CASE("contacts of another model, or of other poses, are not taken", "[adjoint][stepper]") {
    for (const SweepScene& scene : all_scenes()) {
        if (scene.model.area_weighted) continue;
        const core::stepper::Trajectory trajectory = trajectory_of(scene);
        const core::stepper::KeptContacts& kept = *trajectory.steps.back().contacts.back();
        if (kept.contacts.count == 0) continue;
        INFO(scene.name);
        std::vector<core::kinematics::Pose> poses = trajectory.poses.back();
        CHECK(are_of(kept, scene.model, poses));
        core::model::Model other = scene.model;
        other.dhat *= 1 + 1e-15;
        CHECK_FALSE(are_of(kept, other, poses));
        other = scene.model;
        for (core::model::Body& body : other.bodies) body.mesh.vertices.array() += 1e-9 * body.radius;
        CHECK_FALSE(are_of(kept, other, poses));
        poses.back().position[2] += 1e-12;
        CHECK_FALSE(are_of(kept, scene.model, poses));
    }
}

TEST_CASE("backwards and forwards agree", "[adjoint][stepper]") {
    std::vector<SweepScene> scenes = all_scenes();
    for (const SweepScene& scene : all_scenes())
        if (scene.name != "free flight") scenes.push_back(rubbed(scene));
    for (const SweepScene& scene : scenes) {
        const core::stepper::Trajectory trajectory = trajectory_of(scene);
        std::mt19937_64 random(17);
        std::vector<TrajectoryGradient> seeds;
        for (int s = 0; s < 4; ++s) seeds.push_back(random_seed(scene, random));
        const auto gradients = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(gradients);
        for (const ParameterKind kind : kinds_of(scene))
            for (int trial = 0; trial < 3; ++trial) {
                const ModelTangent direction = random_direction(scene, kind, random);
                const auto tangents = tangent_sweep(scene.model, trajectory, direction);
                REQUIRE(tangents);
                Eigen::Vector4d backwards, forwards;
                for (int s = 0; s < 4; ++s) {
                    backwards[s] = pairing(scene, (*gradients)[s], direction);
                    forwards[s] = pairing(seeds[s], trajectory, *tangents);
                }
                CAPTURE(scene.name, to_string(kind), backwards.transpose(), forwards.transpose());
                CHECK((backwards - forwards).norm() <= 1e-10 * forwards.norm());
                if (kind != ParameterKind::increments || scene.name != "free flight") CHECK(forwards.norm() > 0);
            }
        const ModelTangent direction = vertex_gradient_direction(scene, (*gradients)[0]);
        const auto tangents = tangent_sweep(scene.model, trajectory, direction);
        REQUIRE(tangents);
        CAPTURE(scene.name);
        CHECK(pairing(scene, (*gradients)[0], direction) == Approx(pairing(seeds[0], trajectory, *tangents)).epsilon(1e-10));
    }
}

TEST_CASE("where rounds of friction ended is kept for gradients alone", "[adjoint][stepper]") {
    const SweepScene scene = rubbed(stack());
    core::stepper::SimulationOptions options;
    options.steps = 4;
    for (const auto& step : core::stepper::simulate(scene.model, options).trajectory.steps) CHECK(step.friction_rounds.empty());
    options.for_gradient = true;
    const core::stepper::Simulation done = core::stepper::simulate(scene.model, options);
    for (std::size_t t = 0; t < done.trajectory.steps.size(); ++t) {
        const auto& rounds = done.trajectory.steps[t].friction_rounds;
        REQUIRE(count_of(rounds) == done.report.steps[t].friction_rounds);
        for (std::size_t i = 0; i < scene.model.bodies.size(); ++i)
            CHECK(rounds.back()[i].position == done.trajectory.poses[t + 1][i].position);
    }
    CHECK(done.report.steps.back().friction_rounds == 2);
    for (const auto& step : core::stepper::simulate(stack().model, options).trajectory.steps) CHECK(step.friction_rounds.empty());
}

TEST_CASE("many seeds give what each gives alone", "[adjoint][stepper]") {
    const SweepScene scene = tilting_motor();
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    std::mt19937_64 random(2);
    const std::vector<TrajectoryGradient> seeds{random_seed(scene, random), random_seed(scene, random)};
    const auto together = reverse_sweep(scene.model, trajectory, seeds);
    REQUIRE(together);
    for (int s = 0; s < 2; ++s) {
        const auto alone = reverse_sweep(scene.model, trajectory, {seeds[s]});
        REQUIRE(alone);
        for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
            const auto &a = (*together)[s].bodies[i], &b = (*alone)[0].bodies[i];
            CHECK((a.vertices_bar - b.vertices_bar).norm() <= 1e-12 * b.vertices_bar.norm());
            CHECK((a.pose_start_bar - b.pose_start_bar).norm() <= 1e-12 * b.pose_start_bar.norm());
        }
    }
    CHECK(reverse_sweep(scene.model, trajectory, {})->empty());
}

TEST_CASE("free fall has the derivatives of its closed form", "[adjoint][stepper]") {
    // z_T = z_0 + v T + (g + f/m) h^2 N (N + 1)/2 for implicit Euler; the body is centred, so that it does not turn.
    SweepScene scene{"fall", {}, 30};
    scene.model.gravity = {0, 0, -9.81};
    scene.model.timestep = 0.01;
    scene.model.velocity_tolerance = 1e-6;
    scene.model.kappa = 1e4;
    scene.model.bodies.push_back(tests::support::make_body("ball", tests::support::box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}),
                                                           tests::support::make_pose({0, 0, 0}, {1, 2, 30})));
    tests::support::set_velocity(scene.model.bodies[0], {0, 0, 3}, {0, 0, 0});
    scene.model.bodies[0].force = {0, 0, 7};
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    const auto gradients = reverse_sweep(scene.model, trajectory, {end_position(scene, 0, 2)});
    REQUIRE(gradients);
    const fettle::adjoint::BodyGradient& bar = (*gradients)[0].bodies[0];
    const double h = 0.01, n = scene.steps, time = n * h, fall = h * h * n * (n + 1) / 2, mass = 8;
    CHECK(trajectory.poses.back()[0].position.z() == Approx(30 + 3 * time + (7 / mass - 9.81) * fall).epsilon(1e-12));
    CHECK(bar.pose_start_bar(2, 3) == Approx(1).epsilon(1e-12));
    CHECK(bar.velocity_start_bar(2, 3) == Approx(time).epsilon(1e-12));
    CHECK((*gradients)[0].gravity_bar.z() == Approx(fall).epsilon(1e-12));
    CHECK(bar.force_bar.z() == Approx(fall / mass).epsilon(1e-12));
    // From P - P_hat, of size h^2 f/m = 1e-4 m at z = 30 m: ten digits.
    CHECK(bar.density_bar == Approx(-fall * 7 / mass / 1000).epsilon(1e-9));
    CHECK(std::abs((*gradients)[0].gravity_bar.x()) < 1e-14);
}

TEST_CASE("a scripted body has the derivatives of its script", "[adjoint][stepper]") {
    SweepScene scene{"script", {}, 10};
    scene.model.timestep = 0.1;
    scene.model.kappa = 1e4;
    scene.model.bodies.push_back(tests::support::make_body("crank", tests::support::box_mesh({0, 0, 0}, {1, 0.1, 0.1}),
                                                           tests::support::make_pose({0, 0, 0.3}, {1, 0, 0}),
                                                           core::scene::BodyType::kinematic_body));
    tests::support::prescribe(scene.model.bodies[0], 1, 0.5);
    tests::support::prescribe(scene.model.bodies[0], 5, 2);
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    // J = height of the tip (1, 0, 0) over y: 0.5 T + sin(0.3 + 2 T).
    TrajectoryGradient seed = end_position(scene, 0, 1);
    seed.pose_bar.back()[0](1, 0) = 1;
    const auto gradients = reverse_sweep(scene.model, trajectory, {seed});
    REQUIRE(gradients);
    for (const Vector6& bar : (*gradients)[0].bodies[0].increment_bar) {
        CHECK(bar[1] == Approx(1).epsilon(1e-13));
        CHECK(bar[5] == Approx(std::cos(2.3)).epsilon(1e-12));
    }
    CHECK((*gradients)[0].bodies[0].pose_start_bar(1, 3) == Approx(1).epsilon(1e-13));
}

TEST_CASE("moving everything moves the result as much", "[adjoint][stepper]") {
    const SweepScene scene = GENERATE(stack(), rubbed(stack()));
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    const Vector3 shift(0.3, -0.2, 0.5), turn(0.4, 0.7, -0.2);
    ModelTangent direction = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    direction.gravity_dot = turn.cross(scene.model.gravity);
    for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
        const core::model::Body& body = scene.model.bodies[i];
        direction.bodies[i].pose_start_dot << shift + turn.cross(body.pose_start.position), turn;
        direction.bodies[i].velocity_start_dot = cross_matrix(turn) * body.velocity_start;
        direction.bodies[i].force_dot = turn.cross(body.force);
    }
    const auto tangents = tangent_sweep(scene.model, trajectory, direction);
    REQUIRE(tangents);
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
        for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
            Vector6 expected;
            expected << shift + turn.cross(trajectory.poses[t][i].position), turn;
            CAPTURE(t, i);
            CHECK(((*tangents)[t][i] - expected).norm() < 1e-9);
        }
    std::mt19937_64 random(5);
    const TrajectoryGradient seed = random_seed(scene, random);
    const auto gradients = reverse_sweep(scene.model, trajectory, {seed});
    REQUIRE(gradients);
    CHECK(pairing(scene, (*gradients)[0], direction) == Approx(pairing(seed, trajectory, *tangents)).epsilon(1e-10));
}

TEST_CASE("another frame for a body's shape is the same body", "[adjoint][stepper]") {
    // Vertices move by c, the start pose by - R c, the start velocity by - Rdot c: the world sees nothing.
    SweepScene scene = GENERATE(stack(), rubbed(stack()));
    const int body = 3;
    scene.model.bodies[body].force.setZero();  // it acts at the reference point
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    const Vector3 c(0.02, -0.01, 0.03);
    ModelTangent direction = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    direction.bodies[body].vertices_dot.colwise() += c;
    direction.bodies[body].pose_start_dot.head<3>() = -scene.model.bodies[body].pose_start.rotation * c;
    direction.bodies[body].velocity_start_dot.col(3) = -scene.model.bodies[body].velocity_start.leftCols<3>() * c;
    const auto tangents = tangent_sweep(scene.model, trajectory, direction);
    REQUIRE(tangents);
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
        for (int i = 0; i < count_of(scene.model.bodies); ++i) {
            Vector6 expected = Vector6::Zero();
            if (i == body) expected.head<3>() = -trajectory.poses[t][i].rotation * c;
            CAPTURE(t, i);
            CHECK(((*tangents)[t][i] - expected).norm() < 1e-9 * c.norm());
        }
}

TEST_CASE("what cannot be differentiated is refused by name", "[adjoint][stepper]") {
    SweepScene scene = free_flight();
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    const std::vector<TrajectoryGradient> seeds{end_position(scene, 0, 0)};
    SECTION("mass from elsewhere") {
        scene.model.bodies[0].moments(3, 3) *= 1.1;
        const auto result = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE_FALSE(result);
        CHECK(result.errors()[0].code == core::base::ErrorCode::unsupported);
        CHECK(result.errors()[0].message.find("brick") != std::string::npos);
        CHECK_FALSE(tangent_sweep(scene.model, trajectory, fettle::adjoint::zero_model_tangent(scene.model, scene.steps)));
    }
    const auto refused = [&](const std::string& what) {
        const auto result = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(result.errors().size() == 1);
        CAPTURE(result.errors()[0].message);
        CHECK(result.errors()[0].code == core::base::ErrorCode::unsupported);
        CHECK(result.errors()[0].message.find(what) != std::string::npos);
        CHECK(tangent_sweep(scene.model, trajectory, fettle::adjoint::zero_model_tangent(scene.model, scene.steps)).errors().size() == 1);
    };
    SECTION("area weights: two edges of the same area in contact") {
        SweepScene two = stack();
        two.model.area_weighted = true;
        two.model.kappa *= 1e4;
        const std::vector<TrajectoryGradient> end{end_position(two, 0, 0)};
        two.model.bodies[2].mesh = two.model.bodies[1].mesh;
        tests::support::refresh(two.model.bodies[2]);
        two.model.bodies[2].pose_start = tests::support::make_pose({0.01, 0, 0.6}, {0.001, 0.002, 0.117});
        const auto result = reverse_sweep(two.model, trajectory_of(two), end);
        REQUIRE(result.errors().size() == 1);
        CAPTURE(result.errors()[0].message);
        CHECK(result.errors()[0].where.find("step ") == 0);
        CHECK(result.errors()[0].message.find("have the same area") != std::string::npos);
    }
    SECTION("scripts") {
        core::model::Body& brick = scene.model.bodies[0];
        brick.type = core::scene::BodyType::kinematic_body;
        brick.prescribed.fill(core::scene::MotionCurve{});
        brick.script.times = {1};
        brick.script.poses = {brick.pose_start};
        refused("'brick' follows a script");
    }
    SECTION("friction of which the trajectory holds no rounds") {
        SweepScene two = stack();
        core::stepper::Trajectory path = trajectory_of(two);
        const std::vector<TrajectoryGradient> end{end_position(two, 0, 0)};
        const auto refused_with = [&](const std::string& word) {
            const auto result = reverse_sweep(two.model, path, end);
            REQUIRE(result.errors().size() == 1);
            CHECK(result.errors()[0].where == "step 0");
            CHECK(result.errors()[0].message.find(word) != std::string::npos);
            CHECK_FALSE(tangent_sweep(two.model, path, fettle::adjoint::zero_model_tangent(two.model, two.steps)));
        };
        two.model.friction.mu.setConstant(0.5);
        refused_with("rounds of friction");
        path = trajectory_of(two);
        CHECK(reverse_sweep(two.model, path, end));
        for (core::model::Body& body : two.model.bodies) body.group = 1;  // no two may touch
        CHECK(reverse_sweep(two.model, trajectory_of(two), end));
    }
    SECTION("a full turn in one step") {
        core::stepper::Trajectory fast = trajectory;
        fast.steps[3].nodes.back()[0].rotation_vector = {0, 6.3, 0};
        const auto result = reverse_sweep(scene.model, fast, seeds);
        REQUIRE_FALSE(result);
        CHECK(result.errors()[0].code == core::base::ErrorCode::out_of_range);
        CHECK(result.errors()[0].where == "step 3");
    }
    SECTION("another stiffness of contact than the trajectory was solved with, and a solve that is no gradient's") {
        SweepScene two = stack();
        core::stepper::Trajectory path = trajectory_of(two);
        const std::vector<TrajectoryGradient> end{end_position(two, 0, 0)};
        const auto out_of_balance = [&] {
            const auto result = reverse_sweep(two.model, path, end);
            REQUIRE(result.errors().size() == 1);
            CAPTURE(result.errors()[0].message);
            CHECK(result.errors()[0].where.find("step ") == 0);
            CHECK(result.errors()[0].message.find("out of balance") != std::string::npos);
            CHECK_FALSE(tangent_sweep(two.model, path, fettle::adjoint::zero_model_tangent(two.model, two.steps)));
        };
        const double kappa = two.model.kappa;
        two.model.kappa *= 1.1;
        out_of_balance();
        two.model.kappa = kappa;
        core::stepper::SimulationOptions options;
        options.steps = two.steps;
        two.model.adaptive_kappa = true;  // from ten times as much
        path = core::stepper::simulate(two.model, options).trajectory;
        out_of_balance();
        two.model.adaptive_kappa = false;
        two.model.velocity_tolerance = 0.1;
        path = core::stepper::simulate(two.model, options).trajectory;
        out_of_balance();
    }
    SECTION("a light body out of balance, which a norm over all would not show") {
        SweepScene pair = free_flight();
        core::model::Body light = pair.model.bodies[0];
        light.name = "feather";
        light.density *= 1e-3;
        light.force *= 1e-3;
        tests::support::refresh(light);
        pair.model.bodies.push_back(light);
        for (core::model::Body& body : pair.model.bodies) body.group = 0;
        core::stepper::Trajectory path = trajectory_of(pair);
        const std::vector<TrajectoryGradient> end{end_position(pair, 0, 0)};
        const auto before = reverse_sweep(pair.model, path, end);
        CAPTURE(before ? "" : before.errors()[0].message);
        REQUIRE(before);
        path.poses[3][1].position.x() += 1e-3;
        path.steps[2].nodes.back()[1].position.x() += 1e-3;
        const auto result = reverse_sweep(pair.model, path, end);
        REQUIRE_FALSE(result);
        CHECK(result.errors()[0].message.find("'feather' is out of balance") != std::string::npos);
    }
    SECTION("steps that are not those of a simulation from its start") {
        core::stepper::Trajectory late = trajectory, uneven = trajectory;
        late.time_start = 0.5;
        for (std::size_t t = 0; t < uneven.poses.size(); ++t) uneven.times.push_back(0.01 * static_cast<double>(t));
        for (const core::stepper::Trajectory* path : {&late, &uneven}) {
            const auto result = reverse_sweep(scene.model, *path, seeds);
            REQUIRE(result.errors().size() == 1);
            CHECK(result.errors()[0].where == "trajectory");
        }
    }
    SECTION("a prescribed motion that ends short of where it leads") {
        SweepScene pushed = pusher();
        const core::stepper::Trajectory path = trajectory_of(pushed);
        const std::vector<TrajectoryGradient> end{end_position(pushed, 0, 0)};
        for (const double off : {1e-13, 1e-9}) {
            core::stepper::Trajectory moved = path;
            moved.poses[4][0].position.x() -= off;
            moved.steps[3].nodes.back()[0].position.x() -= off;
            const auto result = reverse_sweep(pushed.model, moved, end);
            CAPTURE(off, result ? "" : result.errors()[0].message);
            REQUIRE(bool(result) == (off < 1e-12));
            if (result) continue;
            CHECK(result.errors()[0].where == "step 3");
            CHECK(result.errors()[0].message.find("'pusher' ends the step at t = 0.03 s 1e-09 m from where") == 0);
            CHECK_FALSE(tangent_sweep(pushed.model, moved, fettle::adjoint::zero_model_tangent(pushed.model, pushed.steps)));
        }
    }
    SECTION("a body without mass") {
        scene.model.bodies[0].density = 0;
        scene.model.bodies[0].force.setZero();
        tests::support::refresh(scene.model.bodies[0]);
        const auto result = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE_FALSE(result);
        CHECK(result.errors()[0].message.find("singular") != std::string::npos);
    }
}

}  // namespace fettle::adjoint::stepper::reverse_sweep_test
