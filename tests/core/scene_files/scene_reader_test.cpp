// SPDX-License-Identifier: MIT
#include "core/scene_files/scene_reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>

#include "core/setup/build_model.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/core/scene_files/scene_workshop.hpp"

namespace fettle::core::scene_files::scene_reader_test {

namespace {

using base::ErrorCode;
using namespace test_support;

constexpr double pi = std::numbers::pi;

TEST_CASE("A plain scene needs no tuning", "[scene]") {
    const Workshop shop;
    const auto scene = shop.read(plain());
    REQUIRE(scene);
    CHECK(scene->length_unit == 0.001);
    CHECK(scene->timestep == 0.01);
    CHECK_FALSE(scene->end_time);
    CHECK_FALSE(scene->dhat);
    CHECK(scene->dmin == 0);
    CHECK_FALSE(scene->kappa);
    CHECK(scene->gravity == Vector3::Zero());
    REQUIRE(scene->bodies.size() == 1);
    const scene::Body& body = scene->bodies[0];
    CHECK(body.type == scene::BodyType::dynamic_body);
    CHECK(body.mesh_policy == scene::MeshPolicy::tolerant);
    CHECK(contains(body.where, "a.scene.json#/bodies/0"));
    CHECK((body.mesh.vertices.rowwise().maxCoeff() - Vector3(0.001, 0.002, 0.003)).norm() < 1e-17);
    for (const auto& dof : body.prescribed) CHECK_FALSE(dof);
}

TEST_CASE("Every key arrives, in SI units", "[scene]") {
    const Workshop shop;
    const json text = json::parse(R"({
        "$schema": "x", "description": "y", "fettle_scene": 1, "units": "mm", "gravity": [0, -9.81, 0], "timestep": 0.002, "end_time": 2.5,
        "contact": {"dhat": 0.05, "dmin": "10um", "kappa": 3e4, "velocity_tolerance": 1, "max_newton_iterations": 50},
        "bodies": [
          {"name": "a", "mesh": "above.obj", "mesh_unit": "cm", "scale": [1, 2, 0.5], "density": 1240, "position": [1, "2cm", 3],
           "rotation": [90, 0, 90], "reference_point": [1, 1, 1], "linear_velocity": [10, 0, 0], "angular_velocity": [0, 0, 180], "force": [1, 2, 3],
           "fixed": ["px", "rx"], "prescribed": {"rz": {"rate": 360, "stop_time": 1}, "py": {"times": [0, 1], "values": [0, "1in"]}}, "group": 2},
          {"name": "b", "mesh": "far.obj", "type": "static", "rotation_vector": [0, 90, 0]},
          {"name": "c", "mesh": "near.obj", "type": "kinematic", "prescribed": {"px": {"rate": 5}}, "scale": 2}]})");
    const auto scene = shop.read(text);
    REQUIRE(scene);
    CHECK(scene->gravity == Vector3(0, -9.81, 0));
    CHECK(scene->timestep == 0.002);
    CHECK(scene->end_time == 2.5);
    CHECK(scene->dhat == 0.05 / 1000);
    CHECK(scene->dmin == 1e-5);
    CHECK(scene->kappa == 3e4);
    CHECK(scene->velocity_tolerance == 1e-3);
    CHECK(scene->max_newton_iterations == 50);
    const scene::Body &a = scene->bodies[0], &b = scene->bodies[1], &c = scene->bodies[2];
    CHECK(a.mesh.vertices.rowwise().maxCoeff().isApprox(Vector3(0.01, 0.04, 0.015)));
    CHECK(a.density == 1240);
    CHECK(a.pose.position.isApprox(Vector3(0.001, 0.02, 0.003)));
    Matrix3 expected;
    expected << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x -> y, y -> z, z -> x
    CHECK(a.pose.rotation == expected);     // exactly
    CHECK(a.reference_point->isApprox(Vector3(0.001, 0.001, 0.001)));
    CHECK(a.linear_velocity == Vector3(0.01, 0, 0));
    CHECK(a.angular_velocity.isApprox(Vector3(0, 0, pi)));
    CHECK(a.force == Vector3(1, 2, 3));
    CHECK(a.group == 2);
    REQUIRE(a.prescribed[0]);
    CHECK(scene::motion_value(*a.prescribed[0], 5) == 0);
    REQUIRE(a.prescribed[1]);
    CHECK(scene::motion_value(*a.prescribed[1], 0.5) == Approx(0.0127));
    CHECK_FALSE(a.prescribed[2]);
    REQUIRE(a.prescribed[5]);
    CHECK(scene::motion_value(*a.prescribed[5], 0.25) == Approx(pi / 2));
    CHECK(scene::motion_value(*a.prescribed[5], 7) == Approx(2 * pi));
    CHECK((b.pose.rotation * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-15);
    CHECK(b.type == scene::BodyType::static_body);
    CHECK(c.type == scene::BodyType::kinematic_body);
    CHECK(c.mesh.vertices.maxCoeff() == Approx(0.006));
    for (int dof = 0; dof < 6; ++dof) {
        REQUIRE(b.prescribed[dof]);
        REQUIRE(c.prescribed[dof]);
        CHECK(scene::motion_value(*b.prescribed[dof], 3) == 0);
        CHECK(scene::motion_value(*c.prescribed[dof], 3) == Approx(dof == 0 ? 0.015 : 0));
    }
}

TEST_CASE("Materials, friction and integrators arrive", "[scene]") {
    const Workshop shop;
    const json text = json::parse(R"({
        "fettle_scene": 1, "units": "mm", "integrator": "bdf2", "contact": {"area_weighted": true, "damping_time": 0.004},
        "materials": {"PLA": {"density": 1240, "mu": 0.3}, "steel": {"density": 7850}, "felt": {"mu": 0.7}},
        "friction": {"mu": 0.2, "pairs": [{"a": "steel", "b": "PLA", "mu": 0.15}, {"a": "felt", "b": "felt", "mu": 0}],
                     "eps_v": "10um", "rounds": 3},
        "bodies": [
          {"name": "a", "mesh": "near.obj", "material": "PLA", "torque": [1, 2, 3], "group": "fixture"},
          {"name": "b", "mesh": "near.obj", "material": "steel", "density": 5, "mu": 0.4, "group": 7},
          {"name": "c", "mesh": "near.obj", "material": "felt", "density": 6, "group": "fixture"},
          {"name": "d", "mesh": "near.obj", "type": "static", "material": "felt", "group": "other"}]})");
    const auto scene = shop.read(text);
    REQUIRE(scene);
    CHECK(scene->integrator == scene::Integrator::bdf2);
    CHECK(scene->area_weighted);
    CHECK(scene->contact_damping_time == 0.004);
    CHECK(scene->friction.mu == 0.2);
    CHECK(scene->friction.materials == std::map<std::string, double>{{"PLA", 0.3}, {"felt", 0.7}});
    REQUIRE(scene->friction.pairs.size() == 2);
    CHECK(scene->friction.pairs[0].material_a == "steel");
    CHECK(scene->friction.pairs[0].material_b == "PLA");
    CHECK(scene->friction.pairs[0].mu == 0.15);
    CHECK(scene->friction.eps_v == Approx(1e-5));
    CHECK(scene->friction.rounds == 3);
    const auto& bodies = scene->bodies;
    CHECK(bodies[0].density == 1240);
    CHECK(bodies[0].material == "PLA");
    CHECK_FALSE(bodies[0].mu);
    CHECK(bodies[0].torque == Vector3(1, 2, 3));
    CHECK(bodies[1].density == 5);
    CHECK(bodies[1].mu == 0.4);
    CHECK(bodies[0].group == bodies[2].group);
    CHECK(std::set<int>{bodies[0].group, bodies[1].group, bodies[3].group}.size() == 3);
    CHECK(bodies[1].group == 7);
    for (const scene::Body& body : bodies) CHECK(body.group >= 0);

    const auto plainly = shop.read(plain());
    CHECK(plainly->integrator == scene::Integrator::implicit_euler);
    CHECK(plainly->friction.mu == 0);
    CHECK(plainly->friction.eps_v == 1e-3);
    CHECK(plainly->friction.rounds == 2);
    CHECK(plainly->bodies[0].group == -1);
    CHECK(plainly->bodies[0].mass_kind == scene::MassKind::volume);
    CHECK(shop.read(with("/integrator", "newmark"))->integrator == scene::Integrator::newmark);
    CHECK(shop.read(with("/integrator", "quasi_static"))->integrator == scene::Integrator::quasi_static);
    CHECK(plainly->bodies[0].damping.linear == 0);
    CHECK(shop.read(with("/bodies/0/damping", 2.5))->bodies[0].damping.linear == 2.5);
    CHECK(shop.read(with("/bodies/0/damping", 2.5))->bodies[0].damping.angular == 2.5);
    const auto turning = shop.read(with("/bodies/0/damping", {{"angular", 3}}));
    CHECK(turning->bodies[0].damping.linear == 0);
    CHECK(turning->bodies[0].damping.angular == 3);
    CHECK(shop.read(with("/friction", {{"rounds", "converged"}}))->friction.rounds < 0);
    CHECK(shop.read(with("/friction", {{"eps_v", 2}}))->friction.eps_v == 0.002);
}

TEST_CASE("A script holds what it does not say", "[scene]") {
    const Workshop shop;
    json text = with("/bodies/0/type", "kinematic");
    text["bodies"][0]["position"] = {10, 0, 0};
    text["bodies"][0]["rotation"] = {0, 0, 30};
    text["bodies"][0]["script"] = json::parse(R"([{"time": 0.5, "position": [20, 0, 0]}, {"time": 1, "rotation": [0, 0, 90]},
        {"time": 1.5, "position": [0, "1cm", 0], "rotation_vector": [90, 0, 0]}])");
    text["bodies"][0]["prescribed"] = {{"rz", {{"rate", 360}}}};
    const auto scene = shop.read(text);
    REQUIRE(scene);
    const scene::PoseScript& script = scene->bodies[0].script;
    CHECK(script.times == std::vector<double>{0.5, 1, 1.5});
    CHECK(script.poses[0].position.isApprox(Vector3(0.02, 0, 0)));
    CHECK(script.poses[0].rotation == scene->bodies[0].pose.rotation);
    CHECK(script.poses[1].position == script.poses[0].position);
    CHECK(script.poses[1].rotation.isApprox(kinematics::rotation({0, 0, pi / 2})));
    CHECK(script.poses[2].position.isApprox(Vector3(0, 0.01, 0)));
    CHECK(script.poses[2].rotation.isApprox(kinematics::rotation({pi / 2, 0, 0})));
    CHECK(scene::motion_value(*scene->bodies[0].prescribed[5], 1) == Approx(2 * pi));
}

TEST_CASE("Shells, wires and points, from files and written out", "[scene]") {
    const Workshop shop;
    std::ofstream(shop.root / "scenes" / "wire.obj") << "v 0 0 0\nv 3 0 0\nv 3 4 0\nl 1 2 3\n";
    const auto built = [&](const json& body) {
        json text = plain();
        text["bodies"][0] = body;
        const auto scene = shop.read(text);
        for (const auto& error : scene.errors()) FAIL_CHECK(error.where + ": " + error.message);
        REQUIRE(scene);
        const auto model = setup::build_model(*scene);
        for (const auto& error : model.errors()) FAIL_CHECK(error.where + ": " + error.message);
        REQUIRE(model);
        return model->bodies[0];
    };
    CHECK(built(json::parse(R"({"name": "w", "mesh": "wire.obj", "mass_per": "length", "density": 2})")).moments(3, 3) == Approx(0.014));
    const json corner = json::parse(R"({"name": "w", "vertices": [[0,0,0],[3,0,0],[3,"4mm",0]], "edges": [[0,1],[1,2]], "density": 2,
                                        "mass_per": "length"})");
    const auto wire = built(corner);
    CHECK(wire.moments(3, 3) == Approx(0.014));
    CHECK(wire.reference_point.isApprox(Vector3((3 * 1.5 + 4 * 3) / 7e3, 4 * 2 / 7e3, 0)));
    json points = corner;
    points.erase("edges");
    points["mass_per"] = "vertex";
    CHECK(built(points).moments(3, 3) == Approx(6));
    json sheet = points;
    sheet["mass_per"] = "area";
    sheet["triangles"] = {{0, 1, 2}};
    sheet["scale"] = 10;
    CHECK(built(sheet).moments(3, 3) == Approx(2 * 6e-4));
    sheet["mass_per"] = "length";  // all edges
    CHECK(built(sheet).moments(3, 3) == Approx(2 * 0.12));
    // An open mesh with a density per volume is told what to do.
    json text = plain();
    sheet.erase("mass_per");
    text["bodies"][0] = sheet;
    const auto refused = setup::build_model(*shop.read(text));
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].code == ErrorCode::mesh_invalid);
}

TEST_CASE("Components become bodies of their own", "[scene]") {
    const Workshop shop;
    const auto box = tests::joined(tests::box_mesh({0, 0, 0}, {1, 1, 1}), tests::box_mesh({5, 0, 0}, {6, 1, 2}));
    std::ostringstream text;
    for (Eigen::Index i = 0; i < box.vertices.cols(); ++i) text << "v " << box.vertices.col(i).transpose() << "\n";
    for (const auto& t : box.triangles) text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    std::ofstream(shop.root / "scenes" / "two.obj") << text.str();
    std::ofstream(shop.root / "scenes" / "odd.obj") << text.str() << "v 9 9 9\nv 9 9 8\nl -1 -2\n";
    json scene = with("/bodies/0/mesh", "two.obj");
    CHECK(shop.read(scene)->bodies.size() == 1);
    scene["bodies"][0]["split_components"] = true;
    const auto split = shop.read(scene);
    REQUIRE(split);
    REQUIRE(split->bodies.size() == 2);
    CHECK(split->bodies[0].name == "box-0");
    CHECK(split->bodies[1].name == "box-1");
    const auto model = setup::build_model(*split);
    REQUIRE(model);
    CHECK(model->bodies[1].moments(3, 3) == Approx(1240 * 2e-9));
    CHECK(model->bodies[1].reference_point.isApprox(Vector3(5.5e-3, 0.5e-3, 1e-3)));
    json whole = with("/bodies/0/split_components", true);  // one component keeps its name
    CHECK(shop.read(whole)->bodies[0].name == "box");

    const auto void_in = tests::inside_out(tests::box_mesh({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}));
    std::ostringstream hollow;  // the second box has a void, which is no body
    const auto with_void =
        tests::joined(tests::box_mesh({5, 0, 0}, {6, 1, 2}), tests::joined(tests::box_mesh({0, 0, 0}, {1, 1, 1}), void_in));
    for (Eigen::Index i = 0; i < with_void.vertices.cols(); ++i) hollow << "v " << with_void.vertices.col(i).transpose() << "\n";
    for (const auto& t : with_void.triangles) hollow << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    std::ofstream(shop.root / "scenes" / "hollow.obj") << hollow.str();
    json of_solids = scene;
    of_solids["bodies"][0]["mesh"] = "hollow.obj";
    const auto solids = shop.read(of_solids);
    REQUIRE(solids);
    REQUIRE(solids->bodies.size() == 2);
    CHECK(setup::build_model(*solids)->bodies[1].moments(3, 3) == Approx(1240 * (1 - 0.6 * 0.6 * 0.6) * 1e-9));

    const auto fails = [&](json& wrong, const std::string& message) {
        const auto errors = shop.read(wrong).errors();
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].code == ErrorCode::inconsistent);
        CHECK(contains(errors[0].where, "#/bodies/0/split_components"));
        CHECK(contains(errors[0].message, message));
    };
    json odd = scene, about = scene;
    odd["bodies"][0]["mesh"] = "odd.obj";
    fails(odd, "no triangle");
    about["bodies"][0]["reference_point"] = {0, 0, 0};
    fails(about, "reference_point");
    json taken = scene;
    taken["bodies"].push_back(taken["bodies"][0]);
    taken["bodies"][1]["name"] = "box-1";
    taken["bodies"][1]["split_components"] = false;
    const auto errors = shop.read(taken).errors();
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == ErrorCode::inconsistent);
}

TEST_CASE("A motion table is piecewise linear, constant outside, and stops", "[scene]") {
    scene::MotionCurve curve;
    curve.times = {1, 2, 4};
    curve.values = {0, 3, -1};
    CHECK(scene::motion_value(curve, 0) == 0);
    CHECK(scene::motion_value(curve, 1.5) == 1.5);
    CHECK(scene::motion_value(curve, 2) == 3);
    CHECK(scene::motion_value(curve, 3) == 1);
    CHECK(scene::motion_value(curve, 9) == -1);
    curve.rate = 2;
    CHECK(scene::motion_value(curve, 3) == 7);
    curve.stop_time = 2;
    CHECK(scene::motion_value(curve, 3) == 7);  // 2 * 2 + 3
    CHECK(scene::motion_value(curve, 1.5) == 4.5);
}

TEST_CASE("Shapes are made by whoever has parts", "[scene]") {
    const Workshop shop;
    json text = plain();
    text["bodies"][0].erase("mesh");
    text["bodies"][0]["shape"] =
        json::parse(R"({"part": "pin", "dimensions": {"radius": 2.5, "length": "1cm"}, "counts": {"facets": 32}})");
    SECTION("none here") {
        const auto errors = shop.read(text).errors();
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].code == ErrorCode::unsupported);
        CHECK(contains(errors[0].where, "#/bodies/0/shape"));
    }
    SECTION("given") {
        scene::ReadOptions options;
        options.shape_maker = [](const scene::ShapeSpec& spec) -> base::Result<geometry::Mesh> {
            CHECK(spec.part == "pin");
            const double r = spec.dimensions.at("radius");
            CHECK(r == 0.0025);
            CHECK(spec.counts.at("facets") == 32);
            return tests::box_mesh({-r, -r, 0}, {r, r, spec.dimensions.at("length")});
        };
        const auto scene = shop.read(text, options);
        REQUIRE(scene);
        REQUIRE(scene->bodies[0].shape);
        CHECK(scene->bodies[0].shape->dimensions.at("length") == 0.01);
        CHECK(scene->bodies[0].mesh.vertices.maxCoeff() == 0.01);
    }
    SECTION("none is asked for where a number or the unit is wrong, which alone is told") {
        scene::ReadOptions options;
        options.shape_maker = [](const scene::ShapeSpec&) -> base::Result<geometry::Mesh> {
            return base::Error{ErrorCode::out_of_range, "facets", "facets is 0"};
        };
        json many = text, unknown = text;
        many["bodies"][0]["shape"]["counts"]["facets"] = 99999999999;
        unknown["units"] = "parsec";
        for (const auto& [scene, where] : {std::pair{many, "#/bodies/0/shape/counts/facets"}, {unknown, "#/units"}}) {
            const auto errors = shop.read(scene, options).errors();
            REQUIRE(errors.size() == 1);
            CHECK(contains(errors[0].where, where));
        }
    }
    SECTION("that fails") {
        scene::ReadOptions options;
        options.shape_maker = [](const scene::ShapeSpec&) -> base::Result<geometry::Mesh> {
            return base::Error{ErrorCode::out_of_range, "radius", "too small"};
        };
        const auto errors = shop.read(text, options).errors();
        REQUIRE(errors.size() == 1);
        CHECK(contains(errors[0].where, "#/bodies/0/shape"));
        CHECK(contains(errors[0].message, "radius: too small"));
    }
}

/// The keys that the reader accepts in the object at `pointer`, from its own message.
std::vector<std::string> accepted_keys(const Workshop& shop, json scene, const std::string& pointer) {
    const std::string stranger = "@@@@@@@@@@@@@@@@@@@@@@@@@@@@@@";
    scene[json::json_pointer(pointer + "/" + stranger)] = 1;
    const base::Errors errors = shop.read(scene).errors();
    for (const auto& error : errors) {
        if (!contains(error.where, stranger)) continue;
        std::string list = error.message.substr(error.message.find("there are ") + 10);
        std::replace(list.begin(), list.end(), ',', ' ');
        std::istringstream words(list);
        std::vector<std::string> keys{std::istream_iterator<std::string>(words), {}};
        std::sort(keys.begin(), keys.end());
        return keys;
    }
    return {};
}

TEST_CASE("The schema lists exactly the keys that the reader accepts", "[scene]") {
    const Workshop shop;
    const json schema = json::parse(std::ifstream(FETTLE_SOURCE_DIR "/core/scene_files/scene.schema.json"));
    json scene = with("/contact", json::object());
    scene["friction"]["pairs"] = json::array({json::object()});
    scene["materials"] = {{"PLA", json::object()}};
    scene["bodies"][0]["type"] = "kinematic";
    scene["bodies"][0]["script"] = json::array({json::object()});
    scene["bodies"][0]["prescribed"] = {{"rz", json::object()}};
    json shaped = with("/bodies/0/shape", {{"part", "x"}});
    shaped["bodies"][0].erase("mesh");
    json made = shaped;  // what a part takes depends on who makes it
    made["bodies"][0]["shape"] = {{"program", {"make"}}};
    json of_file = shaped;
    of_file["bodies"][0]["shape"] = {{"part", "x"}};
    json written_here = shaped;
    written_here["bodies"][0]["shape"] = {{"solid", {{"sphere", 1}}}};
    json handled = shaped;
    handled["bodies"][0]["shape"] = {{"mesh", "none.stl"}, {"handles", json::object()}};
    const std::vector<std::tuple<std::string, std::vector<json>, json>> objects{
        {"", {scene}, schema.at("properties")},
        {"/contact", {scene}, schema.at("properties").at("contact").at("properties")},
        {"/friction", {scene}, schema.at("properties").at("friction").at("properties")},
        {"/friction/pairs/0", {scene}, schema.at("$defs").at("friction_pair").at("properties")},
        {"/materials/PLA", {scene}, schema.at("$defs").at("material").at("properties")},
        {"/bodies/0/script/0", {scene}, schema.at("$defs").at("scripted_pose").at("properties")},
        {"/bodies/0", {scene}, schema.at("$defs").at("body").at("properties")},
        {"/bodies/0/prescribed", {scene}, schema.at("$defs").at("body").at("properties").at("prescribed").at("properties")},
        {"/bodies/0/prescribed/rz", {scene}, schema.at("$defs").at("motion").at("properties")},
        {"/bodies/0/shape", {shaped, made, of_file, written_here, handled}, schema.at("$defs").at("shape").at("properties")},
    };
    for (const auto& [pointer, documents, properties] : objects) {
        CAPTURE(pointer);
        std::set<std::string> documented, accepted;
        for (const auto& [key, value] : properties.items()) documented.insert(key);
        for (const json& document : documents) {
            const std::vector<std::string> keys = accepted_keys(shop, document, pointer);
            accepted.insert(keys.begin(), keys.end());
        }
        CHECK(documented == accepted);
    }
}

}  // namespace

}  // namespace fettle::core::scene_files::scene_reader_test
