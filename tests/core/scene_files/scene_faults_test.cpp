// SPDX-License-Identifier: MIT
// What the reader of scenes refuses: each fault with its message and its place, all of them at once.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/core/scene_files/scene_workshop.hpp"

namespace fettle::core::scene_files::scene_faults_test {

namespace {

using base::ErrorCode;
using namespace test_support;

struct Wrong {
    json scene;
    ErrorCode code;
    std::string where, message;
};

TEST_CASE("Numbers beyond any mechanism are refused in both formats", "[scene]") {
    const Workshop shop;
    const auto code = [&](const json& scene) {
        const auto result = shop.read(scene);
        REQUIRE(result.errors().size() == 1);
        CHECK(contains(result.errors()[0].message, "at most 1e30"));
        return result.errors()[0].where;
    };
    CHECK(contains(code(with("/bodies/0/position", {1e158, 0, 0})), "#/bodies/0/position/0"));
    CHECK(contains(code(with("/bodies/0/prescribed", {{"rz", {{"rate", 1e150}}}})), "#/bodies/0/prescribed/rz/rate"));
    CHECK(contains(code(with("/bodies/0/rotation", {0, 0, 1e160})), "#/bodies/0/rotation/2"));
    const json fixture = {{"rigid_body_problem", {{"rigid_bodies", {{{"mesh", "near.obj"}, {"position", {0, 1e158, 0}}}}}}}};
    CHECK(contains(code(fixture), "#/rigid_body_problem/rigid_bodies/0/position/1"));
}

TEST_CASE("Meshes from elsewhere are mended with a warning, or refused when strict", "[scene]") {
    const Workshop shop;
    const auto first = tests::support::box_mesh({0, 0, 0}, {1, 2, 3}).triangles[0];
    shop.write("scenes/copied.obj",
               "f " + std::to_string(first[1] + 1) + " " + std::to_string(first[2] + 1) + " " + std::to_string(first[0] + 1) + "\n");
    const json scene = with("/bodies/0/mesh", "copied.obj");
    const auto read = shop.read(scene);
    REQUIRE(read);
    REQUIRE(read->warnings.size() == 1);
    CHECK(contains(read->warnings[0], "left out"));
    scene::ReadOptions strict;
    strict.strict_meshes = true;
    const auto untouched = shop.read(scene, strict);
    REQUIRE(untouched);
    CHECK(untouched->warnings.empty());
    CHECK(untouched->bodies[0].mesh_policy == scene::MeshPolicy::strict);
    CHECK(untouched->bodies[0].mesh.triangles.size() > read->bodies[0].mesh.triangles.size());
}

TEST_CASE("Each copy of a mesh is mended, scaled and told for itself", "[scene]") {
    const Workshop shop;
    const auto first = tests::support::box_mesh({0, 0, 0}, {1, 2, 3}).triangles[0];
    shop.write("scenes/copied.obj",
               "f " + std::to_string(first[1] + 1) + " " + std::to_string(first[2] + 1) + " " + std::to_string(first[0] + 1) + "\n");
    json scene = plain();
    const auto add = [&](const char* name, const char* mesh, const char* unit, const json& scale) {
        json body = scene["bodies"][0];
        body["name"] = name;
        body["mesh"] = mesh;
        body["mesh_unit"] = unit;
        body["scale"] = scale;
        scene["bodies"].push_back(body);
    };
    add("a", "copied.obj", "mm", 1);
    add("b", "copied.obj", "mm", {1, 2, 1});
    add("c", "copied.obj", "cm", 1);
    add("d", "near.obj", "cm", 1);
    add("e", "near.obj", "mm", 1);
    const auto read = shop.read(scene);
    REQUIRE(read);
    REQUIRE(read->warnings.size() == 3);
    for (const char* name : {"`a`", "`b`", "`c`"})
        CHECK(std::count_if(read->warnings.begin(), read->warnings.end(), [&](const std::string& w) { return contains(w, name); }) == 1);
    const auto size = [&](std::size_t body) { return Vector3(read->bodies[body].mesh.vertices.rowwise().maxCoeff() * 1000); };
    CHECK(size(1).isApprox(Vector3(1, 2, 3)));
    CHECK(size(2).isApprox(Vector3(1, 4, 3)));
    CHECK(size(3).isApprox(Vector3(10, 20, 30)));
    CHECK(size(4).isApprox(Vector3(10, 20, 30)));
    CHECK(geometry::have_same_shape(read->bodies[0].mesh, read->bodies[5].mesh));
    for (const scene::Body& body : read->bodies) CHECK(body.mesh.triangles.size() == 12);
}

TEST_CASE("A static body without a density has none", "[scene]") {
    const Workshop shop;
    json scene = with("/bodies/0/type", "static");
    CHECK(shop.read(scene)->bodies[0].density_given);
    scene["bodies"][0].erase("density");
    CHECK_FALSE(shop.read(scene)->bodies[0].density_given);
}

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
        {with("/contact", {{"damping_time", -1}}), ErrorCode::out_of_range, "#/contact/damping_time", "0"},
        {with("/contact", {{"damping_time", "5ms"}}), ErrorCode::wrong_type, "#/contact/damping_time", "number"},
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
        {of_kinematic("damping", 1), ErrorCode::inconsistent, "#/bodies/0/damping", "dynamic"},
        {with("/bodies/0/damping", -1), ErrorCode::out_of_range, "#/bodies/0/damping", "0"},
        {with("/bodies/0/damping", {{"spin", 1}}), ErrorCode::unknown_key, "#/bodies/0/damping/spin", "angular"},
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
        {with("/bodies/0/density", "heavy"), ErrorCode::parse, "#/bodies/0/density", "is not a density"},
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
        {with("/bodies/0/shape", {{"part", "pin"}}), ErrorCode::inconsistent, "#/bodies/0", "either"},
        {with("/units", "inch"), ErrorCode::out_of_range, "#/units", "in"},
        {with("/fettle_scene", 2), ErrorCode::out_of_range, "#/fettle_scene", "1"},
        {with("/timestep", 0), ErrorCode::out_of_range, "#/timestep", "at least 1e-12"},
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
        {json{{"fettle_design", 1}}, ErrorCode::missing_key, "", "it is a design"},
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

}  // namespace

}  // namespace fettle::core::scene_files::scene_faults_test
