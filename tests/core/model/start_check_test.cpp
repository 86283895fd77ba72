// SPDX-License-Identifier: MIT
#include "core/model/start_check.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/setup/build_model.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::model::start_check_test {

using core::setup::build_model;
using core::setup::BuildOptions;
namespace {

using base::ErrorCode;

scene::Body body_of(const std::string& name, geometry::Mesh mesh) {
    scene::Body body;
    body.name = name;
    body.mesh = std::move(mesh);
    return body;
}

base::Errors errors_of(const std::vector<scene::Body>& bodies, double dmin = 0) {
    scene::Scene scene;
    scene.length_unit = 0.001;
    scene.dmin = dmin;
    scene.dhat = 1e-3;
    scene.bodies = bodies;
    return build_model(scene).errors();
}

using fettle::tests::support::contains;

TEST_CASE("Bodies that cross at the start are named, with elements and place", "[model]") {
    const auto a = body_of("a", tests::box_mesh({0, 0, 0}, {1, 1, 1}));
    const auto b = body_of("b", tests::box_mesh({0.9, 0.25, 0.25}, {2, 0.75, 0.75}));
    const auto errors = errors_of({a, b});
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == ErrorCode::bodies_intersect);
    CHECK(contains(errors[0].where, "`a` and `b`"));
    CHECK(contains(errors[0].message, "triangle"));
    CHECK(contains(errors[0].message, "1000 mm, "));  // b pierces the face x = 1 m, in the file's unit
}

TEST_CASE("Touching counts as intersecting, a hair apart does not", "[model]") {
    const auto a = body_of("a", tests::box_mesh({0, 0, 0}, {1, 1, 1}));
    CHECK(errors_of({a, body_of("b", tests::box_mesh({1, 0, 0}, {2, 1, 1}))}).size() == 1);
    CHECK(errors_of({a, body_of("b", tests::box_mesh({1, 1, 1}, {2, 2, 2}))}).size() == 1);  // one corner
    CHECK(errors_of({a, body_of("b", tests::box_mesh({1 + 1e-12, 0, 0}, {2, 1, 1}))}).empty());
}

TEST_CASE("The minimum separation holds at the start", "[model]") {
    const auto a = body_of("a", tests::box_mesh({0, 0, 0}, {1, 1, 1}));
    const auto b = body_of("b", tests::box_mesh({1.05, 0.2, 0.2}, {2, 0.8, 0.8}));
    CHECK(errors_of({a, b}, 0.04).empty());
    const auto errors = errors_of({a, b}, 0.06);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == ErrorCode::bodies_intersect);
    CHECK(contains(errors[0].message, "50 mm apart"));
    CHECK(contains(errors[0].message, "60 mm"));
    // Edge against edge, which no vertex sees: two thin bars that cross at right angles, 0.02 apart.
    const auto along_x = body_of("x", tests::box_mesh({-5, -0.01, 0}, {5, 0.01, 0.02}));
    auto along_y = body_of("y", tests::box_mesh({-0.01, -5, 0.04}, {0.01, 5, 0.06}));
    CHECK(errors_of({along_x, along_y}, 0.019).empty());
    CHECK(errors_of({along_x, along_y}, 0.021).size() == 1);
}

TEST_CASE("One body inside another's material is an overlap, in its cavity it is not", "[model]") {
    const auto outer = body_of("outer", tests::box_mesh({0, 0, 0}, {3, 3, 3}));
    const auto hollow =
        body_of("hollow", tests::joined(tests::box_mesh({0, 0, 0}, {3, 3, 3}), tests::inside_out(tests::box_mesh({1, 1, 1}, {2, 2, 2}))));
    const auto inner = body_of("inner", tests::box_mesh({1.2, 1.2, 1.2}, {1.8, 1.8, 1.8}));
    for (const auto& order : {std::vector{outer, inner}, std::vector{inner, outer}}) {
        const auto errors = errors_of(order);
        REQUIRE(errors.size() == 1);
        CHECK(contains(errors[0].message, "`inner` and `outer`"));
        CHECK(contains(errors[0].message, "inside"));
    }
    CHECK(errors_of({hollow, inner}).empty());
    CHECK(errors_of({inner, hollow}).empty());
    // Two shells, one outside and one in the material: the second must be found.
    const auto pair =
        body_of("pair", tests::joined(tests::box_mesh({5, 5, 5}, {6, 6, 6}), tests::box_mesh({0.2, 0.2, 0.2}, {0.4, 0.4, 0.4})));
    CHECK(errors_of({hollow, pair}).size() == 1);
}

TEST_CASE("An edge or a point of a static body that pierces a solid is found", "[model]") {
    const auto solid = body_of("solid", tests::box_mesh({0, 0, 0}, {1, 1, 1}));
    geometry::Mesh wire;
    wire.name = "wire";
    wire.vertices.resize(3, 2);
    wire.vertices << 0.3, 0.3, 0.4, 0.4, -1, 2;
    geometry::build_connectivity(wire, {{0, 1}});
    auto needle = body_of("needle", wire);
    needle.type = scene::BodyType::static_body;
    const auto errors = errors_of({solid, needle});
    REQUIRE(errors.size() == 1);
    CHECK(contains(errors[0].message, "edge 0-1"));
    needle.pose.position = {2, 0, 0};
    CHECK(errors_of({solid, needle}).empty());
    wire.vertices.row(2) << 0.2, 0.7;  // wholly inside
    needle.mesh = wire;
    needle.pose.position.setZero();
    CHECK(errors_of({solid, needle}).size() == 1);
    geometry::Mesh point;
    point.vertices.resize(3, 1);
    point.vertices << 0.3, 0.4, 0.5;
    geometry::build_connectivity(point);
    needle.mesh = point;
    CHECK(errors_of({solid, needle}).size() == 1);
    needle.mesh.vertices << 0.3, 0.4, 1;  // on the face
    CHECK(errors_of({solid, needle}).size() == 1);
}

TEST_CASE("Bodies that may not collide may overlap", "[model]") {
    auto a = body_of("a", tests::box_mesh({0, 0, 0}, {1, 1, 1}));
    auto b = body_of("b", tests::box_mesh({0.5, 0, 0}, {2, 1, 1}));
    a.group = b.group = 3;
    CHECK(errors_of({a, b}).empty());
    a.group = b.group = -1;
    CHECK(errors_of({a, b}).size() == 1);
    a.type = b.type = scene::BodyType::static_body;
    CHECK(errors_of({a, b}).empty());
}

TEST_CASE("Rotated bodies are checked where they are", "[model]") {
    const auto torus = body_of("torus", tests::torus_mesh(1, 0.2, 24));
    auto link = torus;
    link.name = "link";
    link.pose.rotation = kinematics::rotation({1.5, 0.2, 0.1});
    link.pose.position = {1, 0, 0};
    CHECK(errors_of({torus, link}).empty());  // linked rings, boxes overlapping
    link.pose.position = {1.3, 0, 0};
    CHECK(errors_of({torus, link}).empty());
    link.pose.position = {1.9, 0, 0};
    CHECK(errors_of({torus, link}).size() == 1);
}

TEST_CASE("Pairs that contact never acts on are told, not refused", "[model]") {
    scene::Body wall = body_of("wall", tests::box_mesh({0, 0, 0}, {4, 4, 4}));
    wall.type = scene::BodyType::static_body;
    scene::Body hand = body_of("hand", tests::box_mesh({3, 1, 1}, {6, 2, 2}));
    hand.type = scene::BodyType::kinematic_body;
    scene::Body core = body_of("core", tests::box_mesh({1, 1, 1}, {2, 2, 2}));
    core.type = scene::BodyType::static_body;
    scene::Scene scene;
    scene.dmin = 0.1;
    scene.dhat = 1e-3;
    scene.bodies = {wall, hand, core};
    const auto model = build_model(scene);
    REQUIRE(model);
    REQUIRE(model->warnings.size() == 2);
    CHECK(contains(model->warnings[0], "`wall` and `hand` intersect"));
    CHECK(contains(model->warnings[0], "contact never acts between them"));
    CHECK(contains(model->warnings[1], "`core` and `wall` overlap at the start: material of the first lies inside the second"));
    scene.bodies[1].group = scene.bodies[0].group = scene.bodies[2].group = 3;  // said to be meant
    CHECK(build_model(scene)->warnings.empty());
    // A dynamic body that is inside stays an error.
    scene.bodies = {wall, core};
    scene.bodies[1].type = scene::BodyType::dynamic_body;
    CHECK(build_model(scene).errors().size() == 1);
}

TEST_CASE("Where a mesh is not closed, containment is not claimed", "[model]") {
    scene::Body shell = body_of("shell", tests::ellipsoid_mesh({2, 2, 2}, 8));
    shell.mesh.triangles.pop_back();
    shell.mesh.shell_names.clear();
    geometry::build_connectivity(shell.mesh);
    shell.type = scene::BodyType::static_body;
    shell.mesh_policy = scene::MeshPolicy::tolerant;
    scene::Scene scene;
    scene.dhat = 1e-3;
    scene.bodies = {shell, body_of("ball", tests::box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}))};
    const auto model = build_model(scene);
    REQUIRE(model);
    REQUIRE(model->warnings.size() == 1);
    CHECK(contains(model->warnings[0], "whether `ball` lies inside `shell` at the start cannot be verified"));
}

TEST_CASE("Of many bodies the same are at fault as pair by pair, in the same order", "[model]") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    scene::Scene scene;
    scene.dhat = 1e-3;
    scene.dmin = 0.05;
    for (int i = 0; i < 60; ++i) {
        scene::Body body = body_of("b" + std::to_string(i), tests::box_mesh({0, 0, 0}, {0.2, 0.3, 0.1 + 0.05 * (i % 3)}));
        body.pose.position = 2 * Vector3(uniform(random), uniform(random), uniform(random));
        body.group = i % 7 == 0 ? 0 : -1;
        scene.bodies.push_back(body);
    }
    BuildOptions options;
    options.check_start = false;
    const Model model = build_model(scene, options).value();
    std::vector<std::string> expected;
    for (int i = 0; i < 60; ++i) {
        for (int j = i + 1; j < 60; ++j) {
            if (!may_collide(model, i, j)) continue;
            if (const auto error = check_start_pair(model, i, j)) expected.push_back(error->message);
        }
    }
    std::vector<std::string> found;
    for (const base::Error& error : report_start(model).errors) found.push_back(error.message);
    CHECK(expected.size() > 5);
    CHECK(found == expected);
}

}  // namespace

}  // namespace fettle::core::model::start_check_test
