// SPDX-License-Identifier: MIT
#include "core/paper_scenes/fixture_reader.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "core/setup/build_model.hpp"
#include "tests/core/paper_scenes/fixture_texts.hpp"
#include "tests/support/shared_files.hpp"

namespace fettle::core::paper_scenes::fixture_reader_test {

namespace {

using base::ErrorCode;
using namespace test_support;
constexpr double pi = std::numbers::pi;

base::Result<scene::Scene> read(const std::string& top, const std::string& problem, const std::string& body) {
    return scene_files::parse_scene("{" + top + R"("rigid_body_problem": {)" + problem + R"("rigid_bodies": [{)" + tet + body + "}]}}",
                                    "fixture.json");
}

scene::Body body_with(const std::string& keys) {
    const auto scene = read("", "", keys.empty() ? "" : ", " + keys);
    REQUIRE(scene);
    REQUIRE(scene->bodies.size() == 1);
    return scene->bodies[0];
}

TEST_CASE("A fixture's defaults are that format's", "[scene]") {
    const auto scene = read("", "", "");
    REQUIRE(scene);
    CHECK(scene->timestep == 0.01);
    CHECK_FALSE(scene->end_time);
    CHECK(scene->dhat == 1e-3);
    CHECK(scene->dmin == 0);
    CHECK(scene->velocity_tolerance == Approx(1e-2 * std::sqrt(3.0)));
    CHECK(scene->gravity == Vector3::Zero());
    CHECK(scene->warnings.empty());
    const scene::Body& body = scene->bodies[0];
    CHECK(body.density == 1000);
    CHECK(body.type == scene::BodyType::dynamic_body);
    CHECK(body.mesh_policy == scene::MeshPolicy::lenient);
    CHECK(body.mesh.triangles.size() == 4);
    CHECK(body.mesh.edges.size() == 6);
    CHECK(body.group == -1);
}

TEST_CASE("A fixture's settings arrive", "[scene]") {
    const auto scene = read(R"("timestep": 0.02, "max_time": 3, "max_iterations": 7, "#note": 1, "scene_type": null,
        "distance_barrier_constraint": {"initial_barrier_activation_distance": 1e-4, "minimum_separation_distance": 0.05, "detection_method": "bvh"},
        "ipc_solver": {"velocity_conv_tol": 1e-3, "is_velocity_conv_tol_abs": true, "max_iterations": 40},)",
                            R"("gravity": [0, -9.8, 0, 5], "coefficient_friction": 0, "coefficient_restitution": -1,)", "");
    REQUIRE(scene);
    CHECK(scene->timestep == 0.02);
    CHECK(scene->end_time == 3.0);
    CHECK(scene->gravity == Vector3(0, -9.8, 0));
    CHECK(scene->dhat == 1e-4);
    CHECK(scene->dmin == 0.05);
    CHECK(scene->velocity_tolerance == 1e-3);
    CHECK(scene->max_newton_iterations == 40);
    CHECK(scene->warnings.empty());
    CHECK(read(R"("max_iterations": 7,)", "", "")->end_time == Approx(0.07));
}

TEST_CASE("Placement: scale or dimensions, then rotation, then position", "[scene]") {
    const scene::Body body = body_with(R"("scale": [1, 2, 3], "rotation": [90, 0, 90], "position": [5, 6, 7])");
    CHECK(body.mesh.vertices.rowwise().maxCoeff() == Vector3(1, 2, 3));
    // x -> y, y -> z, z -> x
    CHECK((kinematics::world_position(body.pose, Vector3(1, 2, 3)) - Vector3(8, 7, 9)).norm() < 1e-14);
    CHECK(body_with(R"("scale": 0.1)").mesh.vertices.rowwise().maxCoeff().isApprox(Vector3(0.1, 0.1, 0.1)));
    CHECK(body_with(R"("scale": 9, "dimensions": [4, 5, 6])").mesh.vertices.rowwise().maxCoeff().isApprox(Vector3(4, 5, 6)));
    // Mirrored, it stays a solid.
    scene::Scene mirrored;
    mirrored.bodies = {body_with(R"("scale": [-1, 1, 1])")};
    CHECK(setup::build_model(mirrored)->bodies[0].moments(3, 3) == Approx(1000.0 / 6));
}

TEST_CASE("Types, fixed coordinates and scripts", "[scene]") {
    CHECK(body_with(R"("is_dof_fixed": true)").type == scene::BodyType::static_body);
    CHECK(body_with(R"("is_dof_fixed": [true, true, true, true, true, true])").type == scene::BodyType::static_body);
    CHECK(body_with(R"("type": "static", "is_dof_fixed": [false, false, true, true, true, false])").type == scene::BodyType::static_body);
    CHECK(body_with(R"("type": "static", "density": 0)").type == scene::BodyType::static_body);

    const scene::Body dynamic = body_with(R"("is_dof_fixed": [true, false, false, true, true, false], "linear_velocity": [1, 2, 3],
                                       "angular_velocity": [0, 0, 90], "force": [4, 5, 6], "density": 7, "group_id": 3)");
    CHECK(dynamic.type == scene::BodyType::dynamic_body);
    for (int dof = 0; dof < 6; ++dof) CHECK(dynamic.prescribed[dof].has_value() == (dof == 0 || dof == 3 || dof == 4));
    CHECK(dynamic.linear_velocity == Vector3(1, 2, 3));
    CHECK(dynamic.angular_velocity.isApprox(Vector3(0, 0, pi / 2)));
    CHECK(dynamic.force == Vector3(4, 5, 6));
    CHECK(dynamic.density == 7);
    CHECK(dynamic.group == 3);

    const scene::Body kinematic = body_with(R"("type": "kinematic", "linear_velocity": [1, 2, 3], "angular_velocity": [180, 0, 360],
                                         "is_dof_fixed": [false, true, false, true, false, false], "kinematic_max_time": 2)");
    CHECK(kinematic.type == scene::BodyType::kinematic_body);
    const std::array<double, 6> expected{1, 0, 3, 0, 0, 2 * pi};
    for (int dof = 0; dof < 6; ++dof) {
        REQUIRE(kinematic.prescribed[dof]);
        CHECK(scene::motion_value(*kinematic.prescribed[dof], 1) == Approx(expected[dof]));
        CHECK(scene::motion_value(*kinematic.prescribed[dof], 5) == Approx(2 * expected[dof]));
    }
    CHECK(scene::motion_value(*body_with(R"("type": "kinematic", "linear_velocity": [1, 0, 0], "kinematic_max_time": -1)").prescribed[0],
                              5) == 5);
}

TEST_CASE("Groups: bodies that are not dynamic share one", "[scene]") {
    const auto text = [&](const std::string& bodies) { return R"({"rigid_body_problem": {"rigid_bodies": [)" + bodies + "]}}"; };
    const auto body = [&](const std::string& keys) { return "{" + tet + ", " + keys + "}"; };
    const auto scene =
        scene_files::parse_scene(text(body(R"("type": "static", "group_id": 1, "position": [5, 0, 0])") + "," +
                                      body(R"("type": "kinematic", "position": [10, 0, 0])") + "," + body(R"("group_id": 1)") + "," +
                                      body(R"("group_id": 2, "position": [15, 0, 0])") + "," + body(R"("enabled": false)") + "," +
                                      body(R"("group_id": -1, "position": [20, 0, 0])")),
                                 "fixture.json");
    REQUIRE(scene);
    REQUIRE(scene->bodies.size() == 5);
    const auto model = setup::build_model(*scene);
    REQUIRE(model);
    CHECK_FALSE(model::may_collide(*model, 0, 1));
    CHECK_FALSE(model::may_collide(*model, 0, 2));
    CHECK_FALSE(model::may_collide(*model, 1, 2));
    CHECK(model::may_collide(*model, 0, 3));
    CHECK(model::may_collide(*model, 2, 3));
    CHECK(model::may_collide(*model, 3, 4));
    CHECK(scene->bodies[0].name == "body-0");
    CHECK(scene->bodies[4].name == "body-4");
}

TEST_CASE("What a scene::Scene cannot hold is refused by name", "[scene]") {
    const auto code_and_message = [](const base::Result<scene::Scene>& result, const std::string& key) {
        REQUIRE(result.errors().size() == 1);
        CHECK(result.errors()[0].code == ErrorCode::unsupported);
        CHECK(contains(result.errors()[0].where + result.errors()[0].message, key));
    };
    code_and_message(read("", "", R"(, "position": [0, 1])"), "2D");
    code_and_message(read("", "", R"(, "rotation": 45)"), "2D");
    code_and_message(read("", "", R"(, "is_dof_fixed": [true, false, true])"), "2D");
    code_and_message(read(R"("scene_type": "split_distance_barrier_rb_problem",)", "", ""), "scene_type");
}

TEST_CASE("Friction of a fixture", "[scene]") {
    const auto friction = [](const std::string& top, const std::string& problem) {
        const auto scene = read(top, problem, "");
        REQUIRE(scene);
        return *scene;
    };
    const scene::Friction none = friction("", "").friction;
    CHECK(none.mu == 0);
    CHECK(none.eps_v == 1e-3);
    CHECK(none.rounds == 1);
    const std::string rough = R"("coefficient_friction": 0.5,)";
    const scene::Scene some = friction(R"("friction_constraints": {"iterations": 3, "static_friction_speed_bound": 1e-5},)", rough);
    CHECK(some.friction.mu == 0.5);
    CHECK(some.friction.eps_v == 1e-5);
    CHECK(some.friction.rounds == 3);
    CHECK(setup::build_model(some)->friction.mu == MatrixX::Constant(1, 1, 0.5));
    CHECK(friction(R"("friction_constraints": {"iterations": -7},)", rough).friction.rounds < 0);
    const scene::Scene off = friction(R"("friction_constraints": {"iterations": 0},)", rough);
    CHECK(off.friction.rounds == 0);
    CHECK(setup::build_model(off)->friction.mu == MatrixX::Zero(1, 1));
}

TEST_CASE("Torque is newton metres, once; time steppers are ours", "[scene]") {
    CHECK(body_with(R"("torque": [0, 300, 0])").torque == Vector3(0, 300, 0));
    CHECK(body_with(R"("torque": [0, 300, 0], "is_dof_fixed": true)").torque == Vector3::Zero());
    CHECK(body_with(R"("#torque": [0, 1, 0])").torque == Vector3::Zero());
    const auto integrator = [](const std::string& name) { return read("", R"("time_stepper": ")" + name + "\",", "")->integrator; };
    CHECK(integrator("default") == scene::Integrator::implicit_euler);
    CHECK(integrator("implicit_euler") == scene::Integrator::implicit_euler);
    CHECK(integrator("implicit_newmark") == scene::Integrator::newmark);
    CHECK(integrator("stabilized_newmark") == scene::Integrator::newmark);
    CHECK(integrator("leapfrog") == scene::Integrator::implicit_euler);
    CHECK(read("", R"("time_stepper": "leapfrog",)", "")->warnings.size() == 1);
}

TEST_CASE("Faults in a fixture have their place", "[scene]") {
    const auto fails = [](const base::Result<scene::Scene>& result, ErrorCode code, const std::string& where) {
        REQUIRE(result.errors().size() == 1);
        CHECK(static_cast<int>(result.errors()[0].code) == static_cast<int>(code));
        CHECK(contains(result.errors()[0].where, where));
    };
    fails(read("", "", R"(, "density": -1000)"), ErrorCode::out_of_range, "#/rigid_body_problem/rigid_bodies/0/density");
    fails(read("", "", R"(, "mesh": "no-such.obj")"), ErrorCode::file_not_found, "#/rigid_body_problem/rigid_bodies/0/mesh");
    fails(read("", "", R"(, "is_dof_fixed": [true, false])"), ErrorCode::wrong_type, "/is_dof_fixed");
    fails(read(R"("timestep": -1,)", "", ""), ErrorCode::out_of_range, "#/timestep");
    fails(read("", "", R"(, "position": ["a", 0, 0])"), ErrorCode::wrong_type, "/position/0");
    fails(scene_files::parse_scene(R"({"rigid_body_problem": {"rigid_bodies": [{"vertices": [[0,0,0]], "faces": [[0,0,3]]}]}})", "a.json"),
          ErrorCode::out_of_range, "/faces/0/2");
    fails(scene_files::parse_scene(R"({"rigid_body_problem": {"rigid_bodies": [{}]}})", "a.json"), ErrorCode::missing_key,
          "/rigid_bodies/0");
    fails(scene_files::parse_scene(R"({"rigid_body_problem": {}})", "a.json"), ErrorCode::out_of_range, "/rigid_bodies");
}

TEST_CASE("Unknown keys of a fixture are warned of", "[scene]") {
    const auto scene = read(R"("distance_barrier_constraints": {},)", "", R"(, "desnity": 5)");
    REQUIRE(scene);
    REQUIRE(scene->warnings.size() == 2);
    CHECK(contains(scene->warnings[0], "did you mean `distance_barrier_constraint`?"));
    CHECK(contains(scene->warnings[1], "did you mean `density`?"));
}

TEST_CASE("What a fixture's density is per follows from its geometry", "[scene]") {
    const auto kind = [](const std::string& body) { return scene_with_body(body).bodies[0].mass_kind; };
    CHECK(kind(tet) == scene::MassKind::volume);
    CHECK(kind(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]], "faces": [[0,1,2]], "edges": [[0,1],[1,2],[2,0]])") == scene::MassKind::area);
    CHECK(kind(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]], "edges": [[0,1],[1,2]])") == scene::MassKind::length);
    CHECK(kind(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]])") == scene::MassKind::vertex);

    const auto model_of = [](const std::string& body) {
        const auto model = setup::build_model(scene_with_body(body));
        REQUIRE(model);
        return model->bodies[0];
    };
    CHECK(model_of(R"("vertices": [[0,0,0],[3,0,0],[0,2,0]], "faces": [[0,1,2]], "density": 5)").moments(3, 3) == Approx(15));
    CHECK(model_of(R"("vertices": [[0,0,0],[3,0,0],[3,2,0]], "edges": [[0,1],[1,2]], "density": 5)").moments(3, 3) == Approx(25));
    CHECK(model_of(R"("vertices": [[0,0,0],[3,0,0],[3,2,0]], "density": 5)").moments(3, 3) == Approx(15));
    CHECK(model_of(R"("vertices": [[0,0,0],[3,0,0],[3,3,0]])").reference_point.isApprox(Vector3(2, 1, 0)));

    // Inside out, it is turned, with a warning.
    const std::string turned = R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "faces": [[0,1,2],[0,3,1],[0,2,3],[1,3,2]])";
    CHECK(scene_with_body(turned).warnings.size() == 1);
    CHECK(model_of(turned).moments(3, 3) == Approx(1000.0 / 6));
    CHECK(scene_with_body(turned + R"(, "type": "static")").warnings.empty());
    // A box without a lid is a shell, with a warning.
    const std::string lidless = R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],[1,1,1]],
        "faces": [[0,2,3],[0,3,1],[0,1,5],[0,5,4],[2,6,7],[2,7,3],[0,4,6],[0,6,2],[1,3,7],[1,7,5]])";
    CHECK(scene_with_body(lidless).warnings.size() == 1);
    CHECK(model_of(lidless).moments(3, 3) == Approx(5000));
    // Without one corner of it (1/12 of the box's area is missing), it is a solid, with a warning.
    const std::string gap = lidless.substr(0, lidless.size() - 1) + ",[4,5,7]]";
    CHECK(scene_with_body(gap).warnings.size() == 1);
    CHECK(model_of(gap).moments(3, 3) == Approx(1000));
    CHECK(model_of(gap).reference_point.isApprox(Vector3(0.5, 0.5, 0.5)));
}

TEST_CASE("Components of a fixture's mesh become bodies", "[scene]") {
    const std::string two =
        R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[5,0,0],[7,0,0],[5,2,0],[5,0,2]],
           "faces": [[4,6,5],[0,2,1],[0,1,3],[0,3,2],[1,2,3],[4,5,7],[4,7,6],[5,6,7]], "linear_velocity": [1, 2, 3], "angular_velocity": [90, 0, 0])";
    CHECK(scene_with_body(two).bodies.size() == 1);
    const scene::Scene scene = scene_with_body(two + R"(, "split_components": true)");
    REQUIRE(scene.bodies.size() == 2);
    CHECK(scene.bodies[0].name == "body-0");
    CHECK(scene.bodies[1].name == "body-1");
    const auto model = setup::build_model(scene);
    REQUIRE(model);
    CHECK(model->bodies[0].mesh.vertices.cols() == 4);
    CHECK(model->bodies[0].moments(3, 3) == Approx(8000.0 / 6));
    CHECK(model->bodies[0].reference_point.isApprox(Vector3(5.5, 0.5, 0.5)));
    CHECK(model->bodies[1].moments(3, 3) == Approx(1000.0 / 6));
    CHECK(model->bodies[1].reference_point.isApprox(Vector3(0.25, 0.25, 0.25)));
    for (const auto& body : scene.bodies) {
        CHECK(body.linear_velocity == Vector3(1, 2, 3));
        CHECK(body.angular_velocity.isApprox(Vector3(pi / 2, 0, 0)));
    }
}

TEST_CASE("All of the paper's scenes load and build", "[scene]") {
    FETTLE_NEEDS_SHARED();
    namespace fs = std::filesystem;
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(tests::support::shared_file("scenes/fixtures"))) {
        if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    }
    CHECK(files.size() >= 46);
    for (const auto& file : files) {
        CAPTURE(file);
        const auto scene = scene_files::read_scene(file);
        REQUIRE(scene);
        const auto model = setup::build_model(*scene);
        for (const auto& error : model.errors()) {
            CAPTURE(error.where, error.message);
            CHECK(model);
        }
    }
}

TEST_CASE("The scenes that must run load with what they say", "[scene]") {
    FETTLE_NEEDS_SHARED();
    const auto load = [](const std::string& name) {
        const auto scene = scene_files::read_scene(tests::support::shared_file("scenes/fixtures/" + name + ".json"));
        REQUIRE(scene);
        const auto model = setup::build_model(*scene);
        REQUIRE(model);
        return *model;
    };
    CHECK(load("unit-tests/5-cubes").bodies.size() == 6);
    CHECK(load("unit-tests/tet-corner").bodies.size() == 5);
    CHECK(load("mechanisms/bolt").bodies.size() == 2);
    const auto press = load("mechanisms/507-movements/140-punching-press");
    CHECK(press.bodies.size() == 6);
    const auto blender = load("blender/blender-10");  // the monkey's eyes are open behind: a solid all the same
    CHECK(blender.bodies.back().moments(3, 3) == Approx(1000 * 2.255 / 64).epsilon(0.05));
    const auto table = load("friction/turntable/turntable-mu=0.5");
    CHECK(table.bodies[0].torque == Vector3(0, 300, 0));
    CHECK(friction_coefficient(table, 0, 1) == 0.5);
    CHECK(table.friction.eps_v == 1e-5);
    CHECK(table.friction.rounds < 0);
    CHECK(table.adaptive_kappa);
    const auto scripted = load("examples/kinematically-scripted");
    CHECK(scripted.bodies[3].script.poses.size() == 3);
    CHECK(scripted.bodies[3].script.poses[2].position.isApprox(Vector3(0, 3, 0)));
    CHECK(scripted.bodies[3].script.poses[2].rotation.isApprox(Matrix3::Identity()));
    const auto house = scene_files::read_scene(tests::support::shared_file("scenes/fixtures/friction/card-house/card-house-2-levels.json"));
    REQUIRE(house->warnings.size() == 1);
    CHECK(contains(house->warnings[0], "/rigid_bodies/[1-7]: the mesh is open"));
    CHECK(load("codimensional/edges/3-link-chain").bodies[1].moments(3, 3) > 0);
    const auto pendulum = load("pendulum/pendulum");
    CHECK(pendulum.dhat == 1e-4);
    CHECK(pendulum.bodies[0].type == scene::BodyType::static_body);
    const auto piston = load("mechanisms/507-movements/092-piston");
    REQUIRE(piston.bodies.size() == 4);
    CHECK(piston.bodies[0].name == "crank");
    CHECK(piston.bodies[0].type == scene::BodyType::kinematic_body);
    CHECK(scene::motion_value(*piston.bodies[0].prescribed[5], 1) == Approx(-2 * pi));
    CHECK(piston.bodies[1].moments(3, 3) > 0);
}

}  // namespace

}  // namespace fettle::core::paper_scenes::fixture_reader_test
