// SPDX-License-Identifier: MIT
// Wires that fly end-on at one another never pass. The path is judged by distances in exact rational arithmetic alone: between two places
// that are farther apart than the wires travel from there, nothing can have met.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/exact_ccd.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::tests::scenes::wires_test {

using namespace fettle::core;

namespace {

scene::Body wire(const char* name, scene::BodyType type, const Matrix3& rotation, const Vector3& position, const Vector3& velocity) {
    scene::Body body;
    body.name = name;
    body.type = type;
    Matrix3X vertices(3, 2);
    vertices << Vector3(0, 0, 0), Vector3(1, 0, 0);
    body.mesh.name = name;
    body.mesh.vertices = vertices;
    geometry::build_connectivity(body.mesh, {{0, 1}});
    body.mass_kind = scene::MassKind::length;
    body.density = 1;
    body.pose = {rotation, position};
    body.linear_velocity = velocity;
    if (type == scene::BodyType::static_body)
        for (auto& dof : body.prescribed) dof = scene::MotionCurve{};
    return body;
}

model::Model wires(const Matrix3& rotation, const Vector3& position, const Vector3& velocity) {
    scene::Scene scene;
    scene.timestep = 0.01;
    scene.dhat = 1e-3;
    scene.bodies = {wire("a", scene::BodyType::static_body, rotation, {0, 0, 0}, {0, 0, 0}),
                    wire("b", scene::BodyType::dynamic_body, rotation, position, velocity)};
    auto model = setup::build_model(scene);
    REQUIRE(model.has_value());
    return *model;
}

/// Both wires' vertices at s of segment k of step t.
geometry::PairVertices vertices_at(const model::Model& model, const stepper::Trajectory& trajectory, int t, int k, double s) {
    geometry::PairVertices x;
    for (int i = 0; i < 4; ++i) x[i] = world_position(pose_at(trajectory, t, k, s, i / 2), model.bodies[i / 2].mesh.vertices.col(i % 2));
    return x;
}

/// Is it certain that the wires do not meet between s0 and s1? By halves, until the distance in the middle exceeds the way from there.
bool stay_apart(const model::Model& model, const stepper::Trajectory& trajectory, int t, int k, double s0, double s1, double speed) {
    const geometry::PairVertices x = vertices_at(model, trajectory, t, k, 0.5 * (s0 + s1));
    const double way = 0.5 * (s1 - s0) * speed;
    if (!tests::exact_distance_at_most(geometry::PairType::edge_edge, x, x, 0, way + 1e-14)) return true;
    if (s1 - s0 < 1e-13) return false;
    return stay_apart(model, trajectory, t, k, s0, 0.5 * (s0 + s1), speed) &&
           stay_apart(model, trajectory, t, k, 0.5 * (s0 + s1), s1, speed);
}

bool never_meet(const model::Model& model, const stepper::Trajectory& trajectory) {
    for (int t = 0; t < count_of(trajectory.steps); ++t)
        for (int k = 0; k < segment_count(trajectory, t); ++k) {
            double speed = 0;
            for (int body = 0; body < 2; ++body) {
                const kinematics::PathSegment s = path_segment(trajectory, t, k, body);
                speed += s.position_step.norm() + s.rotation_vector_step.norm() * model.bodies[body].radius;
            }
            if (!stay_apart(model, trajectory, t, k, 0, 1, speed * (1 + 1e-9))) return false;
        }
    return true;
}

stepper::Simulation one_step(const model::Model& model) {
    stepper::SimulationOptions options;
    options.steps = 1;
    return stepper::simulate(model, options);
}

void fly_at_one_another(int pairs, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    int arrived = 0;
    for (int i = 0; i < pairs; ++i) {
        const Matrix3 rotation =
            Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
        const Vector3 along = rotation.col(0);
        // Exactly along, or a little aside, or more so: some of these get past one another.
        const double aside = i % 3 == 0 ? 0 : std::pow(10.0, (i % 3 == 1 ? -18 : -4) + 3 * uniform(random));
        const double gap = std::pow(10.0, -5 * uniform(random)), way = gap + 0.1 + 2 * uniform(random);
        const double side = i % 2 ? 1 : -1;
        const model::Model model = wires(rotation, side * (1 + gap) * along + aside * rotation.col(1), -side * (way / 0.01) * along);
        const stepper::Simulation simulation = one_step(model);
        INFO("pair " << i << ", gap " << gap << ", aside " << aside);
        REQUIRE(never_meet(model, simulation.trajectory));
        if (simulation.report.status != stepper::SimulationStatus::ok) continue;
        ++arrived;
        if (aside > 1e-14) continue;
        // Beside one another they cannot be: still on the side from which it came.
        REQUIRE(side * simulation.trajectory.poses[1][1].position.dot(along) >
                side * simulation.trajectory.poses[1][0].position.dot(along) + 1);
    }
    CHECK(arrived > pairs / 6);
}

}  // namespace

TEST_CASE("two wires do not pass through each other end-on") {
    // As read from a file: the last bits of the rotations matter.
    const tests::support::TemporaryFolder folder;
    const std::string path =
        folder.write("wires.scene.json", R"({"fettle_scene": 1, "units": "m", "gravity": [0, 0, 0], "timestep": 0.01, "end_time": 0.01,
        "contact": {"dhat": 0.001}, "bodies": [
        {"name": "a", "vertices": [[0, 0, 0], [1, 0, 0]], "edges": [[0, 1]], "type": "static", "rotation": [24, 15, 61]},
        {"name": "b", "vertices": [[0, 0, 0], [1, 0, 0]], "edges": [[0, 1]], "mass_per": "length", "density": 1, "rotation": [24, 15, 61],
         "position": [0.48031750995645456, 0.8665157256545014, -0.2654664501871178],
         "linear_velocity": [-22.395771348614076, -40.40304102903929, 12.377907937726317]}]})");
    const auto scene = scene_files::read_scene(path);
    REQUIRE(scene.has_value());
    const auto model = setup::build_model(*scene);
    REQUIRE(model.has_value());
    const stepper::Simulation simulation = one_step(*model);
    CHECK(never_meet(*model, simulation.trajectory));
    const auto& last = simulation.trajectory.poses.back();
    CHECK((last[1].position - last[0].position).norm() >= 1);
}

TEST_CASE("wires that fly at one another end-on do not pass through each other") { fly_at_one_another(200, 1); }

TEST_CASE("very many wires that fly at one another end-on do not pass through each other", "[slow]") { fly_at_one_another(3000, 2); }

}  // namespace fettle::tests::scenes::wires_test
