// SPDX-License-Identifier: MIT
#include "fettle/core/scene/scene_reader.hpp"

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>

#include "fettle/core/model/build_model.hpp"
#include "fettle/tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::scene {
namespace {

namespace fs = std::filesystem;
using base::ErrorCode;
using nlohmann::json;

constexpr double pi = std::numbers::pi;

/// A folder with a scene in scenes/ and meshes in three of the places where they are looked for.
class Workshop {
public:
    Workshop() {
        fs::create_directories(root / "scenes");
        fs::create_directories(root / "meshes");
        fs::create_directories(root / "elsewhere");
        write("scenes/near.obj");
        write("meshes/above.obj");
        write("elsewhere/far.obj");
    }
    ~Workshop() { fs::remove_all(root); }

    void write(const std::string& name, const std::string& more = {}) const {
        std::ofstream file(root / name);
        const auto box = tests::box_mesh({0, 0, 0}, {1, 2, 3});
        for (Eigen::Index i = 0; i < 8; ++i) file << "v " << box.vertices.col(i).transpose() << "\n";
        for (const auto& t : box.triangles) file << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
        file << more;
    }
    base::Result<Scene> read(const json& scene, ReadOptions options = {}) const {
        options.mesh_dirs.push_back((root / "elsewhere").string());
        return parse_scene(scene.dump(), (root / "scenes" / "a.scene.json").string(), options);
    }

    fs::path root = fs::temp_directory_path() / ("fettle-scene-" + std::to_string(::getpid()));
};

json plain() {
    return json::parse(R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "box", "mesh": "near.obj", "density": 1240}]})");
}

/// `plain()` with one value replaced or added.
json with(const std::string& pointer, const json& value) {
    json scene = plain();
    scene[json::json_pointer(pointer)] = value;
    return scene;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

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
    const Body& body = scene->bodies[0];
    CHECK(body.type == BodyType::dynamic_body);
    CHECK(body.mesh_policy == MeshPolicy::strict);
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
    const Body &a = scene->bodies[0], &b = scene->bodies[1], &c = scene->bodies[2];
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
    CHECK(motion_value(*a.prescribed[0], 5) == 0);
    REQUIRE(a.prescribed[1]);
    CHECK(motion_value(*a.prescribed[1], 0.5) == Approx(0.0127));
    CHECK_FALSE(a.prescribed[2]);
    REQUIRE(a.prescribed[5]);
    CHECK(motion_value(*a.prescribed[5], 0.25) == Approx(pi / 2));
    CHECK(motion_value(*a.prescribed[5], 7) == Approx(2 * pi));
    CHECK((b.pose.rotation * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-15);
    CHECK(b.type == BodyType::static_body);
    CHECK(c.type == BodyType::kinematic_body);
    CHECK(c.mesh.vertices.maxCoeff() == Approx(0.006));
    for (int dof = 0; dof < 6; ++dof) {
        REQUIRE(b.prescribed[dof]);
        REQUIRE(c.prescribed[dof]);
        CHECK(motion_value(*b.prescribed[dof], 3) == 0);
        CHECK(motion_value(*c.prescribed[dof], 3) == Approx(dof == 0 ? 0.015 : 0));
    }
}

TEST_CASE("Materials, friction and integrators arrive", "[scene]") {
    const Workshop shop;
    const json text = json::parse(R"({
        "fettle_scene": 1, "units": "mm", "integrator": "bdf2", "contact": {"area_weighted": true},
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
    CHECK(scene->integrator == Integrator::bdf2);
    CHECK(scene->area_weighted);
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
    for (const Body& body : bodies) CHECK(body.group >= 0);

    const auto plainly = shop.read(plain());
    CHECK(plainly->integrator == Integrator::implicit_euler);
    CHECK(plainly->friction.mu == 0);
    CHECK(plainly->friction.eps_v == 1e-3);
    CHECK(plainly->friction.rounds == 1);
    CHECK(plainly->bodies[0].group == -1);
    CHECK(plainly->bodies[0].mass_kind == MassKind::volume);
    CHECK(shop.read(with("/integrator", "newmark"))->integrator == Integrator::newmark);
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
    const PoseScript& script = scene->bodies[0].script;
    CHECK(script.times == std::vector<double>{0.5, 1, 1.5});
    CHECK(script.poses[0].position.isApprox(Vector3(0.02, 0, 0)));
    CHECK(script.poses[0].rotation == scene->bodies[0].pose.rotation);
    CHECK(script.poses[1].position == script.poses[0].position);
    CHECK(script.poses[1].rotation.isApprox(kinematics::rotation({0, 0, pi / 2})));
    CHECK(script.poses[2].position.isApprox(Vector3(0, 0.01, 0)));
    CHECK(script.poses[2].rotation.isApprox(kinematics::rotation({pi / 2, 0, 0})));
    CHECK(motion_value(*scene->bodies[0].prescribed[5], 1) == Approx(2 * pi));
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
        const auto model = model::build_model(*scene);
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
    const auto refused = model::build_model(*shop.read(text));
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
    const auto model = model::build_model(*split);
    REQUIRE(model);
    CHECK(model->bodies[1].moments(3, 3) == Approx(1240 * 2e-9));
    CHECK(model->bodies[1].reference_point.isApprox(Vector3(5.5e-3, 0.5e-3, 1e-3)));
    json whole = with("/bodies/0/split_components", true);  // one component keeps its name
    CHECK(shop.read(whole)->bodies[0].name == "box");

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
    MotionCurve curve;
    curve.times = {1, 2, 4};
    curve.values = {0, 3, -1};
    CHECK(motion_value(curve, 0) == 0);
    CHECK(motion_value(curve, 1.5) == 1.5);
    CHECK(motion_value(curve, 2) == 3);
    CHECK(motion_value(curve, 3) == 1);
    CHECK(motion_value(curve, 9) == -1);
    curve.rate = 2;
    CHECK(motion_value(curve, 3) == 7);
    curve.stop_time = 2;
    CHECK(motion_value(curve, 3) == 7);  // 2 * 2 + 3
    CHECK(motion_value(curve, 1.5) == 4.5);
}

struct Wrong {
    json scene;
    ErrorCode code;
    std::string where, message;
};

TEST_CASE("Each wrong input gives its message and its place", "[scene]") {
    const Workshop shop;
    json twice = plain();
    twice["bodies"].push_back(twice["bodies"][0]);
    json no_units = plain(), no_density = plain(), no_name = plain(), no_geometry = plain(), none = plain();
    no_units.erase("units");
    no_density["bodies"][0].erase("density");
    no_name["bodies"][0].erase("name");
    no_geometry["bodies"][0].erase("mesh");
    none["bodies"] = json::array();
    json static_force = with("/bodies/0/type", "static");
    static_force["bodies"][0]["force"] = {0, 0, 1};
    json both = with("/bodies/0/fixed", {"rz"});
    both["bodies"][0]["prescribed"] = {{"rz", {{"rate", 1}}}};
    json two_rotations = with("/bodies/0/rotation", {0, 0, 1});
    two_rotations["bodies"][0]["rotation_vector"] = {0, 0, 1};
    json both_sources = with("/bodies/0/vertices", {{0, 0, 0}});
    const auto of_kinematic = [](const std::string& key, const json& value) {
        json scene = with("/bodies/0/type", "kinematic");
        scene["bodies"][0][key] = value;
        return scene;
    };
    const auto inline_body = [](const std::string& key, const json& value) {
        json scene = plain();
        scene["bodies"][0].erase("mesh");
        scene["bodies"][0]["vertices"] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
        scene["bodies"][0][key] = value;
        return scene;
    };
    const auto with_materials = [](const std::string& pointer, const json& value) {
        json scene = plain();
        scene["materials"] = {{"PLA", {{"mu", 0.1}}}, {"steel", {{"mu", 0.2}}}};
        scene[json::json_pointer(pointer)] = value;
        return scene;
    };
    const json pair = {{"a", "PLA"}, {"b", "steel"}, {"mu", 0.1}}, reversed = {{"a", "steel"}, {"b", "PLA"}, {"mu", 0.1}};
    json no_material_density = with_materials("/bodies/0/material", "PLA");
    no_material_density["bodies"][0].erase("density");
    json shell_density = with_materials("/bodies/0/material", "PLA");
    shell_density["materials"]["PLA"]["density"] = 1240;
    shell_density["bodies"][0].erase("density");
    shell_density["bodies"][0]["mass_per"] = "area";
    const std::vector<Wrong> cases{
        {with("/integrator", "euler"), ErrorCode::out_of_range, "#/integrator", "implicit_euler"},
        {with("/contact", {{"area_weighted", 1}}), ErrorCode::wrong_type, "#/contact/area_weighted", "true or false"},
        {with("/friction", {{"mu", -0.1}}), ErrorCode::out_of_range, "#/friction/mu", "at least 0"},
        {with("/friction", {{"mu", "inf"}}), ErrorCode::not_finite, "#/friction/mu", "not finite"},
        {with("/friction", {{"muu", 1}}), ErrorCode::unknown_key, "#/friction/muu", "did you mean `mu`?"},
        {with("/friction", {{"eps_v", 0}}), ErrorCode::out_of_range, "#/friction/eps_v", "greater than 0"},
        {with("/friction", {{"rounds", 0}}), ErrorCode::out_of_range, "#/friction/rounds", "at least 1"},
        {with("/friction", {{"rounds", "convergd"}}), ErrorCode::out_of_range, "#/friction/rounds", "did you mean `converged`?"},
        {with_materials("/friction", {{"pairs", {{{"a", "PLA"}, {"b", "steel"}}}}}), ErrorCode::missing_key, "#/friction/pairs/0", "`mu`"},
        {with_materials("/friction", {{"pairs", {{{"a", "PLA"}, {"b", "stel"}, {"mu", 1}}}}}), ErrorCode::out_of_range,
         "#/friction/pairs/0/b", "did you mean `steel`?"},
        {with_materials("/friction", {{"pairs", {{{"a", "PLA"}, {"b", "steel"}, {"mu", -1}}}}}), ErrorCode::out_of_range,
         "#/friction/pairs/0/mu", "at least 0"},
        {with_materials("/friction", {{"pairs", {pair, reversed}}}), ErrorCode::inconsistent, "#/friction/pairs/1", "already"},
        {with_materials("/materials/PLA/densty", 3), ErrorCode::unknown_key, "#/materials/PLA/densty", "did you mean `density`?"},
        {with_materials("/materials/PLA/density", 0), ErrorCode::out_of_range, "#/materials/PLA/density", "greater than 0"},
        {with_materials("/materials/PLA/mu", -1), ErrorCode::out_of_range, "#/materials/PLA/mu", "at least 0"},
        {with_materials("/materials/PLA", 3), ErrorCode::wrong_type, "#/materials/PLA", "an object"},
        {with_materials("/bodies/0/material", "pla"), ErrorCode::out_of_range, "#/bodies/0/material", "PLA"},
        {with("/bodies/0/material", "PLA"), ErrorCode::inconsistent, "#/bodies/0/material", "no `materials`"},
        {with("/bodies/0/material", 3), ErrorCode::wrong_type, "#/bodies/0/material", "a string"},
        {no_material_density, ErrorCode::missing_key, "#/bodies/0", "`density`"},
        {shell_density, ErrorCode::missing_key, "#/bodies/0", "`density`"},
        {with("/bodies/0/mu", -1), ErrorCode::out_of_range, "#/bodies/0/mu", "at least 0"},
        {with("/bodies/0/mass_per", "surface"), ErrorCode::out_of_range, "#/bodies/0/mass_per", "area"},
        {with("/bodies/0/torque", {0, 1}), ErrorCode::wrong_type, "#/bodies/0/torque", "three"},
        {of_kinematic("torque", {0, 0, 1}), ErrorCode::inconsistent, "#/bodies/0/torque", "dynamic"},
        {with("/bodies/0/group", -1), ErrorCode::out_of_range, "#/bodies/0/group", "at least 0"},
        {with("/bodies/0/script", json::array()), ErrorCode::inconsistent, "#/bodies/0/script", "kinematic"},
        {of_kinematic("script", {{{"position", {0, 0, 1}}}}), ErrorCode::missing_key, "#/bodies/0/script/0", "`time`"},
        {of_kinematic("script", {{{"time", 0}}}), ErrorCode::out_of_range, "#/bodies/0/script/0/time", "after 0"},
        {of_kinematic("script", {{{"time", 1}}, {{"time", 1}}}), ErrorCode::out_of_range, "#/bodies/0/script/1/time", "not after"},
        {of_kinematic("script", {{{"time", 1}, {"tme", 1}}}), ErrorCode::unknown_key, "#/bodies/0/script/0/tme", "did you mean `time`?"},
        {of_kinematic("script", {{{"time", 1}, {"rotation", {0, 180, 0}}}}), ErrorCode::out_of_range, "#/bodies/0/script/0", "half a turn"},
        {of_kinematic("script", {{{"time", 1}, {"rotation", {0, 1, 0}}, {"rotation_vector", {0, 1, 0}}}}), ErrorCode::inconsistent,
         "#/bodies/0/script/0", "not both"},
        {of_kinematic("script", {3}), ErrorCode::wrong_type, "#/bodies/0/script/0", "an object"},
        {both_sources, ErrorCode::inconsistent, "#/bodies/0", "either"},
        {with("/bodies/0/edges", {{0, 1}}), ErrorCode::inconsistent, "#/bodies/0/edges", "`vertices`"},
        {inline_body("mesh_unit", "mm"), ErrorCode::inconsistent, "#/bodies/0/mesh_unit", "file"},
        {inline_body("vertices", json::array()), ErrorCode::out_of_range, "#/bodies/0/vertices", "a vertex"},
        {inline_body("edges", {{0, 3}}), ErrorCode::out_of_range, "#/bodies/0/edges/0/1", "at most 2"},
        {inline_body("edges", {{0, 1}, {1, 2}}), ErrorCode::out_of_range, "#/bodies/0/edges/1", "two different places"},
        {inline_body("triangles", {{0, 1}}), ErrorCode::wrong_type, "#/bodies/0/triangles/0", "3 vertex indices"},
        {inline_body("triangles", {{0, -1, 1}}), ErrorCode::out_of_range, "#/bodies/0/triangles/0/1", "at least 0"},
        {with("/bodies/0/split_components", "yes"), ErrorCode::wrong_type, "#/bodies/0/split_components", "true or false"},
        {with("/bodies/0/mesh", "missing.stl"), ErrorCode::file_not_found, "#/bodies/0/mesh", "missing.stl"},
        {with("/bodies/0/densty", 3), ErrorCode::unknown_key, "#/bodies/0/densty", "did you mean `density`?"},
        {with("/timestp", 3), ErrorCode::unknown_key, "#/timestp", "did you mean `timestep`?"},
        {with("/contact", {{"dhatt", 1}}), ErrorCode::unknown_key, "#/contact/dhatt", "`dhat`"},
        {with("/bodies/0/density", -1240), ErrorCode::out_of_range, "#/bodies/0/density", "greater than 0"},
        {with("/bodies/0/density", "NaN"), ErrorCode::not_finite, "#/bodies/0/density", "not finite"},
        {with("/bodies/0/density", "heavy"), ErrorCode::wrong_type, "#/bodies/0/density", "a number is wanted"},
        {with("/bodies/0/position", {0, 1}), ErrorCode::wrong_type, "#/bodies/0/position", "three"},
        {with("/bodies/0/position", {0, 1, "3 miles"}), ErrorCode::out_of_range, "#/bodies/0/position/2", "miles"},
        {with("/bodies/0/scale", 0), ErrorCode::out_of_range, "#/bodies/0/scale", "greater than 0"},
        {with("/bodies/0/scale", {1, -1, 1}), ErrorCode::out_of_range, "#/bodies/0/scale", "greater than 0"},
        {with("/bodies/0/type", "dynamik"), ErrorCode::out_of_range, "#/bodies/0/type", "did you mean `dynamic`?"},
        {with("/bodies/0/fixed", {"pw"}), ErrorCode::out_of_range, "#/bodies/0/fixed/0", "px"},
        {with("/bodies/0/name", "a:b"), ErrorCode::out_of_range, "#/bodies/0/name", "a:b"},
        {with("/bodies/0/mesh_unit", "furlong"), ErrorCode::out_of_range, "#/bodies/0/mesh_unit", "mm"},
        {with("/bodies/0/prescribed", {{"rz", {{"times", {0, 1}}, {"values", {0}}}}}), ErrorCode::inconsistent, "#/bodies/0/prescribed/rz",
         "one value"},
        {with("/bodies/0/prescribed", {{"rz", {{"times", {0, 1, 1}}, {"values", {0, 1, 2}}}}}), ErrorCode::out_of_range,
         "#/bodies/0/prescribed/rz/times/2", "increase"},
        {with("/bodies/0/prescribed", {{"rz", {{"times", {0}}, {"values", {5}}}}}), ErrorCode::inconsistent,
         "#/bodies/0/prescribed/rz/values", "must be 0"},
        {with("/bodies/0/prescribed", {{"rw", json::object()}}), ErrorCode::unknown_key, "#/bodies/0/prescribed/rw", "did you mean `rx`?"},
        {with("/bodies/0/shape", {{"generator", "pin"}}), ErrorCode::inconsistent, "#/bodies/0", "either"},
        {with("/units", "inch"), ErrorCode::out_of_range, "#/units", "in"},
        {with("/fettle_scene", 2), ErrorCode::out_of_range, "#/fettle_scene", "1"},
        {with("/timestep", 0), ErrorCode::out_of_range, "#/timestep", "greater than 0"},
        {with("/contact", {{"dmin", "-1mm"}}), ErrorCode::out_of_range, "#/contact/dmin", "at least 0"},
        {with("/bodies/0/group", 1.5), ErrorCode::wrong_type, "#/bodies/0/group", "whole"},
        {twice, ErrorCode::inconsistent, "#/bodies/1/name", "box"},
        {no_units, ErrorCode::missing_key, "", "`units`"},
        {no_density, ErrorCode::missing_key, "#/bodies/0", "`density`"},
        {no_name, ErrorCode::missing_key, "#/bodies/0", "`name`"},
        {no_geometry, ErrorCode::missing_key, "#/bodies/0", "`mesh`"},
        {none, ErrorCode::out_of_range, "#/bodies", "a body"},
        {static_force, ErrorCode::inconsistent, "#/bodies/0/force", "dynamic"},
        {both, ErrorCode::inconsistent, "#/bodies/0/prescribed/rz", "fixed"},
        {two_rotations, ErrorCode::inconsistent, "#/bodies/0", "rotation_vector"},
        {json::array(), ErrorCode::missing_key, "", "fettle_scene"},
        {json{{"fettle_design", 1}}, ErrorCode::inconsistent, "", "design"},
    };
    for (const Wrong& wrong : cases) {
        CAPTURE(wrong.scene.dump());
        const auto result = shop.read(wrong.scene);
        REQUIRE(result.errors().size() == 1);
        const auto& error = result.errors()[0];
        CAPTURE(error.where, error.message);
        CHECK(static_cast<int>(error.code) == static_cast<int>(wrong.code));
        CHECK(contains(error.where, "a.scene.json" + wrong.where));
        CHECK(contains(error.message, wrong.message));
    }
}

TEST_CASE("All faults of a scene are told at once", "[scene]") {
    const Workshop shop;
    json scene = with("/bodies/0/density", -1);
    scene["bodies"][0]["mesh"] = "missing.obj";
    scene["gravty"] = 1;
    CHECK(shop.read(scene).errors().size() == 3);
}

TEST_CASE("A mesh that cannot be read is the body's fault", "[scene]") {
    const Workshop shop;
    shop.write("scenes/near.obj", "v 0 0 nan\n");
    const auto errors = shop.read(plain()).errors();
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == ErrorCode::not_finite);
    CHECK(contains(errors[0].where, "#/bodies/0/mesh"));
    CHECK(contains(errors[0].message, "near.obj"));
}

TEST_CASE("Shapes are made by whoever has generators", "[scene]") {
    const Workshop shop;
    json text = plain();
    text["bodies"][0].erase("mesh");
    text["bodies"][0]["shape"] =
        json::parse(R"({"generator": "pin", "dimensions": {"radius": 2.5, "length": "1cm"}, "counts": {"facets": 32}})");
    SECTION("none here") {
        const auto errors = shop.read(text).errors();
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].code == ErrorCode::unsupported);
        CHECK(contains(errors[0].where, "#/bodies/0/shape"));
    }
    SECTION("given") {
        ReadOptions options;
        options.shape_generator = [](const ShapeSpec& spec) -> base::Result<geometry::Mesh> {
            CHECK(spec.generator == "pin");
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
    SECTION("that fails") {
        ReadOptions options;
        options.shape_generator = [](const ShapeSpec&) -> base::Result<geometry::Mesh> {
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
        std::string list = error.message.substr(error.message.find("known: ") + 7);
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
    const json schema = json::parse(std::ifstream(FETTLE_SOURCE_DIR "/core/scene/scene.schema.json"));
    json scene = with("/contact", json::object());
    scene["friction"] = {{"pairs", {json::object()}}};
    scene["materials"] = {{"PLA", json::object()}};
    scene["bodies"][0]["type"] = "kinematic";
    scene["bodies"][0]["script"] = {json::object()};
    scene["bodies"][0]["prescribed"] = {{"rz", json::object()}};
    json shaped = with("/bodies/0/shape", {{"generator", "x"}});
    shaped["bodies"][0].erase("mesh");
    const std::vector<std::tuple<std::string, json, json>> objects{
        {"", scene, schema["properties"]},
        {"/contact", scene, schema["properties"]["contact"]["properties"]},
        {"/friction", scene, schema["properties"]["friction"]["properties"]},
        {"/friction/pairs/0", scene, schema["$defs"]["friction_pair"]["properties"]},
        {"/materials/PLA", scene, schema["$defs"]["material"]["properties"]},
        {"/bodies/0/script/0", scene, schema["$defs"]["scripted_pose"]["properties"]},
        {"/bodies/0", scene, schema["$defs"]["body"]["properties"]},
        {"/bodies/0/prescribed", scene, schema["$defs"]["body"]["properties"]["prescribed"]["properties"]},
        {"/bodies/0/prescribed/rz", scene, schema["$defs"]["motion"]["properties"]},
        {"/bodies/0/shape", shaped, schema["$defs"]["shape"]["properties"]},
    };
    for (const auto& [pointer, document, properties] : objects) {
        CAPTURE(pointer);
        std::vector<std::string> documented;
        for (const auto& [key, value] : properties.items()) documented.push_back(key);
        std::sort(documented.begin(), documented.end());
        CHECK(documented == accepted_keys(shop, document, pointer));
    }
}

}  // namespace
}  // namespace fettle::core::scene
