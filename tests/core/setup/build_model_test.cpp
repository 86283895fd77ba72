// SPDX-License-Identifier: MIT
#include "core/setup/build_model.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "core/geometry/body_hierarchy.hpp"
#include "core/kinematics/rotation.hpp"
#include "tests/core/model/box_scenes.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::setup::build_model_test {

namespace {

using base::ErrorCode;
using model::Body;
using scene::BodyType;

using fettle::tests::box_body;
using fettle::tests::only_error;
using fettle::tests::scene_of;
using fettle::tests::support::contains;

TEST_CASE("A box gets its mass, frame and sizes", "[model]") {
    scene::Body box = box_body("box", {1, 2, 3}, {2, 4, 6});  // 1 x 2 x 3, centre (1.5, 3, 4.5)
    box.density = 500;
    box.pose.rotation = kinematics::rotation({0.1, 0.2, 0.3});
    box.pose.position = {7, 8, 9};
    box.linear_velocity = {1, 0, 0};
    box.angular_velocity = {0, 0, 2};
    scene::Scene scene = scene_of({box});
    scene.timestep = 0.02;
    const auto model = build_model(scene);
    REQUIRE(model);
    const Body& body = model->bodies[0];
    CHECK((body.reference_point - Vector3(1.5, 3, 4.5)).norm() < 1e-14);
    const double mass = 3000;
    CHECK(body.moments(3, 3) == Approx(mass).epsilon(1e-14));
    CHECK(body.moments.col(3).head<3>().norm() < 1e-11);  // about the centre of mass
    CHECK((body.moments.topLeftCorner<3, 3>() - mass / 12 * Vector3(1, 4, 9).asDiagonal().toDenseMatrix()).norm() < 1e-9);
    CHECK(body.radius >= 0.5 * std::sqrt(14.0));
    CHECK(body.radius <= 0.5 * std::sqrt(14.0) * (1 + 1e-14));
    CHECK(body.edge_length_squared.size() == body.mesh.edges.size());
    CHECK((body.pose_start.position - (box.pose.rotation * Vector3(1.5, 3, 4.5) + box.pose.position)).norm() < 1e-14);
    for (int i = 0; i < 8; ++i) {  // the shift of the frame moves nothing in the world
        const Vector3 before = kinematics::world_position(box.pose, box.mesh.vertices.col(i));
        CHECK((kinematics::world_position(body.pose_start, body.mesh.vertices.col(i)) - before).norm() < 1e-14);
    }
    // A point's velocity by [omega] (R X) + v and by Pdot [X; 1] is the same.
    const Vector3 X(0.3, -0.2, 0.5);
    const Vector3 velocity = body.velocity_start.leftCols<3>() * X + body.velocity_start.col(3);
    CHECK((velocity - (box.angular_velocity.cross(box.pose.rotation * X) + box.linear_velocity)).norm() < 1e-14);
    CHECK(body.hierarchy->elements().size() == 12);
    CHECK(model->diagonal == Approx(scene::bounding_diagonal(scene)));
    CHECK(model->dhat == Approx(1e-3 * model->diagonal));
    CHECK(model->velocity_tolerance == Approx(1e-2 * model->diagonal));
    CHECK(model->end_time < 0);
}

TEST_CASE("Copies of a part share its hierarchy, and are what they would be alone", "[model]") {
    const scene::Body a = box_body("a", {1, 2, 3}, {2, 4, 6}), other = box_body("other", {1, 2, 3}, {2, 4, 7});
    scene::Body b = box_body("b", {1, 2, 3}, {2, 4, 6}), shifted = b;
    b.pose.position = {9, 0, 0};
    shifted.name = "shifted";
    shifted.pose.position = {18, 0, 0};
    shifted.reference_point = Vector3(1, 2, 3);
    BuildOptions options;
    options.check_start = false;
    const auto model = build_model(scene_of({a, other, b, shifted}), options);
    REQUIRE(model);
    const auto& bodies = model->bodies;
    CHECK(bodies[2].hierarchy == bodies[0].hierarchy);
    CHECK(bodies[1].hierarchy != bodies[0].hierarchy);
    CHECK(bodies[3].hierarchy != bodies[0].hierarchy);
    const auto alone = build_model(scene_of({b}));
    REQUIRE(alone);
    CHECK(bodies[2].radius == alone->bodies[0].radius);
    CHECK(bodies[2].moments == alone->bodies[0].moments);
    CHECK(bodies[2].edge_length_squared == alone->bodies[0].edge_length_squared);
    CHECK(bodies[2].vertex_area == alone->bodies[0].vertex_area);
    CHECK(bodies[2].edge_area == alone->bodies[0].edge_area);
    const auto moved = build_model(scene_of({a, other, b, shifted}), options);  // the scene's meshes are its own
    const scene::Scene kept = scene_of({a, other, b, shifted});
    const auto copied = build_model(kept, options);
    REQUIRE((moved && copied));
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(moved->bodies[i].mesh.vertices == copied->bodies[i].mesh.vertices);
        CHECK(moved->bodies[i].mesh.triangles == copied->bodies[i].mesh.triangles);
        CHECK(moved->bodies[i].moments == copied->bodies[i].moments);
        CHECK(kept.bodies[i].mesh.vertices.cols() == 8);
    }
}

TEST_CASE("A reference point is the caller's, the scene's, or a default", "[model]") {
    scene::Body box = box_body("box", {0, 0, 0}, {2, 2, 2});
    const auto reference = [](const scene::Scene& scene, const BuildOptions& options) {
        return build_model(scene, options).value().bodies[0].reference_point;
    };
    CHECK(reference(scene_of({box}), {}).isApprox(Vector3(1, 1, 1)));
    box.reference_point = Vector3(0, 0, 1);
    CHECK(reference(scene_of({box}), {}) == Vector3(0, 0, 1));
    BuildOptions options;
    options.reference_points = {Vector3(5, 0, 0)};
    CHECK(reference(scene_of({box}), options) == Vector3(5, 0, 0));
    const auto model = build_model(scene_of({box}), options);
    CHECK(model->bodies[0].moments(0, 3) == Approx(-4 * model->bodies[0].moments(3, 3)));  // first moment about that point

    scene::Body ground = box;
    ground.reference_point.reset();
    ground.type = BodyType::static_body;
    ground.mesh.triangles.resize(2);  // an open surface in x from 0 to 2, z = 0
    geometry::build_connectivity(ground.mesh);
    CHECK(reference(scene_of({ground}), {}).isApprox(Vector3(1, 1, 1)));  // middle of the box around its vertices
}

TEST_CASE("Wires and points resist being turned a little", "[model]") {
    scene::Body wire;
    wire.name = "wire";
    wire.mesh.vertices.resize(3, 2);
    wire.mesh.vertices << 0, 2, 0, 0, 0, 0;
    geometry::build_connectivity(wire.mesh, {{0, 1}});
    wire.density = 3;
    wire.mass_kind = scene::MassKind::length;
    scene::Scene scene = scene_of({wire});
    scene.dhat = 1e-3;
    const auto moments = [&] { return build_model(scene).value().bodies[0].moments; };
    const Matrix4 straight = moments();  // 6 kg, 2 m, about its middle
    CHECK(straight(3, 3) == Approx(6));
    CHECK(straight(0, 0) == Approx(2));
    CHECK(straight(1, 1) + straight(2, 2) == Approx(1e-8 * 6));
    CHECK((straight - Matrix4(straight.diagonal().asDiagonal())).norm() < 1e-15);
    scene.bodies[0].reference_point = Vector3(0, 0, 1);  // the same about another point: only what is lacking is added
    CHECK((moments().topLeftCorner<3, 3>() - (Matrix3() << 8, 0, -6, 0, 0, 0, -6, 0, 6).finished()).norm() < 1e-6);
    scene.bodies[0].reference_point.reset();
    scene.bodies[0].mesh.vertices << 0, 2, 0, 0.5, 0, 0;
    scene.bodies[0].mesh.edges.clear();
    scene.bodies[0].mass_kind = scene::MassKind::vertex;
    CHECK(moments()(3, 3) == 6);
    scene.bodies[0].mesh = {};
    scene.bodies[0].mesh.vertices = Vector3(5, 5, 5);
    scene.bodies[0].mesh.codimensional_points = {0};
    const Matrix4 point = moments();
    CHECK(point(3, 3) == 3);
    for (int i = 0; i < 3; ++i) CHECK(point(i, i) == Approx(0.5e-8 * 3 * 1e-6));
    // A body that has inertia about every axis gets nothing.
    scene.bodies[0] = wire;
    scene.bodies[0].mesh.vertices.resize(3, 3);
    scene.bodies[0].mesh.vertices << 0, 2, 0, 0, 0, 1, 0, 0, 0;
    geometry::build_connectivity(scene.bodies[0].mesh, {{0, 1}, {0, 2}});
    CHECK(moments()(2, 2) == 0);
}

TEST_CASE("Friction: pairs, else geometric means of what bodies have", "[model]") {
    std::vector<scene::Body> bodies;
    for (int i = 0; i < 5; ++i) bodies.push_back(box_body(std::to_string(i), Vector3(3.0 * i, 0, 0), Vector3(3.0 * i + 1, 1, 1)));
    bodies[1].material = "steel";
    bodies[2].material = "steel";
    bodies[2].mu = 0.9;
    bodies[3].material = "ice";
    bodies[4].material = "wood";  // named, but not listed
    scene::Scene scene = scene_of(bodies);
    scene.friction.mu = 0.3;
    scene.friction.materials = {{"steel", 0.1}, {"ice", 0.02}};
    scene.friction.pairs = {{"ice", "steel", 0.05}};
    scene.friction.eps_v = 1e-4;
    scene.friction.rounds = 2;
    const auto built = build_model(scene);
    REQUIRE(built);
    const auto mu = [&](int a, int b) { return friction_coefficient(*built, a, b); };
    CHECK(mu(0, 0) == 0.3);
    CHECK(mu(1, 1) == 0.1);
    CHECK(mu(2, 2) == 0.9);
    CHECK(mu(0, 4) == 0.3);  // equal ones stay exactly what they are
    CHECK(mu(0, 1) == Approx(std::sqrt(0.03)));
    CHECK(mu(1, 2) == Approx(0.3));
    CHECK(mu(1, 3) == 0.05);
    CHECK(mu(3, 2) == 0.05);
    CHECK(mu(3, 4) == Approx(std::sqrt(0.006)));
    CHECK(built->friction.mu == built->friction.mu.transpose());
    CHECK(built->friction.eps_v == 1e-4);
    CHECK(built->friction.rounds == 2);
    scene.friction.rounds = 0;
    CHECK(build_model(scene)->friction.mu.isZero(0));
}

TEST_CASE("Faulty friction, scripts and loads are refused", "[model]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    scene::Scene scene = scene_of({box_body("box", {0, 0, 0}, {1, 1, 1})});
    const auto error = [&] { return only_error(build_model(scene)); };
    SECTION("mu") {
        scene.friction.mu = -0.1;
        CHECK(error().where == "a.scene.json#/friction/mu");
    }
    SECTION("of a material") {
        scene.friction.materials["steel"] = nan;
        CHECK(contains(error().message, "`steel`"));
    }
    SECTION("of a pair") {
        scene.friction.pairs = {{"a", "b", -1}};
        CHECK(contains(error().message, "`a` and `b`"));
    }
    SECTION("of a body") {
        scene.bodies[0].mu = -1;
        CHECK(error().where == "a.scene.json#/bodies/box/mu");
    }
    SECTION("eps_v") {
        scene.friction.eps_v = 0;
        CHECK(error().where == "a.scene.json#/friction/eps_v");
    }
    SECTION("torque") {
        scene.bodies[0].torque.y() = nan;
        CHECK(error().code == ErrorCode::not_finite);
    }
    SECTION("scripts") {
        scene.bodies[0].script.times = {1, 2};
        scene.bodies[0].script.poses.resize(2);
        CHECK(error().code == ErrorCode::inconsistent);  // of a dynamic body
        scene.bodies[0].type = BodyType::kinematic_body;
        CHECK(build_model(scene));
        scene.bodies[0].script.times = {1, 1};
        CHECK(error().code == ErrorCode::out_of_range);
        scene.bodies[0].script.times = {0, 1};
        CHECK(error().code == ErrorCode::out_of_range);
        scene.bodies[0].script.times = {1};
        CHECK(error().code == ErrorCode::out_of_range);
        scene.bodies[0].script.times = {1, 2};
        scene.bodies[0].script.poses[1].position.x() = nan;
        CHECK(error().code == ErrorCode::out_of_range);
    }
}

TEST_CASE("Scripts, loads and settings arrive, about the reference point", "[model]") {
    scene::Body box = box_body("box", {0, 0, 0}, {2, 2, 2});
    box.torque = {1, 2, 3};
    scene::Body driven = box_body("driven", {4, 0, 0}, {6, 2, 2});
    driven.type = BodyType::kinematic_body;
    driven.script.times = {0.5};
    driven.script.poses = {{kinematics::rotation({0.1, 0.2, 0.3}), Vector3(7, 8, 9)}};
    scene::Scene scene = scene_of({box, driven});
    scene.integrator = scene::Integrator::bdf2;
    scene.area_weighted = true;
    const auto model = build_model(scene);
    REQUIRE(model);
    CHECK(model->bodies[0].torque == Vector3(1, 2, 3));
    CHECK(model->integrator == scene::Integrator::bdf2);
    CHECK(model->area_weighted);
    CHECK(model->adaptive_kappa);
    const Body& body = model->bodies[1];
    CHECK(body.script.times == driven.script.times);
    for (int i = 0; i < 8; ++i) {
        const Vector3 expected = kinematics::world_position(driven.script.poses[0], driven.mesh.vertices.col(i));
        CHECK((kinematics::world_position(body.script.poses[0], body.mesh.vertices.col(i)) - expected).norm() < 1e-14);
    }
    scene.kappa = 5;
    CHECK_FALSE(build_model(scene)->adaptive_kappa);
    scene.kappa.reset();
    BuildOptions options;
    options.kappa = 5;
    CHECK_FALSE(build_model(scene, options)->adaptive_kappa);
}

TEST_CASE("Damping of contacts arrives, is warned of in quasi-statics, and must be a finite time", "[model]") {
    scene::Scene scene = scene_of({box_body("box", {0, 0, 0}, {2, 2, 2})});
    scene.contact_damping_time = 0.004;
    const auto model = build_model(scene);
    REQUIRE(model);
    CHECK(model->contact_damping_time == 0.004);
    CHECK(model->warnings.empty());
    scene.integrator = scene::Integrator::quasi_static;
    const auto still = build_model(scene);
    REQUIRE(still);
    REQUIRE(still->warnings.size() == 1);
    CHECK(still->warnings[0].find("contact.damping_time has no effect") != std::string::npos);
    for (const double wrong : {-1e-3, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        scene.contact_damping_time = wrong;
        const auto refused = build_model(scene);
        REQUIRE_FALSE(refused);
        CHECK(refused.errors().at(0).where.find("/contact/damping_time") != std::string::npos);
    }
}

TEST_CASE("Who may collide", "[model]") {
    std::vector<scene::Body> bodies;
    for (int i = 0; i < 5; ++i) bodies.push_back(box_body(std::to_string(i), Vector3(3.0 * i, 0, 0), Vector3(3.0 * i + 1, 1, 1)));
    bodies[2].type = BodyType::static_body;
    bodies[3].type = BodyType::kinematic_body;
    bodies[0].group = bodies[4].group = 7;
    const auto model = build_model(scene_of(bodies));
    REQUIRE(model);
    CHECK(may_collide(*model, 0, 1));
    CHECK(may_collide(*model, 1, 2));
    CHECK(may_collide(*model, 3, 1));
    CHECK_FALSE(may_collide(*model, 2, 3));
    CHECK_FALSE(may_collide(*model, 0, 4));
    CHECK_FALSE(may_collide(*model, 1, 1));
    for (const auto& dof : model->bodies[2].prescribed) CHECK(dof.has_value());
    for (int dof = 0; dof < 6; ++dof) CHECK(is_free(model->bodies[1], dof));
}

TEST_CASE("Meshes that cannot be a dynamic solid are refused", "[model]") {
    scene::Body open = box_body("lid", {0, 0, 0}, {1, 1, 1});
    open.mesh.triangles.pop_back();
    geometry::build_connectivity(open.mesh);
    SECTION("open, strict") {
        const auto result = build_model(scene_of({open}));
        REQUIRE_FALSE(result);
        CHECK(result.errors().front().code == ErrorCode::mesh_invalid);
        CHECK(contains(result.errors().front().message, "`lid`"));
        CHECK(contains(result.errors().front().where, "a.scene.json#/bodies/lid"));
    }
    SECTION("open, lenient: a solid as long as what is open is small") {
        open.mesh_policy = scene::MeshPolicy::lenient;
        CHECK(build_model(scene_of({open})).value().bodies[0].moments(3, 3) == Approx(1000));
        open.mesh.triangles.resize(10);
        geometry::build_connectivity(open.mesh);
        CHECK(only_error(build_model(scene_of({open}))).code == ErrorCode::mesh_invalid);
    }
    SECTION("open, as a shell, strict or not; but not where nothing has an area") {
        open.mass_kind = scene::MassKind::area;
        CHECK(build_model(scene_of({open})).value().bodies[0].moments(3, 3) == Approx(5500));
        open.mesh.triangles.clear();
        geometry::build_connectivity(open.mesh);
        CHECK(contains(only_error(build_model(scene_of({open}))).message, "kg/m^2"));
        open.mass_kind = scene::MassKind::length;
        CHECK(contains(only_error(build_model(scene_of({open}))).message, "kg/m:"));
    }
    SECTION("open but static or kinematic is fine") {
        open.type = BodyType::static_body;
        CHECK(build_model(scene_of({open})));
        open.type = BodyType::kinematic_body;
        CHECK(build_model(scene_of({open})));
    }
    SECTION("inside out") {
        scene::Body box = box_body("box", {0, 0, 0}, {1, 1, 1});
        box.mesh = tests::inside_out(box.mesh);
        CHECK(build_model(scene_of({box})).errors().front().code == ErrorCode::mesh_invalid);
        box.mesh_policy = scene::MeshPolicy::lenient;
        CHECK(only_error(build_model(scene_of({box}))).code == ErrorCode::mesh_invalid);
    }
    SECTION("self-intersecting, static too") {
        scene::Body two = box_body("two", {0, 0, 0}, {1, 1, 1});
        two.mesh = tests::joined(tests::box_mesh({0, 0, 0}, {1, 1, 1}), tests::box_mesh({0.5, 0.5, 0.5}, {2, 2, 2}));
        for (const auto type : {BodyType::dynamic_body, BodyType::static_body}) {
            two.type = type;
            const auto result = build_model(scene_of({two}));
            REQUIRE_FALSE(result);
            CHECK(result.errors().front().code == ErrorCode::mesh_invalid);
            CHECK(contains(result.errors().front().message, "triangle"));
        }
        BuildOptions options;
        options.check_meshes = false;
        CHECK(build_model(scene_of({two}), options));
    }
    SECTION("a vertex that is not a number") {
        scene::Body box = box_body("box", {0, 0, 0}, {1, 1, 1});
        box.mesh.vertices(1, 5) = std::numeric_limits<double>::quiet_NaN();
        const auto error = only_error(build_model(scene_of({box})));
        CHECK(error.code == ErrorCode::not_finite);
        CHECK(contains(error.message, "vertex 5"));
    }
    SECTION("every fault of every body is told") {
        scene::Body box = box_body("box", {5, 0, 0}, {6, 1, 1});
        box.density = -1;
        CHECK(build_model(scene_of({open, box})).errors().size() >= 2);
    }
}

TEST_CASE("Stiffness follows mass, step, load and activation distance", "[model]") {
    scene::Body box = box_body("box", {0, 0, 0}, {1, 1, 1});  // 1000 kg
    scene::Scene scene = scene_of({box});
    scene.dhat = 1e-3;
    scene.timestep = 0.01;
    CHECK(build_model(scene)->kappa == Approx(0.1 * 1000 / 1e-4));
    scene.gravity = {0, -10, 0};
    CHECK(build_model(scene)->kappa == Approx(4 * 1000 * 10 / 1e-3));
    scene.bodies[0].force = {0, 10'000, 0};  // carries the weight
    CHECK(build_model(scene)->kappa == Approx(0.1 * 1000 / 1e-4));
    scene.kappa = 5;
    CHECK(build_model(scene)->kappa == 5);
    BuildOptions options;
    options.kappa = 6;
    CHECK(build_model(scene, options)->kappa == 6);
}

TEST_CASE("Defaults of size follow what moves", "[model]") {
    scene::Body cube = box_body("cube", {0, 0, 0.1}, {1, 1, 1.1});
    scene::Body ground = box_body("ground", {-50, -50, -1}, {50, 50, 0});
    ground.type = scene::BodyType::static_body;
    const auto on_ground = build_model(scene_of({cube, ground})), alone = build_model(scene_of({cube}));
    REQUIRE(on_ground);
    REQUIRE(alone);
    CHECK(on_ground->dhat == alone->dhat);
    CHECK(on_ground->dhat == 1e-3 * alone->diagonal);
    CHECK(on_ground->velocity_tolerance == alone->velocity_tolerance);
    CHECK(on_ground->diagonal > 100);
    // Nothing moves: the size of everything is all there is.
    cube.type = scene::BodyType::static_body;
    const auto at_rest = build_model(scene_of({cube, ground}));
    CHECK(at_rest->dhat == 1e-3 * at_rest->diagonal);
}

}  // namespace

}  // namespace fettle::core::setup::build_model_test
