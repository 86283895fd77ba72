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
#include <sstream>

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
    const std::vector<Wrong> cases{
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
    scene["bodies"][0]["prescribed"] = {{"rz", json::object()}};
    json shaped = with("/bodies/0/shape", {{"generator", "x"}});
    shaped["bodies"][0].erase("mesh");
    const std::vector<std::tuple<std::string, json, json>> objects{
        {"", scene, schema["properties"]},
        {"/contact", scene, schema["properties"]["contact"]["properties"]},
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
