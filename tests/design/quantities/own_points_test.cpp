// SPDX-License-Identifier: MIT
// Every number that a quantity of a design file has: it follows from parameters and from deviations, with its exact derivative, or it is
// refused where one of them reaches it. From the table of quantities, so that a new key wants a line here.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>

#include "design/reading/quantity_reader.hpp"
#include "tests/design/quantities/file_problem.hpp"

namespace fettle::design::quantities::own_points_test {

namespace {

// An arm that a motor turns, and a box that lies on a floor.
const char* const scene = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.05, "gravity": [0, 0, -9.81],
    "variables": {"L": "12 mm", "T": "0.03 s", "N": 0.5, "far": "0.4"},
    "bodies": [
      {"name": "arm", "density": 1000, "position": [0, 0, 50], "shape": {"part": "box", "dimensions": {"size_x": 40, "size_y": 5, "size_z": 4}}},
      {"name": "floor", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 60, "size_z": 10}}, "position": [0, 0, -5]},
      {"name": "box", "density": 1000, "position": [3, 2, 10.01], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 20, "size_z": 20}}}],
    "joints": [{"name": "hinge", "type": "revolute", "b": "arm", "point": [0, 0, 50], "axis": [0, 0, 1]}],
    "motors": [{"name": "drive", "joint": "hinge", "speed": 900}]})json";

struct Number {
    std::string type, key;
    std::string rest;     // the quantity's other keys
    std::string value;    // of the key, which has a formula
    std::string follows;  // the variable, of which the value is a formula
    bool is_followed = false;
};

const std::string arm = R"("body": "arm")", tip = R"("body": "arm", "point": [20, 1, 0])", walls = R"("a": "arm", "b": "floor")";

std::vector<Number> numbers() {
    const std::string axis = R"([1, "= N", 0])", time = R"("= T")", point = R"(["= L", "= L / 3", 1])",
                      law = R"("of": "length", "times": [0, 0.1], "values": [1, 2])";
    std::vector<Number> out{
        {"stroke", "axis", arm, axis, "N"},
        {"stroke", "from", arm + R"(, "axis": [1, 0, 0])", time, "T"},
        {"stroke", "to", arm + R"(, "axis": [1, 0, 0])", time, "T"},
        {"stroke", "target", arm + R"(, "axis": [1, 0, 0])", R"("= 2 * L")", "L", true},
        {"marker_path", "point", arm + R"(, "points": [[20, 5, 50], [3, 18, 50]])", point, "L", true},
        {"marker_path", "points", tip + R"(, "times": [0.02, 0.035])", R"([["= L", 3, 50], [3, "= 2 * L", 50]])", "L", true},
        {"marker_path", "times", tip + R"(, "points": [[20, 5, 50]])", R"(["= T"])", "T"},
        {"marker_position", "point", arm + R"(, "axis": [1, 2, 0])", point, "L", true},
        {"marker_position", "origin", tip, point, "L", true},
        {"marker_speed", "point", arm, point, "L", true},
        {"contact_torque", "point", R"("body": "box", "of": "floor", "axis": [1, 2, 0.5])", R"(["= L", "= L / 3", 1])", "L", true},
        {"clearance", "from", walls + R"(, "motion": true)", time, "T"},
        {"clearance", "to", walls + R"(, "motion": true)", time, "T"},
        {"free_range", "clearance", R"("joint": "hinge", "end": "above")", R"("= L")", "L"},
        {"free_range", "reach", R"("joint": "hinge", "end": "above")", R"("= L")", "L"},
        {"law", "times", R"("of": "length", "values": [1, 2])", R"([0, "= T"])", "T"},
        {"law", "positions", R"("of": "length", "along": "angle", "values": [1, 2])", R"([0, "= far * 1 rad"])", "far"},
        {"law", "values", R"("of": "length", "times": [0, 0.1])", R"([1, "= L"])", "L", true},
        {"event_time", "threshold", R"("of": "angle")", R"("= L / 1 mm * 1 deg")", "L", true},
        {"event_time", "from", R"("of": "angle", "threshold": 20)", time, "T"},
        {"event_time", "to", R"("of": "angle", "threshold": 20)", time, "T"},
        {"time_share", "above", R"("of": "angle")", R"("= L / 1 mm * 1 deg")", "L", true},
        {"time_share", "below", R"("of": "angle")", R"("= L / 1 mm * 1 deg")", "L", true},
        {"time_share", "from", R"("of": "angle", "above": 20)", time, "T"},
        {"time_share", "to", R"("of": "angle", "above": 20)", time, "T"}};
    const std::map<std::string, std::string> steps{{"marker_position", tip},
                                                   {"marker_speed", tip},
                                                   {"joint_force", R"("joint": "hinge")"},
                                                   {"joint_torque", R"("joint": "hinge")"},
                                                   {"joint_position", R"("joint": "hinge")"},
                                                   {"turn", arm},
                                                   {"motor_effort", R"("motor": "drive")"},
                                                   {"contact_force", R"("body": "box")"},
                                                   {"contact_torque", R"("body": "box", "point": [0, 0, 0])"},
                                                   {"energy", R"("of": "kinetic")"},
                                                   {"gap", walls},
                                                   {"law", law}};
    for (const auto& [type, rest] : steps) {
        const std::string turned = type == "turn" ? R"(, "axis": [0, 0, 1])" : "";
        out.push_back({type, "from", rest + turned, time, "T"});
        out.push_back({type, "to", rest + turned, time, "T"});
        out.push_back({type, "at", rest + turned, time, "T"});
        const bool has_axis = type != "joint_position" && type != "motor_effort" && type != "energy" && type != "law" && type != "gap";
        if (has_axis) out.push_back({type, "axis", rest, axis, "N"});
    }
    return out;
}

// Words, choices and names; of an expression its formula follows, and its windows are those of the others.
bool is_no_number(const std::string& type, const std::string& key) {
    static const std::set<std::string> words{"body",       "a",     "b",        "faces_a",   "faces_b",    "motion", "ranges",
                                             "bodies",     "joint", "motor",    "over",      "derivative", "along",  "profile",
                                             "expression", "end",   "anywhere", "direction", "occurrence", "time"};
    const bool is_name = key == "of" && type != "energy";
    return words.count(key) > 0 || is_name || (type == "energy" && key == "of") || type == "expression";
}

// @param as_parameter  the variable is a parameter; else it has a tolerance
std::string design_of(const Number& number, bool as_parameter) {
    const std::string free = as_parameter ? R"({"name": ")" + number.follows + R"(", "lower": )" + (number.follows == "L" ? "10" : "0.01") +
                                                R"(, "upper": )" + (number.follows == "L" ? "14" : "0.9") + "}"
                                          : R"({"name": "far", "lower": 0.1, "upper": 1})";
    const std::string tolerance = number.follows == "L" ? R"("+-0.1 mm")" : number.follows == "T" ? R"("+-0.001 s")" : R"("+-0.01")";
    const bool is_target = number.key == "target";
    const std::string quantity = R"("type": ")" + number.type + R"(", )" + number.rest + R"(, ")" + number.key + R"(": )" + number.value;
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "parameters": [)" + free + R"(],
        "quantities": {"angle": {"type": "joint_position", "joint": "hinge"})" +
           (is_target ? "" : R"(, "q": {)" + quantity + "}") + R"(},
        "objective": [)" +
           (as_parameter ? R"({"type": "mass", "bodies": ["arm"]})" : R"({"type": "expression", "expression": "far"})") +
           (is_target ? ", {" + quantity + "}" : "") + R"(],
        "constraints": [)" +
           (is_target ? "" : R"({"type": "expression", "expression": "2 * q", "upper": 1e9})") + "]" +
           (as_parameter ? "" : R"(, "tolerances": {")" + number.follows + R"(": )" + tolerance + "}") + "}";
}

Result<reading::DesignFile> read(const Number& number, bool as_parameter) {
    const tests::support::TemporaryFolder folder;
    folder.write("small.scene.json", scene);
    reading::DesignReadOptions options;
    options.as_made = !as_parameter;
    return reading::parse_design(design_of(number, as_parameter), folder.file("small.design.json"), options);
}

bool has_message(const Errors& errors, const std::string& text) {
    return std::any_of(errors.begin(), errors.end(), [&](const Error& error) { return error.message.find(text) != std::string::npos; });
}

// The derivative in the parameter, or deviation, against central differences of whole simulations.
void check_derivative(const Number& number, description::Design design) {
    const auto problem = problem::DesignProblem::create(std::move(design));
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    const bool is_target = number.key == "target";
    const auto value = [&](const VectorX& p) {
        const auto at = problem->evaluate(p, {false, {}, {}});
        INFO(at.reason);
        REQUIRE(at.usable);
        return is_target ? at.terms.back().value : at.constraints.front().value;
    };
    VectorX p = description::values_of(problem->design().parameters);
    const auto& names = description::names_of(problem->design().parameters);
    const auto is_wanted = [&](const std::string& name) { return name == number.follows || name == "deviation of " + number.follows; };
    const auto k = std::find_if(names.begin(), names.end(), is_wanted) - names.begin();
    REQUIRE(k < p.size());
    const auto at = problem->evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    constexpr double h = 1e-6;
    VectorX above = p, below = p;
    above[k] += h;
    below[k] -= h;
    const double difference = (value(above) - value(below)) / (2 * h);
    if (is_target) {
        CHECK(at.gradient[k] != 0);  // tests of the stroke have its derivative
        return;
    }
    CHECK(std::abs(difference) > 1e-6);
    CHECK(at.jacobian(0, k) == Approx(difference).epsilon(1e-5));
}

}  // namespace

TEST_CASE("Every number of a quantity follows from parameters and deviations, or is refused by both") {
    std::set<std::pair<std::string, std::string>> known;
    for (const Number& number : numbers()) {
        known.insert({number.type, number.key});
        for (const bool as_parameter : {true, false}) {
            INFO(number.type << ", " << number.key << (as_parameter ? ", parameter" : ", deviation"));
            const auto file = read(number, as_parameter);
            if (!number.is_followed) {
                CHECK_FALSE(file);
                for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
                CHECK((has_message(file.errors(), "cannot follow") || has_message(file.errors(), "a number is expected")));
                continue;
            }
            for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
            REQUIRE(file);
            check_derivative(number, file->design);
        }
    }
    for (const reading::QuantityType& type : reading::quantity_table())
        for (const std::string_view key : type.keys) {
            INFO(type.name << ", " << key << " is a number that this test does not know");
            const bool is_known = known.count({std::string(type.name), std::string(key)}) > 0;
            CHECK((is_known || is_no_number(std::string(type.name), std::string(key))));
        }
}

// The tip of an arm that turns to 90 degrees is as high as the arm is long, of which half is the point's and half the body's.
TEST_CASE("A point that a tolerance moves follows, against the closed form") {
    const std::string design = R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "w", "lower": 2, "upper": 8}],
        "constraints": [{"type": "marker_position", "body": "arm", "point": ["= b / 2", 0, 0], "axis": [0, 1, 0], "over": "end", "upper": "45.2 mm"}],
        "tolerances": {"b": "+-0.5 mm"}})json";
    const tests::support::TemporaryFolder folder;
    folder.write("small.scene.json",
                 R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.1, "variables": {"b": "45 mm", "w": "4 mm"},
        "bodies": [{"name": "arm", "density": 1000, "position": ["= b / 2", 0, 0], "shape": {"part": "box", "dimensions": {"size_x": "= b", "size_y": "= w", "size_z": 4}}}],
        "joints": [{"name": "hinge", "type": "revolute", "b": "arm", "point": [0, 0, 0], "axis": [0, 0, 1]}],
        "motors": [{"name": "drive", "joint": "hinge", "speed": 900}]})json");
    reading::DesignReadOptions options;
    options.as_made = true;
    auto file = reading::parse_design(design, folder.file("small.design.json"), options);
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    for (const double deviation : {0.0, 0.5e-3, -0.5e-3}) {
        const VectorX p = description::with_deviations(problem->design(), file->tolerances, VectorX::Constant(1, deviation));
        const auto at = problem->evaluate(p);
        REQUIRE(at.usable);
        CHECK(at.constraints[0].value == Approx(45e-3 + deviation).epsilon(1e-7));
        CHECK(at.jacobian(0, file->tolerances[0].parameter) == Approx(1).epsilon(1e-6));
    }
}

}  // namespace fettle::design::quantities::own_points_test
