// SPDX-License-Identifier: MIT
// URDF in and out: kinematics by hand, what is refused, and a way there and back.
#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/files/atomic_file.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/urdf/urdf_parser.hpp"
#include "design/urdf/urdf_scene.hpp"
#include "design/urdf/urdf_writer.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::urdf::urdf_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::contains;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;
using nlohmann::json;

/// A base, an arm that turns about y from 30 to 90 degrees, a slider on it with a sphere, a frame without geometry.
const std::string arm = R"(<?xml version="1.0"?>
<robot name="arm"><!-- two joints -->
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base"><visual><geometry><box size="0.2 0.2 0.1"/></geometry></visual></link>
  <link name="upper">
    <inertial><mass value="0.6"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><origin xyz="0 0 0.15" rpy="0 0 0"/><geometry><cylinder radius="0.02" length="0.3"/></geometry></collision>
  </link>
  <link name="hand">
    <inertial><mass value="0.1"/></inertial>
    <collision><geometry><sphere radius="0.03"/></geometry></collision>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><axis xyz="0 1 0"/>
    <limit lower="0.5235987755982988" upper="1.5707963267948966" effort="10" velocity="1"/><dynamics damping="0.2" friction="0.01"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="hand"/>
    <origin xyz="0 0 0.35"/><axis xyz="0 0 1"/><limit lower="-0.01" upper="0.05" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="hand"/><child link="tool"/></joint>
  <transmission name="t"><joint name="shoulder"/><link name="nothing"/></transmission>
</robot>)";

json scene_json(const ImportedScene& scene) { return json::parse(scene.files.front().second); }

struct Mass {
    double mass;
    Vector3 centre;
    Matrix3 inertia;
};

// What moves of a body, along the world's axes: frames differ from scene to scene.
Mass mass_in_world(const core::scene::Scene& scene, std::size_t body) {
    const auto model = core::setup::build_model(scene);
    REQUIRE(model);
    const core::model::Body& of = model->bodies[body];
    const core::scene::Inertial own = core::scene::inertial_of(of.moments);
    const Matrix3& turn = of.pose_start.rotation;
    return {own.mass, core::kinematics::world_position(of.pose_start, own.centre), turn * own.inertia * turn.transpose()};
}

Vector3 vector(const json& list) { return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()}; }

}  // namespace

TEST_CASE("URDF: names that files or ids are made of stay apart, both ways") {
    const TemporaryFolder folder;
    std::string bodies;
    const std::vector<std::string> names{"a/b", "a_b", "A_B", "world", "..", "a_b_2"};
    for (std::size_t i = 0; i < names.size(); ++i)
        bodies += std::string(i ? ", " : "") + R"({"name": ")" + names[i] + R"(", "type": "static", "position": [)" +
                  std::to_string(200 * i) + R"(, 0, 0], "shape": {"part": "box", "dimensions": {"size_x": )" + std::to_string(i + 1) +
                  "}}}";
    const auto scene = core::scene_files::read_scene(
        folder.write("a.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [)" + bodies + "]}"), reading::scene_read_options());
    REQUIRE(scene);
    const auto robot = robot_of_scene(*scene, core::setup::build_model(*scene).value(), {}, "a");
    REQUIRE(robot);
    std::set<std::string> files;
    for (const auto& [name, contents] : robot->files) {
        std::string lower = name;
        for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        CHECK(files.insert(lower).second);
        folder.write(name, contents);
    }
    CHECK(files.size() == names.size() + 1);
    REQUIRE(robot->warnings.size() == 1);
    CHECK(contains(robot->warnings.front(), "body \"world\": its link is called \"world_2\""));
    const auto parsed = parse_urdf(robot->files.front().second, "a.urdf");
    REQUIRE(parsed);
    const auto back = scene_of_robot(*parsed, {{folder.path.string(), {}}, "b", false});
    REQUIRE(back);
    for (const auto& [name, contents] : back->files) folder.write(name, contents);
    const auto again = core::scene_files::read_scene(folder.file("b.scene.json"), reading::scene_read_options());
    REQUIRE(again);
    REQUIRE(again->bodies.size() == names.size());
    std::set<std::string> unique;
    for (std::size_t i = 0; i < names.size(); ++i) {
        CHECK(unique.insert(again->bodies[i].name).second);
        const auto& x = again->bodies[i].mesh.vertices;
        CHECK(x.row(0).maxCoeff() - x.row(0).minCoeff() == Approx(1e-3 * static_cast<double>(i + 1)));
    }
    const std::string link = "<visual><geometry><box size=\"1 1 1\"/></geometry></visual></link>";
    const std::string joint = "<joint name=\"j\" type=\"fixed\"><parent link=\"a:b\"/><child link=\"";
    const std::string two =
        "<robot><link name=\"a:b\">" + link + "<link name=\"a,b\">" + link + "<link name=\"c\">" + link + joint + "a,b\"/></joint>";
    const auto colliding = scene_of_robot(
        parse_urdf(two + joint.substr(0, 13) + "k" + joint.substr(14) + "c\"/></joint></robot>", "x").value(), {{}, "c", true});
    REQUIRE(colliding);
    CHECK(scene_json(*colliding)["bodies"][1]["name"] == "a_b_2");
    CHECK(scene_json(*colliding)["joints"][0]["b"] == "a_b_2");
    const auto joints = parse_urdf(two + joint + "c\"/></joint></robot>", "x");
    REQUIRE_FALSE(joints);
    CHECK(contains(joints.errors().front().message, "two joints are called \"j\""));
}

TEST_CASE("URDF: a chain of any length is followed") {
    std::string text = "<robot><link name=\"0\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link>\n";
    constexpr int links = 50'000;
    for (int i = 1; i < links; ++i) {
        const std::string name = std::to_string(i);
        text += "<link name=\"" + name + "\"/><joint name=\"" + name + "\" type=\"fixed\"><origin xyz=\"0.001 0 0\"/><parent link=\"" +
                std::to_string(i - 1) + "\"/><child link=\"" + name + "\"/></joint>\n";
    }
    text +=
        "<link name=\"end\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link><joint name=\"end\" type=\"fixed\"><parent "
        "link=\"49999\"/><child link=\"end\"/></joint></robot>";
    const auto robot = parse_urdf(text, "chain.urdf");
    REQUIRE(robot);
    const auto scene = scene_of_robot(*robot, {{}, "chain", true});
    REQUIRE(scene);
    CHECK(vector(scene_json(*scene)["bodies"][1]["position"]).x() == Approx(49999));
}

TEST_CASE("URDF: angles about fixed axes, there and back") {
    for (const Vector3& rpy :
         {Vector3(0.3, -0.5, 2), Vector3(-3, 1.5, -2), Vector3(0, 0, 0), Vector3(0.4, M_PI / 2, 0), Vector3(0, -M_PI / 2, 1)}) {
        const Matrix3 rotation = rotation_of_rpy(rpy);
        CHECK((rotation_of_rpy(rpy_of_rotation(rotation)) - rotation).cwiseAbs().maxCoeff() < 1e-8);
    }
    // Roll is about the world's x, first: (0, 1, 0) goes to z, and from there by yaw nowhere.
    CHECK((rotation_of_rpy({M_PI / 2, 0, 0.7}) * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-15);
}

TEST_CASE("URDF: links become bodies where the joints have them, limits count from the start") {
    const auto robot = parse_urdf(arm, "arm.urdf");
    REQUIRE(robot);
    CHECK(robot->links.size() == 4);
    CHECK(robot->joints.size() == 3);
    const auto imported = scene_of_robot(*robot, {});
    REQUIRE(imported);
    REQUIRE(imported->files.size() == 4);
    const json scene = scene_json(*imported);
    REQUIRE(scene["bodies"].size() == 3);
    CHECK(scene["bodies"][0]["type"] == "static");
    // At 30 degrees about the joint's y, which yaw has turned to the world's -x: the arm's z leans to +y by sin 30.
    const Vector3 lean(0, std::sin(M_PI / 6), std::cos(M_PI / 6));
    CHECK((vector(scene["bodies"][1]["position"]) - Vector3(0, 0, 100)).norm() < 1e-9);
    CHECK((vector(scene["bodies"][2]["position"]) - (Vector3(0, 0, 100) + 350 * lean)).norm() < 1e-9);
    const json& shoulder = scene["joints"][0];
    CHECK(shoulder["type"] == "revolute");
    CHECK(shoulder["a"] == "base");
    CHECK((vector(shoulder["axis"]) - Vector3(-1, 0, 0)).norm() < 1e-12);
    CHECK(shoulder["limits"][0].get<double>() == Approx(0).margin(1e-9));
    CHECK(shoulder["limits"][1].get<double>() == Approx(60));
    CHECK(shoulder["damping"] == 0.2);
    CHECK(shoulder["friction"] == 0.01);
    const json& slide = scene["joints"][1];
    CHECK((vector(slide["axis"]) - lean).norm() < 1e-12);
    CHECK(slide["limits"] == json({-10.0, 50.0}));
    CHECK(scene["joints"].size() == 2);  // the tool is a frame of the hand
    ImportOptions floating;
    floating.floating = true;
    CHECK_FALSE(scene_json(*scene_of_robot(*robot, floating))["bodies"][0].contains("type"));
}

TEST_CASE("URDF: the program imports a robot that simulates, with the file's masses, and exports it again") {
    const TemporaryFolder folder;
    const std::string file = folder.write("arm.urdf", arm), to = folder.file("out/arm.scene.json");
    REQUIRE(run("import " + file + " --to " + to).code == 0);
    const Answer valid = run("validate " + to + " --json");
    CAPTURE(valid.out);
    REQUIRE(valid.code == 0);
    CHECK(valid.json()["parts"][1]["mass"].get<double>() == Approx(0.6));
    CHECK(valid.json()["warnings"].empty());
    CHECK(valid.json()["parts"][2]["mass"].get<double>() == Approx(0.1));
    CHECK(run("simulate " + to + " --steps 5 --json").json()["status"] == "ok");

    // And back: the same kinematics, read by the same reader; once more, the same file.
    REQUIRE(run("export " + to + " --to " + folder.file("back/arm.urdf")).code == 0);
    REQUIRE(run("import " + folder.file("back/arm.urdf") + " --to " + folder.file("again/arm.scene.json")).code == 0);
    const auto first = core::scene_files::read_scene(to, reading::scene_read_options()),
               second = core::scene_files::read_scene(folder.file("again/arm.scene.json"), reading::scene_read_options());
    REQUIRE(first);
    REQUIRE(second);
    REQUIRE(second->bodies.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &a = first->bodies[i], &b = second->bodies[i];
        CHECK(a.name == b.name);
        if (i == 0) continue;  // it does not move, and its file has no mass
        const Mass x = mass_in_world(*first, i), y = mass_in_world(*second, i);
        CHECK(x.mass == Approx(y.mass).epsilon(1e-12));
        CHECK((x.centre - y.centre).norm() < 1e-9);
        CHECK((x.inertia - y.inertia).norm() < 1e-9 * x.inertia.norm());
    }
    REQUIRE(second->mechanism.joints.size() == 2);
    CHECK(second->bodies[0].type == core::scene::BodyType::static_body);
    for (const auto& joint : first->mechanism.joints) {
        const auto found = std::find_if(second->mechanism.joints.begin(), second->mechanism.joints.end(),
                                        [&](const auto& j) { return j.name == joint.name; });
        REQUIRE(found != second->mechanism.joints.end());
        CHECK(found->kind == joint.kind);
        REQUIRE(found->forces.limits);
        CHECK((*found->forces.limits)[0] == Approx((*joint.forces.limits)[0]).margin(1e-12));
        CHECK((*found->forces.limits)[1] == Approx((*joint.forces.limits)[1]));
    }
}

TEST_CASE("URDF: what passes through another as assembled is told on the way in, what is ignored on the way out") {
    const TemporaryFolder folder;
    const std::string mass = R"(<inertial><mass value="1"/></inertial>)";
    const auto link = [&](const std::string& name, const std::string& x) {
        return "<link name=\"" + name + "\">" + mass + "<collision><origin xyz=\"" + x +
               " 0 0\"/><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>";
    };
    const auto joint = [](const std::string& child) {
        return "<joint name=\"to_" + child + "\" type=\"continuous\"><parent link=\"base\"/><child link=\"" + child +
               "\"/><axis xyz=\"0 0 1\"/></joint>";
    };
    const auto robot = [&](const std::string& at_b, const std::string& at_c) {
        return folder.write(
            "r.urdf", "<robot name=\"r\">" + link("base", "0") + link("b", at_b) + link("c", at_c) + joint("b") + joint("c") + "</robot>");
    };
    const std::string to = folder.file("r.scene.json");
    const Answer crossing = run("import " + robot("0.09", "0.15") + " --to " + to + " --json");
    REQUIRE(crossing.code == 0);
    REQUIRE(crossing.json()["warnings"].size() == 1);
    const std::string told = crossing.json()["warnings"][0];
    CHECK(contains(told, "2 pairs of bodies pass through each other"));
    const std::size_t at = told.find("\"ignore\": ");
    REQUIRE(at != std::string::npos);
    CHECK(json::parse("{" + told.substr(at) + "}")["ignore"] == json({"base:b", "b:c"}));
    CHECK(run("simulate " + to + " --steps 5").code != 0);

    // With that line it simulates; and the file that leaves says what it cannot say.
    json scene = json::parse(core::files::read_file(to).value());
    scene["ignore"] = {"base:b", "b:c"};
    folder.write("r.scene.json", scene.dump());
    CHECK(run("simulate " + to + " --steps 5 --json").json()["status"] == "ok");
    const Answer exported = run("export " + to + " --to " + folder.file("back/r.urdf") + " --json");
    REQUIRE(exported.code == 0);
    CHECK(contains(exported.json()["warnings"].dump(), R"(left out: pairs of `ignore` \"base:b\", \"b:c\")"));
    CHECK(run("import " + robot("0.2", "0.4") + " --to " + to + " --json").json()["warnings"].empty());
}

TEST_CASE("URDF: inertia in, about its own centre and axes; what is fixed to a link weighs with it") {
    const std::string box = "<collision><geometry><box size=\"0.1 0.2 0.3\"/></geometry></collision>";
    const auto imported = [](const std::string& links) {
        const auto robot = parse_urdf("<robot name=\"r\">" + links + "</robot>", "r.urdf");
        REQUIRE(robot);
        ImportOptions floating;
        floating.floating = true;
        const auto scene = scene_of_robot(*robot, floating);
        REQUIRE(scene);
        return *scene;
    };
    // A quarter turn about z: x and y change places.
    const std::string inertial =
        "<inertial><origin xyz=\"0.01 0.02 0.03\" rpy=\"0 0 1.5707963267948966\"/><mass value=\"2\"/>"
        "<inertia ixx=\"0.03\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.04\"/></inertial>";
    const auto one = imported("<link name=\"a\">" + inertial + box + "</link>");
    CHECK(one.warnings.empty());
    const json body = scene_json(one)["bodies"][0];
    CHECK_FALSE(body.contains("density"));
    CHECK(body["inertial"]["mass"] == 2.0);
    CHECK((vector(body["inertial"]["centre"]) - Vector3(10, 20, 30)).norm() < 1e-12);
    CHECK((vector(body["inertial"]["inertia"][0]) - Vector3(0.02, -0.001, 0)).norm() < 1e-15);
    CHECK((vector(body["inertial"]["inertia"][1]) - Vector3(-0.001, 0.03, 0)).norm() < 1e-15);
    CHECK(vector(body["inertial"]["inertia"][2])[2] == 0.04);

    // Two halves of a rod of 2 kg and 0.4 m, the second a link without geometry: together the rod, m L^2 / 12 about its middle.
    const double half = 1 * 0.04 / 12, thin = 1e-5;
    const auto rod = [&](double x) {
        return "<inertial><origin xyz=\"" + std::to_string(x) + " 0 0\"/><mass value=\"1\"/><inertia ixx=\"" + std::to_string(thin) +
               "\" ixy=\"0\" ixz=\"0\" iyy=\"" + json(half).dump() + "\" iyz=\"0\" izz=\"" + json(half).dump() + "\"/></inertial>";
    };
    const std::string joint = "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0.3 0 0\"/></joint>";
    const auto both = imported("<link name=\"a\">" + rod(0.1) + box + "</link><link name=\"b\">" + rod(0) + "</link>" + joint);
    CHECK(both.warnings.empty());
    const json whole = scene_json(both)["bodies"][0]["inertial"];
    CHECK(whole["mass"] == 2.0);
    CHECK((vector(whole["centre"]) - Vector3(200, 0, 0)).norm() < 1e-9);
    CHECK(vector(whole["inertia"][2])[2] == Approx(2 * 0.16 / 12).epsilon(1e-9));
    CHECK(vector(whole["inertia"][0])[0] == Approx(2 * thin).epsilon(1e-9));

    // An inertia that no body has, and a mass that has nowhere to go, are told.
    const std::string impossible = "<inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"3\"/></inertial>";
    const auto doubted = imported("<link name=\"a\">" + impossible + box + "</link>");
    REQUIRE(doubted.warnings.size() == 1);
    CHECK(contains(doubted.warnings[0], "sum of the other two"));
    CHECK(scene_json(doubted)["bodies"][0]["density"].get<double>() == Approx(2 / 0.006));
    const auto lost = imported("<link name=\"a\">" + box + "</link><link name=\"b\">" + rod(0) + "</link>" + joint);
    REQUIRE(lost.warnings.size() == 2);  // and a has none
    CHECK(contains(lost.warnings[1], "left out"));
}

TEST_CASE("URDF out: inertia about the centre of mass, joints that it has not are refused") {
    const TemporaryFolder folder;
    const auto scene = [&](const std::string& joints) {
        return folder.write("a.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
            {"name": "bar", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 100, "size_y": 20, "size_z": 10}}},
            {"name": "other", "density": 1000, "shape": {"part": "box"}, "position": [200, 0, 0]}], "joints": [)" +
                                                joints + "]}");
    };
    const std::string pivot = R"({"name": "pivot", "type": "revolute", "b": "bar", "point": [-50, 0, 0], "axis": [0, 0, 1]})";
    const auto exported = [&](const std::string& joints) {
        const auto read = core::scene_files::read_scene(scene(joints), reading::scene_read_options());
        REQUIRE(read);
        core::setup::BuildOptions options;
        options.check_start = false;
        return robot_of_scene(*read, core::setup::build_model(*read, options).value(), {}, "a");
    };
    const auto robot = exported(pivot);
    REQUIRE(robot);
    const std::string& text = robot->files.front().second;
    CHECK(contains(text, "<joint name=\"pivot\" type=\"continuous\">"));
    CHECK(contains(text, "<joint name=\"world to other\" type=\"floating\">"));
    const auto read = parse_urdf(text, "a.urdf");
    REQUIRE(read);
    REQUIRE(read->links[1].mass);
    CHECK(*read->links[1].mass == Approx(0.02));
    // A bar of 100 x 20 x 10 mm and 20 g: izz = m (a^2 + b^2) / 12.
    const std::size_t at = text.find("izz=\"") + 5;
    CHECK(std::stod(text.substr(at)) == Approx(0.02 * (0.01 + 0.0004) / 12).epsilon(1e-6));
    CHECK(contains(text, "<origin xyz=\"0.05 0 0\""));  // of the file's frame in the link's, which stands at the pivot

    const auto refused = [&](const std::string& joints) {
        const auto result = exported(joints);
        REQUIRE_FALSE(result);
        return result.errors().front().message;
    };
    CHECK(contains(refused(R"({"name": "knee", "type": "ball", "a": "bar", "b": "other", "point": [60, 0, 0]})"), "knee"));
    CHECK(contains(
        refused(pivot + R"(, {"name": "link", "type": "revolute", "a": "bar", "b": "other", "point": [60, 0, 0], "axis": [0, 0, 1]},
                                        {"name": "loop", "type": "revolute", "b": "other", "point": [200, 0, 0], "axis": [0, 0, 1]})"),
        "closes a loop"));
}

TEST_CASE("URDF in: what is wrong is told") {
    const auto code = [](const std::string& text) {
        const auto robot = parse_urdf(text, "x.urdf");
        if (!robot) return robot.errors().front().code;
        const auto scene = scene_of_robot(*robot, {});
        REQUIRE_FALSE(scene);
        return scene.errors().front().code;
    };
    const std::string box = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";
    const auto two = [&](const std::string& joint) {
        return "<robot name=\"r\"><link name=\"a\">" + box + "</link><link name=\"b\">" + box + "</link>" + joint + "</robot>";
    };
    CHECK(code("<svg/>") == ErrorCode::parse);
    CHECK(code("no xml") == ErrorCode::parse);
    CHECK(code("<robot name=\"r\"><link name=\"a\">" + box) == ErrorCode::parse);
    CHECK(code("<robot name=\"r\"><link/></robot>") == ErrorCode::missing_key);
    CHECK(code("<robot name=\"r\"><link name=\"a\xff\"/></robot>") == ErrorCode::parse);
    CHECK(code("<robot name=\"r\"><link name=\"a&#27;[2J\"/></robot>") == ErrorCode::parse);  // no character of XML, nor the next
    CHECK(code("<robot name=\"r\"><link name=\"a&#xD800;\"/></robot>") == ErrorCode::parse);
    CHECK(code("<robot name=\"r\"><link name=\"a&#10;b\"/></robot>") == ErrorCode::out_of_range);
    CHECK(code(two("<joint name=\"j\" type=\"hinge\"><parent link=\"a\"/><child link=\"b\"/></joint>")) == ErrorCode::unsupported);
    CHECK(code(two("<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/></joint>")) == ErrorCode::missing_key);
    CHECK(code(two("")) == ErrorCode::inconsistent);  // two roots
    CHECK(code(two("<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"
                   "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>")) == ErrorCode::inconsistent);
    CHECK(code("<robot name=\"r\"><link name=\"a\"><collision><geometry><box size=\"1 x 1\"/></geometry></collision></link></robot>") ==
          ErrorCode::parse);
    CHECK(code("<robot name=\"r\"><link name=\"a\"><collision><geometry><box size=\"1 0 1\"/></geometry></collision></link></robot>") ==
          ErrorCode::out_of_range);
    CHECK(code("<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh "
               "filename=\"package://p/none.stl\"/></geometry></collision></link></robot>") == ErrorCode::file_not_found);
    CHECK(code("<robot name=\"r\"><link name=\"a\"/></robot>") == ErrorCode::mesh_invalid);
    const std::string turning = "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>";
    const std::string beyond =
        "<link name=\"c\">" + box + "</link><joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>";
    CHECK(code("<robot name=\"r\"><link name=\"a\">" + box + "</link><link name=\"b\"/>" + turning + "</joint>" + beyond + "</robot>") ==
          ErrorCode::unsupported);
    CHECK(code(two(turning + "<axis xyz=\"0 0 0\"/></joint>")) == ErrorCode::out_of_range);
    CHECK(code("<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"-1\"/></inertial></link></robot>") == ErrorCode::out_of_range);
    CHECK(code("<robot name=\"r\"><link name=\"a\"><visual><geometry><capsule/></geometry></visual></link></robot>") ==
          ErrorCode::unsupported);
    CHECK(code(two(turning + "<mimic joint=\"j\"/></joint>")) == ErrorCode::inconsistent);
    CHECK(code(two(turning + "<mimic joint=\"i\"/></joint>")) == ErrorCode::inconsistent);
}

TEST_CASE("URDF in: what harms nothing is taken") {
    const std::string box = "<geometry><box size=\"1 1 1\"/></geometry>";
    const auto taken = [](const std::string& links) {
        const auto robot = parse_urdf("\n\n<?xml version=\"1.0\"?><robot name=\"r\">" + links + "</robot>", "x.urdf");
        CAPTURE(links);
        REQUIRE(robot);
        const auto scene = scene_of_robot(*robot, {});
        REQUIRE(scene);
        return *scene;
    };
    // A material with its colour within a link, before or behind the geometry; of what is not seen; another geometry that is not needed.
    const std::string red = "<material name=\"red\"><color rgba=\"1 0 0 1\"/></material>";
    for (const std::string& visual : {box + red, red + box}) {
        const auto scene = taken("<link name=\"a\"><visual>" + visual + "</visual></link>");
        CHECK(scene_json(scene)["bodies"][0]["urdf"]["colour"] == json({1.0, 0.0, 0.0, 1.0}));
        CHECK(scene.warnings.empty());
    }
    CHECK(contains(taken("<link name=\"a\"><collision>" + box + red + "</collision></link>").warnings.at(0), "<material> of <collision>"));
    const auto capsule =
        taken("<link name=\"a\"><visual><geometry><capsule/></geometry></visual><collision>" + box + "</collision></link>");
    CHECK(contains(capsule.warnings.at(0), "x.urdf:3: <capsule> of <geometry> is passed over"));
    // Mass 0 of a root that stays, an axis of length 0 where there is none, blanks round numbers, a link that moves and is nothing.
    const auto scene = taken("<link name=\"a\"><inertial><mass value=\" 0 \"/></inertial><collision>" + box + "</collision></link>" +
                             "<link name=\"b\"><collision>" + box + "</collision></link><link name=\"c\"/>" +
                             "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 0\"/></joint>" +
                             "<joint name=\"k\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/></joint>");
    CHECK(scene_json(scene)["bodies"].size() == 2);
    REQUIRE(scene.warnings.size() == 2);
    CHECK(contains(scene.warnings[1], "the links \"c\""));
}

TEST_CASE("URDF: what mimics starts where the other has it, within the limits of both") {
    const std::string box = "<collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>";
    const auto imported = [&](const std::string& of_a, const std::string& of_b, const std::string& type = "revolute") {
        const auto joint = [&](const std::string& name, const std::string& kind, const std::string& child, const std::string& more) {
            return "<joint name=\"" + name + "\" type=\"" + kind + "\"><parent link=\"base\"/><child link=\"" + child +
                   "\"/><axis xyz=\"0 0 1\"/>" + more + "</joint>";
        };
        const auto robot = parse_urdf("<robot name=\"r\"><link name=\"base\">" + box + "<link name=\"a\">" + box + "<link name=\"b\">" +
                                          box + joint("ja", type, "a", of_a) + joint("jb", "revolute", "b", of_b) + "</robot>",
                                      "x.urdf");
        REQUIRE(robot);
        const auto scene = scene_of_robot(*robot, {});
        REQUIRE(scene);
        return *scene;
    };
    const auto start = [](const ImportedScene& scene, std::size_t joint) {
        return scene_json(scene)["joints"][joint].value("/urdf/start"_json_pointer, 0.0) * M_PI / 180;
    };
    const std::string wide = "<limit lower=\"-2\" upper=\"2\" effort=\"7\" velocity=\"3\"/>";
    const auto plain = imported(wide, wide + "<mimic joint=\"ja\" multiplier=\"1.06399\" offset=\"-0.04545\"/>");
    CHECK(start(plain, 0) == 0);
    CHECK(start(plain, 1) == Approx(-0.04545));
    const json gear = scene_json(plain)["joints"][2];
    CHECK(gear["ratio"] == 1.06399);  // from there on: 1.06399 - 0.04545 at 1
    CHECK(vector(scene_json(plain)["bodies"][2]["rotation_vector"]).z() == Approx(-0.04545 * 180 / M_PI));
    const json limits = scene_json(plain)["joints"][1]["limits"];
    CHECK(limits[0].get<double>() == Approx((-2 + 0.04545) * 180 / M_PI));
    // b's own limits hold a back: b = 2 a + 0.3 in [0.5, 1], a = 0.1 at least.
    const auto narrowed = imported(wide, "<limit lower=\"0.5\" upper=\"1\"/><mimic joint=\"ja\" multiplier=\"2\" offset=\"0.3\"/>");
    CHECK(start(narrowed, 0) == Approx(0.1));
    CHECK(start(narrowed, 1) == Approx(0.5));
    CHECK(scene_json(narrowed)["joints"][1]["limits"][0] == 0.0);
    const auto apart = imported("<limit lower=\"0\" upper=\"1\"/>", "<limit lower=\"5\" upper=\"6\"/><mimic joint=\"ja\"/>");
    REQUIRE_FALSE(apart.warnings.empty());
    CHECK(contains(apart.warnings[0], "no position of it has it and all that mimic it within their limits"));
    // One joint turns with one that slides, and one does not move at all.
    const auto rack = imported(wide, wide + "<mimic joint=\"ja\" multiplier=\"20\"/>", "prismatic");
    CHECK(scene_json(rack)["joints"][2]["of"] == json({"jb", "ja"}));
    CHECK(scene_json(rack)["joints"][2]["radius"].get<double>() == Approx(50));
    const auto held = imported(wide, wide + "<mimic joint=\"ja\" multiplier=\"0\" offset=\"0.7\"/>");
    CHECK(scene_json(held)["joints"].size() == 2);
    CHECK(scene_json(held)["joints"][1]["type"] == "fixed");
    CHECK(vector(scene_json(held)["bodies"][2]["rotation_vector"]).z() == Approx(0.7 * 180 / M_PI));
}

}  // namespace fettle::design::urdf::urdf_test
