// SPDX-License-Identifier: MIT
// Every word of the table in and out: what is read changes the robot, the scene that is made of it, and the file that is written of that; a
// scene or file that it does not reach says so. What is passed over is told by its name.
#include "design/urdf/urdf_words.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/urdf/robot_notes_json.hpp"
#include "design/urdf/urdf_parser.hpp"
#include "design/urdf/urdf_scene.hpp"
#include "design/urdf/urdf_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::urdf::urdf_words_test {

namespace {

using fettle::tests::support::contains;
using fettle::tests::support::TemporaryFolder;

/// Two values of an attribute, the first of which stands in the robot.
struct Sample {
    std::string first, second;
};

/// By the last of its path and its name; of robot/link and robot/joint those of the first.
const std::map<std::string, Sample>& samples() {
    static const std::map<std::string, Sample> values{{"robot name", {"r", "s"}},
                                                      {"material name", {"grey", "green"}},
                                                      {"color rgba", {"0.5 0.5 0.5 1", "0.5 0.5 0.5 0.9"}},
                                                      {"link name", {"arm", "leg"}},
                                                      {"origin xyz", {"0.1 0 0", "0.2 0 0"}},
                                                      {"origin rpy", {"0.1 0 0", "0.2 0 0"}},
                                                      {"mass value", {"2", "3"}},
                                                      {"inertia ixx", {"0.01", "0.0101"}},
                                                      {"inertia ixy", {"0", "0.001"}},
                                                      {"inertia ixz", {"0", "0.001"}},
                                                      {"inertia iyy", {"0.011", "0.0111"}},
                                                      {"inertia iyz", {"0", "0.001"}},
                                                      {"inertia izz", {"0.012", "0.0121"}},
                                                      {"box size", {"0.1 0.1 0.1", "0.1 0.1 0.2"}},
                                                      {"cylinder radius", {"0.1", "0.2"}},
                                                      {"cylinder length", {"0.1", "0.2"}},
                                                      {"sphere radius", {"0.1", "0.2"}},
                                                      {"mesh filename", {"one.obj", "two.obj"}},
                                                      {"mesh scale", {"1 1 1", "1 1 2"}},
                                                      {"joint name", {"hinge", "pivot"}},
                                                      {"joint type", {"revolute", "continuous"}},
                                                      {"parent link", {"base", "other"}},
                                                      {"child link", {"arm", "none"}},
                                                      {"axis xyz", {"0 0 1", "0 1 0"}},
                                                      {"dynamics damping", {"0.1", "0.2"}},
                                                      {"dynamics friction", {"0.1", "0.2"}},
                                                      {"limit lower", {"-1", "-0.5"}},
                                                      {"limit upper", {"1", "0.5"}},
                                                      {"limit effort", {"5", "6"}},
                                                      {"limit velocity", {"7", "8"}},
                                                      {"mimic joint", {"hinge", "second"}},
                                                      {"mimic multiplier", {"1.5", "2"}},
                                                      {"mimic offset", {"0.1", "0.2"}}};
    return values;
}

std::string last_of(std::string_view path) { return std::string(path.substr(path.find_last_of('/') + 1)); }

/// A robot with every element that is read, of shapes one kind.
class RobotText {
public:
    std::string shape = "visual", geometry = "box";
    bool inline_colour = false;
    std::map<std::string, std::string> values;                // path and attribute: in place of the first sample
    std::map<std::string, std::string> attributes, children;  // added to the element of a path

    std::string text() const {
        const std::string of_shape = "robot/link/" + shape, material = "robot/link/visual/material";
        const std::string box = "<collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>";
        const auto link = [&](const std::string& name) {
            return "<link name=\"" + name + "\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>" + box;
        };
        const auto joint = [&](const std::string& name, const std::string& parent, const std::string& child) {
            return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + child +
                   "\"/><origin xyz=\"0 1 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/>";
        };
        std::string shapes = tag(of_shape + "/origin") + tag(of_shape + "/geometry", tag(of_shape + "/geometry/" + geometry));
        if (shape == "visual") shapes += tag(material, inline_colour ? tag(material + "/color") : "");
        const std::string inertial =
            tag("robot/link/inertial/origin") + tag("robot/link/inertial/mass") + tag("robot/link/inertial/inertia");
        const std::string of_joint = tag("robot/joint/parent") + tag("robot/joint/child") + tag("robot/joint/origin") +
                                     tag("robot/joint/axis") + tag("robot/joint/dynamics") + tag("robot/joint/limit");
        return tag("robot", tag("robot/material", tag("robot/material/color")) +
                                tag("robot/link", tag("robot/link/inertial", inertial) + tag(of_shape, shapes)) + link("base") +
                                link("other") + link("follower") + tag("robot/joint", of_joint) + joint("second", "base", "other") +
                                "</joint>" + joint("third", "base", "follower") + tag("robot/joint/mimic") + "</joint>");
    }

private:
    std::string tag(const std::string& path, const std::string& inside = "") const {
        const std::string name = last_of(path);
        std::string out = "<" + name;
        const UrdfElement* element = find_urdf_element(path);
        REQUIRE(element != nullptr);
        for (const UrdfAttribute& attribute : element->attributes) {
            if (!attribute.passed_over.empty()) continue;
            const auto given = values.find(path + " " + std::string(attribute.name));
            const auto sample = samples().find(name + " " + std::string(attribute.name));
            INFO(path << " " << attribute.name);
            REQUIRE(sample != samples().end());
            out += " " + std::string(attribute.name) + "=\"" + (given == values.end() ? sample->second.first : given->second) + "\"";
        }
        const auto more = attributes.find(path), child = children.find(path);
        if (more != attributes.end()) out += " " + more->second;
        return out + ">" + (child == children.end() ? "" : child->second) + inside + "</" + name + ">";
    }
};

/// The robot with the element of this path.
RobotText robot_with(const std::string& path) {
    RobotText robot;
    if (path.find("/collision") != std::string::npos) robot.shape = "collision";
    robot.inline_colour = path == "robot/link/visual/material/color";
    if (path.find("/geometry/") != std::string::npos) robot.geometry = last_of(path);
    return robot;
}

/// What becomes of a robot, as text: errors and warnings where there are some.
struct Outcome {
    std::string scene, file;
};

/// Its links may overlap.
core::model::Model model_of(const core::scene::Scene& scene) {
    core::setup::BuildOptions options;
    options.check_start = false;
    const auto model = core::setup::build_model(scene, options);
    REQUIRE(model);
    return *model;
}

Outcome outcome_of(const std::string& text, const TemporaryFolder& folder) {
    const auto told = [](const Errors& errors) { return Outcome{errors.front().message, errors.front().message}; };
    const auto robot = parse_urdf(text, "r.urdf");
    if (!robot) return told(robot.errors());
    const auto imported = scene_of_robot(*robot, {{folder.path.string(), {}}, "r", false});
    if (!imported) return told(imported.errors());
    Outcome out;
    for (const std::string& warning : imported->warnings) out.scene += warning + "\n";
    for (const auto& [name, contents] : imported->files) {
        out.scene += contents;
        folder.write(name, contents);
    }
    const auto scene = core::scene_files::read_scene(folder.file("r.scene.json"), reading::scene_read_options());
    REQUIRE(scene);
    const core::model::Model model = model_of(*scene);
    const auto notes = read_robot_notes(scene->path);
    REQUIRE(notes);
    const auto exported = robot_of_scene(*scene, model, *notes, "r");
    REQUIRE(exported);
    for (const std::string& warning : exported->warnings) out.file += warning + "\n";
    for (const auto& [name, contents] : exported->files) out.file += contents;
    return out;
}

std::string warnings_of(const std::string& text) {
    const auto robot = parse_urdf(text, "r.urdf");
    REQUIRE(robot);
    std::string out;
    for (const std::string& warning : robot->warnings) out += warning + "\n";
    return out;
}

}  // namespace

TEST_CASE("URDF: every attribute that is read changes the scene, and the file that is written of it") {
    const TemporaryFolder folder;
    const std::string tetrahedron = "v 0 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    folder.write("one.obj", "v 0.1 0 0\n" + tetrahedron);
    folder.write("two.obj", "v 0.2 0 0\n" + tetrahedron);
    int tried = 0;
    for (const UrdfElement& element : urdf_elements()) {
        if (!element.passed_over.empty()) continue;
        const std::string path(element.path);
        for (const UrdfAttribute& attribute : element.attributes) {
            if (!attribute.passed_over.empty()) continue;
            const std::string key = path + " " + std::string(attribute.name);
            INFO(key);
            RobotText first = robot_with(path), second = first;
            second.values[key] = samples().at(last_of(path) + " " + std::string(attribute.name)).second;
            const Outcome x = outcome_of(first.text(), folder), y = outcome_of(second.text(), folder);
            CHECK(x.scene != y.scene);
            if (key != "robot name") CHECK(x.file != y.file);  // which is called as its file is
            ++tried;
        }
    }
    CHECK(tried > 40);
}

TEST_CASE("URDF: what is passed over is told by its name, in every element") {
    for (const UrdfElement& element : urdf_elements()) {
        const std::string path(element.path);
        INFO(path);
        if (!element.passed_over.empty()) {
            const std::string parent = path.substr(0, path.find_last_of('/'));
            RobotText robot = robot_with(parent);
            if (path.find("/visual/material") != std::string::npos) robot.inline_colour = true;
            robot.children[parent] = "<" + last_of(path) + " any=\"1\"><joint/><any/></" + last_of(path) + ">";
            CHECK(contains(warnings_of(robot.text()), "<" + last_of(path) + ">"));
            CHECK(contains(warnings_of(robot.text()), std::string(element.passed_over)));
            continue;
        }
        RobotText robot = robot_with(path);
        CHECK(warnings_of(robot.text()).empty());
        for (const UrdfAttribute& attribute : element.attributes) {
            if (attribute.passed_over.empty()) continue;
            robot.attributes[path] = std::string(attribute.name) + "=\"1\"";
            CHECK(contains(warnings_of(robot.text()), "`" + std::string(attribute.name) + "` of <" + last_of(path) + ">"));
        }
        robot.attributes[path] = "unheard=\"1\" xmlns:x=\"y\"";
        robot.children[path] = "<never_heard><mass value=\"x\"/></never_heard>";
        const std::string told = warnings_of(robot.text());
        CHECK(contains(told, "`unheard` of <" + last_of(path) + ">"));
        CHECK(contains(told, "<never_heard>"));
        CHECK_FALSE(contains(told, "xmlns"));
    }
}

TEST_CASE("URDF: there and back the words have the same values") {
    const TemporaryFolder folder;
    RobotText robot;
    robot.children["robot"] =
        "<link name=\"tool\"/><joint name=\"mount\" type=\"fixed\"><parent link=\"arm\"/><child link=\"tool\"/>"
        "<origin xyz=\"0.01 0.02 0.03\" rpy=\"0.3 0.2 0.1\"/></joint>";
    robot.values["robot/joint/limit lower"] = "0.25";  // so that it does not start at 0
    const auto first = parse_urdf(robot.text(), "r.urdf");
    REQUIRE(first);
    const auto scene = scene_of_robot(*first, {{folder.path.string(), {}}, "r", false});
    REQUIRE(scene);
    CHECK(scene->warnings.empty());
    for (const auto& [name, contents] : scene->files) folder.write(name, contents);
    const auto read = core::scene_files::read_scene(folder.file("r.scene.json"), reading::scene_read_options());
    REQUIRE(read);
    const auto exported = robot_of_scene(*read, model_of(*read), read_robot_notes(read->path).value(), "r");
    REQUIRE(exported);
    CHECK(exported->warnings.empty());
    const auto second = parse_urdf(exported->files.front().second, "r.urdf");
    REQUIRE(second);
    CHECK(second->warnings.empty());
    const auto joint = [](const Robot& of, const std::string& name) {
        for (const Joint& each : of.joints)
            if (each.name == name) return each;
        FAIL("no joint is called " << name);
        return Joint{};
    };
    for (const std::string name : {"hinge", "second", "third", "mount"}) {
        INFO(name);
        const Joint x = joint(*first, name), y = joint(*second, name);
        CHECK(x.type == y.type);
        CHECK((x.parent == y.parent && x.child == y.child));
        CHECK(x.lower.value_or(-9) == Approx(y.lower.value_or(-9)));
        CHECK(x.upper.value_or(-9) == Approx(y.upper.value_or(-9)));
        CHECK(x.effort == y.effort);
        CHECK(x.velocity == y.velocity);
        CHECK(x.mimics == y.mimics);
        CHECK(x.multiplier == Approx(y.multiplier));
        CHECK(x.offset == Approx(y.offset).margin(1e-12));
        CHECK((x.origin.position - y.origin.position).norm() < 1e-12);
        CHECK((x.origin.rotation - y.origin.rotation).norm() < 1e-12);
        if (x.has_axis()) CHECK((x.axis - y.axis).norm() < 1e-12);
    }
    for (const Link& link : second->links)
        if (link.name == "arm") CHECK(link.colour == Rgba{0.5, 0.5, 0.5, 1});
}

}  // namespace fettle::design::urdf::urdf_words_test
