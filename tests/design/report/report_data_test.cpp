// SPDX-License-Identifier: MIT
// The contents of a report, against what was computed: meshes and poses read back, certified bands against known distances, a page that
// users' names cannot break out of; and the command, from outside.
#include "design/report/report_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>

#include "core/records/trajectory_io.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "design/exports/palette.hpp"
#include "design/reading/design_reader.hpp"
#include "design/report/moving_parts.hpp"
#include "design/report/packed_numbers.hpp"
#include "design/report/pair_rows.hpp"
#include "design/report/report_folder.hpp"
#include "design/report/report_page.hpp"
#include "design/report/search_curves.hpp"
#include "tests/design/report/packed.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::report::report_data_test {

namespace {

using Json = nlohmann::ordered_json;
using fettle::tests::design_support::DesignFolder;
using fettle::tests::report_support::data_of;
using fettle::tests::report_support::unpacked;
using fettle::tests::support::contents;
using fettle::tests::support::run;

core::scene::Body box(const std::string& name, const Vector3& size, const Vector3& at) {
    core::scene::Body body;
    body.name = name;
    body.type = core::scene::BodyType::kinematic_body;
    body.mesh = fettle::tests::support::box_mesh(-0.5 * size, 0.5 * size);
    body.pose.position = at;
    for (auto& dof : body.prescribed) dof = core::scene::MotionCurve{};
    return body;
}

// Two cubes of 10 mm, 5 mm apart, that part at 20 mm/s while the second turns about their axis; a third like the first stands far away.
Motion parting_cubes(int steps, double speed = 0.02) {
    core::scene::Scene scene;
    scene.timestep = 0.01;
    for (const auto& [name, x] : {std::pair{"still", 0.0}, std::pair{"moving", 0.015}, std::pair{"far", 0.2}})
        scene.bodies.push_back(box(name, Vector3::Constant(0.01), Vector3(x, 0, 0)));
    scene.bodies[1].prescribed[0]->rate = speed;
    scene.bodies[1].prescribed[3]->rate = M_PI;
    Motion motion{core::setup::build_model(scene).value(), {}};
    motion.trajectory = core::stepper::follow_scripts(motion.model, steps);
    return motion;
}

const auto go_on = [] { return false; };

}  // namespace

TEST_CASE("report: numbers are packed lowest byte first") {
    CHECK(packed(std::vector<std::uint32_t>{1}).at("u32") == "AQAAAA==");
    CHECK(packed(std::vector<float>{1.0F}).at("f32") == "AACAPw==");
    CHECK(unpacked<double>(packed(std::vector<double>{0.1, -3.0}), "f64") == std::vector<double>{0.1, -3.0});
}

TEST_CASE("report: parts in mm, copies once, still ones with one pose") {
    const Motion motion = parting_cubes(20);
    Json data;
    add_view(data, "after", motion.model, motion.trajectory);
    REQUIRE(data["meshes"].size() == 1);
    const auto vertices = unpacked<float>(data["meshes"][0]["vertices"], "f32");
    CHECK(vertices.size() == 24);
    for (const float x : vertices) CHECK(std::abs(std::abs(x) - 5.0F) < 1e-5F);
    CHECK(unpacked<std::uint32_t>(data["meshes"][0]["triangles"], "u32").size() == 36);
    CHECK(unpacked<std::uint32_t>(data["meshes"][0]["edges"], "u32").empty());
    const Json& view = data["views"][0];
    CHECK(unpacked<float>(view["bodies"][0]["poses"], "f32").size() == 7);
    const auto times = unpacked<double>(view["times"], "f64");
    const auto poses = unpacked<float>(view["bodies"][1]["poses"], "f32");
    REQUIRE(poses.size() == 7 * times.size());
    REQUIRE(times.size() >= 21);
    for (size_t k = 0; k < times.size(); ++k) {
        const float* p = &poses[7 * k];
        CHECK(p[0] == Approx(15 + 20 * times[k]).epsilon(1e-6));
        CHECK(p[3] == Approx(std::sin(M_PI * times[k] / 2)).margin(1e-6));
        CHECK(p[6] == Approx(std::cos(M_PI * times[k] / 2)).margin(1e-6));
    }
    CHECK(times.back() == Approx(0.2));
}

TEST_CASE("report: bands of clearance hold the distance, and the nearest pair comes first") {
    Motion motion = parting_cubes(20);
    for (core::model::Body& body : motion.model.bodies) body.type = core::scene::BodyType::dynamic_body;  // so that they may collide
    const Json rows = nearest_pairs(motion.model, motion.trajectory, 5e-3, go_on);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0]["a"] == "still");
    CHECK(rows[0]["b"] == "moving");
    CHECK(rows[0]["lower"].get<double>() <= 5.0);
    CHECK(rows[0]["upper"].get<double>() >= 5.0 - 1e-9);
    CHECK(rows[0]["upper"].get<double>() - rows[0]["lower"].get<double>() < 0.06);
    CHECK(rows[0]["time"].get<double>() == Approx(0).margin(1e-6));
    const Json curves = margin_curves(rows, motion.model, motion.trajectory, go_on);
    const auto time = unpacked<double>(curves["time"], "f64");
    const auto lower = unpacked<float>(curves["pairs"][0]["lower"], "f32"), upper = unpacked<float>(curves["pairs"][0]["upper"], "f32");
    REQUIRE(lower.size() + 1 == time.size());
    for (size_t k = 0; k < lower.size(); ++k) {
        const double least = 5 + 20 * time[k];  // of the stretch: where it begins
        CHECK(lower[k] <= least);
        CHECK(upper[k] >= least - 1e-9);
        CHECK(upper[k] - lower[k] < 0.3);
    }
    CHECK(curves["pairs"][0]["least"].get<double>() <= rows[0]["lower"].get<double>());
    // Asked to stop, bounds are wider, and hold.
    const Json stopped = nearest_pairs(motion.model, motion.trajectory, 5e-3, [] { return true; });
    for (const Json& row : stopped) CHECK(row["lower"].get<double>() <= 200);
    CHECK(margin_curves(Json::array(), motion.model, motion.trajectory, go_on).is_null());
}

TEST_CASE("report: a long motion, which is searched stretch by stretch, is one motion") {
    Motion motion = parting_cubes(4100, 4e-3);
    for (core::model::Body& body : motion.model.bodies) body.type = core::scene::BodyType::dynamic_body;
    const Json rows = nearest_pairs(motion.model, motion.trajectory, 5e-3, go_on);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0]["b"] == "moving");
    CHECK(rows[0]["lower"].get<double>() <= 5);
    CHECK(rows[0]["upper"].get<double>() == Approx(5).margin(0.06));
    CHECK(rows[0]["time"].get<double>() == Approx(0).margin(0.1));
    CHECK(rows[0]["steps"] == Json({0, 4100}));
    CHECK(rows[1]["a"] == "moving");  // comes within 175 - 41 * 4 = 11 mm, turned by half a turn each second
    CHECK(rows[1]["lower"].get<double>() <= 11);
    CHECK(rows[1]["upper"].get<double>() == Approx(11).margin(0.06));
    CHECK(rows[1]["time"].get<double>() == Approx(41).margin(0.1));
    const Json curves = margin_curves(rows, motion.model, motion.trajectory, go_on);
    const auto time = unpacked<double>(curves["time"], "f64");
    for (const Json& pair : curves["pairs"]) CHECK(unpacked<float>(pair["lower"], "f32").size() + 1 == time.size());
    const auto lower = unpacked<float>(curves["pairs"][1]["lower"], "f32"), upper = unpacked<float>(curves["pairs"][1]["upper"], "f32");
    CHECK(lower.front() > 170);
    CHECK(lower.back() <= 11.05);
    CHECK(upper.back() >= 11);
}

TEST_CASE("report: a band is nowhere below what is proven of the same steps") {
    Motion motion = parting_cubes(20);
    for (core::model::Body& body : motion.model.bodies) body.type = core::scene::BodyType::dynamic_body;
    const Json rows = nearest_pairs(motion.model, motion.trajectory, 5e-3, go_on);
    const auto curve_of = [&](const Json& told) { return margin_curves(told, motion.model, motion.trajectory, go_on)["pairs"][0]; };
    const auto lower_of = [](const Json& curve) { return unpacked<float>(curve["lower"], "f32"); };
    const std::vector<float> alone = lower_of(curve_of(rows));
    Json whole = rows;
    whole[0]["lower"] = 4.9999999;  // of 5 at the start
    const Json raised = curve_of(whole);
    CHECK(raised["least"] == 4.9999999);
    for (const float lower : lower_of(raised)) CHECK(lower >= 4.99999);
    CHECK(lower_of(raised).front() <= 4.9999999);
    // A part of the motion has a row more of the same bodies, 5 + 20 * 0.1 apart when it begins.
    Json part = rows;
    part.push_back(rows[0]);
    part.back()["steps"] = {10, 20};
    part.back()["lower"] = 6.9999999;
    const std::vector<float> late = lower_of(curve_of(part));
    REQUIRE(late.size() == alone.size());
    CHECK(late.front() == alone.front());
    CHECK(late[late.size() / 2] >= 6.99999);
    // What cannot be of this motion changes nothing.
    Json wrong = rows;
    wrong.push_back(rows[0]);
    wrong.back()["lower"] = 100;
    CHECK(lower_of(curve_of(wrong)) == alone);
}

TEST_CASE("report: how a search went, with trials that failed and a line that was cut off") {
    const DesignFolder folder;
    const auto file = reading::read_design(folder.design());
    REQUIRE(file);
    const std::string text =
        "{\"fettle_history\":1}\n"
        "{\"usable\":true,\"model\":\"wide\",\"parameters\":{\"height\":0.008},\"objective\":2,\"violation\":1,\"constraints\":[0.016]}\n"
        "{\"usable\":false,\"parameters\":{\"height\":0.01}}\n{\"usable\":tr";
    const Json curves = search_curves(text, file->design);
    CHECK(curves["objective"] == Json::parse("[2, null]"));
    CHECK(curves["own"] == Json::parse("[false, true]"));
    CHECK(curves["model"][0] == "wide");
    CHECK(curves["parameters"][0][0].get<double>() == Approx(0.25));
    CHECK(curves["parameters"][1][0].is_null());
    CHECK(curves["constraints"][0]["spare"][0].get<double>() == Approx(1));  // mm
    CHECK(curves["constraints"][0]["spare"][1].is_null());
}

TEST_CASE("report: a page that names cannot break out of, and that asks for nothing") {
    const Json data{{"name", "</script><script>alert(1)</script><!--"}, {"bad", "\xff"}};
    const std::string page = page_of(data);
    CHECK(page.find("alert(1)</script>") == std::string::npos);
    CHECK(page.find("<!--", page.find("fettle-report")) == std::string::npos);
    CHECK(data_of(page)["name"] == data["name"]);
    const std::string_view built = page_template();
    CHECK(built.size() < 1'000'000);
    CHECK(built.find("default-src 'none'") != std::string_view::npos);
    CHECK(page.size() > built.size());
}

TEST_CASE("report: simulate and clearance leave one beside their results, and report makes it again") {
    const DesignFolder folder;
    const std::string out = folder.file("sim"), scene = folder.file("small.scene.json");
    const auto simulated = run("simulate " + scene + " --steps 5 --out " + out + " --json");
    REQUIRE(simulated.code == 0);
    CHECK(simulated.json().at("report") == out + "/report.html");
    const Json data = data_of(contents(out + "/report.html"));
    CHECK(data["kind"] == "simulate");
    CHECK(data["status"] == "ok");
    CHECK(data["name"] == "small");
    CHECK(data["steps"] == 5);
    CHECK(data["up"][2] == 1.0);
    CHECK(data["command"].get<std::string>().find("fettle simulate") == 0);
    CHECK(data["least"].get<double>() == Approx(1e3 * simulated.json().at("minimum_distance").get<double>()));
    REQUIRE_FALSE(data["pairs"].empty());
    CHECK(data["pairs"][0]["upper"].get<double>() >= data["least"].get<double>());
    const std::string first = contents(out + "/report.html");
    CHECK(data["files"] == Json({"motion.glb", "trajectory.json", "result.json"}));
    CHECK(run("report " + out).code == 0);
    CHECK(contents(out + "/report.html") == first);  // from the folder alone, to the byte
    CHECK(run("report " + out + " --out " + folder.file("again.html")).code == 0);
    Json elsewhere = data_of(contents(folder.file("again.html")));
    CHECK(elsewhere["files"].empty());  // none is beside it
    elsewhere["files"] = data["files"];
    CHECK(elsewhere == data);

    const std::string fit = folder.file("fit");
    const auto cleared = run("clearance " + scene + " --minimum 1mm --pairs cube:wall --out " + fit + " --json");
    CHECK(cleared.code == 0);
    const Json judged = data_of(contents(fit + "/report.html"));
    CHECK(judged["kind"] == "clearance");
    CHECK(judged["pairs"][0]["minimum"] == 1.0);
    CHECK(judged["margins"].is_null());  // as assembled
    CHECK(Json::parse(contents(fit + "/result.json"))["pairs"][0]["lower"] == Json(cleared.json()["pairs"][0]["lower"]));

    // Nothing of its own motion is taken away but the answer; of another one everything is.
    CHECK(run("clearance " + out + "/trajectory.json --no-report --out " + out).code <= 2);
    CHECK_FALSE(std::filesystem::exists(out + "/report.html"));
    for (const char* name : {"/motion.glb", "/steps.csv", "/trajectory.json"}) CHECK(std::filesystem::exists(out + name));
    CHECK(run("clearance " + scene + " --motion --steps 7 --no-report --out " + out).code <= 2);
    for (const char* name : {"/motion.glb", "/steps.csv"}) CHECK_FALSE(std::filesystem::exists(out + name));

    REQUIRE(run("simulate " + scene + " --steps 2 --no-report --out " + folder.file("bare")).code == 0);
    CHECK_FALSE(std::filesystem::exists(folder.file("bare") + "/report.html"));
    CHECK(run("report " + folder.file("nothing") + " --json").code == 3);
    folder.write("other/result.json", "{\"status\": \"ok\"}");
    CHECK(run("report " + folder.file("other") + " --json").json().at("errors")[0].at("code") == "unsupported");
}

TEST_CASE("report: of a run that went on it has the forces of all steps, and is made again from its tables") {
    const DesignFolder folder;
    const std::string out = folder.file("sim"), scene = folder.file("small.scene.json");
    REQUIRE(run("simulate " + scene + " --steps 34 --no-report --out " + out).code == 0);
    REQUIRE(run("simulate " + scene + " --steps 40 --continue " + out + "/trajectory.json --out " + out).code == 0);
    const std::string page = contents(out + "/report.html");
    const Json series = data_of(page)["scenarios"][0]["series"];
    REQUIRE_FALSE(series.empty());
    CHECK(unpacked<double>(series.back()["time"], "f64").size() == 40);
    REQUIRE(run("report " + out).code == 0);
    CHECK(contents(out + "/report.html") == page);
    REQUIRE(run("simulate " + scene + " --steps 40 --out " + folder.file("whole")).code == 0);
    CHECK(data_of(contents(folder.file("whole/report.html")))["scenarios"][0]["series"] == series);
}

TEST_CASE("report: how deep two parts are in each other, how much they share, and where") {
    const DesignFolder folder;
    folder.write("shared.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "plate", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 40, "size_z": 10}}},
        {"name": "pin", "type": "static", "position": [0, 0, 10],
         "shape": {"part": "box", "dimensions": {"size_x": 12, "size_y": 12, "size_z": 20}}}]})");
    const std::string out = folder.file("shared");
    CHECK(run("clearance " + folder.file("shared.scene.json") + " --out " + out).code == 1);
    const Json data = data_of(contents(out + "/report.html")), pair = data["pairs"][0];
    CHECK(pair["finding"] == "clash");
    CHECK(pair["depth"]["lower"].get<double>() <= 5);  // mm
    CHECK(pair["depth"]["lower"].get<double>() > 4.9);
    CHECK(pair["depth"]["upper"].get<double>() >= 5);
    CHECK(pair["volume"]["lower"].get<double>() <= 12 * 12 * 5);
    CHECK(pair["volume"]["upper"].get<double>() >= 12 * 12 * 5);
    CHECK(pair["volume"]["lower"].get<double>() > 0);
    const Json& point = pair["depth"]["point"];
    REQUIRE(point.size() == 3);
    CHECK(std::max(std::abs(point[0].get<double>()), std::abs(point[1].get<double>())) < 6);
    CHECK(std::abs(point[2].get<double>() - 2.5) < 0.1);  // of a ball of 2.5 mm between the pin's end at 0 and the plate's face at 5
    CHECK(pair["lower"].is_null());                       // a distance of rounding's size is none
    CHECK(pair["upper"].is_null());
    CHECK(pair["touching"].is_null());
}

TEST_CASE("report: over which area two parts touch, and no distance of theirs") {
    const DesignFolder folder;
    folder.write("touch.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "plate", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 40, "size_z": 10}}},
        {"name": "pin", "type": "static", "position": [0, 0, 15],
         "shape": {"part": "box", "dimensions": {"size_x": 12, "size_y": 12, "size_z": 20}}}]})");
    const std::string out = folder.file("touch"), command = "clearance " + folder.file("touch.scene.json") + " --out " + out;
    for (const bool allowed : {false, true}) {
        CHECK(run(command + (allowed ? " --allow-touch plate:pin" : " --minimum 0.3mm")).code == (allowed ? 0 : 1));
        const Json data = data_of(contents(out + "/report.html")), pair = data["pairs"][0];
        CAPTURE(pair.dump());
        CHECK(pair["finding"] == "touching");
        CHECK(pair["lower"].is_null());
        CHECK(pair["upper"].is_null());
        CHECK(pair["touching"]["area"].get<double>() == Approx(144).epsilon(1e-5));  // mm^2
        CHECK(pair["touching"]["at_least"] == false);
        CHECK(pair["touching"]["allowed"] == allowed);
    }
}

TEST_CASE("report: parts have the colours that all pictures give them, what is fixed is pale; the page knows the others") {
    Motion motion = parting_cubes(2);
    motion.model.bodies[0].type = core::scene::BodyType::static_body;
    Json data;
    add_view(data, "after", motion.model, motion.trajectory);
    const auto colour = [&](size_t i) { return data["views"][0]["bodies"][i]["colour"].get<std::string>(); };
    CHECK(colour(1) == exports::css_colour(exports::part_colour(0)));
    CHECK(colour(2) == exports::css_colour(exports::part_colour(1)));
    CHECK(colour(0) == exports::css_colour(exports::part_colours(motion.model)[0]));
    const auto palest = [](const exports::Colour& c) { return *std::min_element(c.begin(), c.end()); };
    for (int i = 0; i < 8; ++i) CHECK(palest(exports::part_colours(motion.model)[0]) > palest(exports::part_colour(i)));
    for (const exports::Colour& c : {exports::ink, exports::nearest, exports::alarm}) {
        CAPTURE(exports::css_colour(c));
        CHECK(page_template().find(exports::css_colour(c)) != std::string_view::npos);
    }
}

TEST_CASE("report: an exploration's has every design's numbers in the design's units, and the parts of the best ones") {
    const DesignFolder folder;
    const auto line = [](double height, const char* more) {
        return "{\"key\": \"k\", \"kind\": \"evaluate\", \"seed\": 0, \"parameters\": {\"height\": " + std::to_string(height) +
               ", \"width\": 0.02, \"place\": 0.003, \"density\": 1000, \"speed\": 0.6981}, " + more + "}\n";
    };
    const std::string head = R"({"fettle_explore": 1, "design": "x", "parameters": ["height", "width", "place", "density", "speed"])";
    const std::string results =
        line(0.008, R"("status": "infeasible", "objective": 2, "violation": 0.5, "constraints": {"mass cube": 0.002})") +
        line(0.010, R"("status": "feasible", "objective": 3, "violation": 0, "constraints": {"mass cube": 0.0025})") + "{}\n" +
        line(0.012, R"("status": "unusable", "reason": "parts intersect")") + "{\"status\": \"feas";
    folder.write("runs/sweep.jsonl", head + ", \"file\": \"../small.design.json\"}\n" + results);
    const auto made = run("report " + folder.file("runs/sweep.jsonl") + " --json");
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    CHECK(made.json().at("report") == folder.file("runs/sweep.report.html"));
    const Json data = data_of(contents(folder.file("runs/sweep.report.html")));
    CHECK(data["kind"] == "explore");
    const auto column = [&](const std::string& name, const std::string& group = "") {
        for (const Json& each : data["columns"])
            if (each["name"] == name && (group.empty() || each["group"] == group)) return each;
        return Json();
    };
    const auto values = [&](const std::string& name, const std::string& group = "") {
        return unpacked<double>(column(name, group)["values"], "f64");
    };
    REQUIRE(values("height").size() == 3);
    CHECK(values("height")[2] == Approx(12));
    CHECK(column("height")["unit"] == "mm");
    CHECK(column("height")["lower"] == Approx(6));
    CHECK(values("speed")[0] == Approx(40).epsilon(1e-3));
    CHECK(column("speed")["unit"] == "deg/s");
    CHECK(values("objective")[1] == 3);
    CHECK(std::isnan(values("objective")[2]));
    CHECK(values("mass cube", "constraint")[1] == Approx(2.5));  // g
    CHECK(column("mass cube", "constraint")["upper"] == Approx(4));
    CHECK(column("mass cube", "constraint")["better"] == 0);  // it has two bounds
    CHECK(column("mass cube", "term")["better"] == -1);
    CHECK(data["columns"].size() == 5 + 2 + 5 + 5);  // the clearance in two windows is two constraints
    const Json& designs = data["designs"];
    CHECK(designs[0]["met"] == false);
    CHECK(designs[1]["met"] == true);
    CHECK(designs[1]["view"] == 0);  // the best first
    CHECK(designs[0]["view"] == 1);
    CHECK(designs[2]["view"].is_null());
    CHECK(designs[2]["reason"] == "parts intersect");
    REQUIRE(data["views"].size() == 2);
    CHECK(data["meshes"].size() == 4);  // table and wall once, two cubes
    CHECK(data["views"][1]["bodies"][0]["mesh"] == data["views"][0]["bodies"][0]["mesh"]);
    const auto height_of = [&](int view) {
        const Json& mesh = data["meshes"][data["views"][view]["bodies"][1]["mesh"].get<size_t>()];
        const auto x = unpacked<float>(mesh["vertices"], "f32");
        float low = 1e9F, high = -1e9F;
        for (size_t i = 2; i < x.size(); i += 3) low = std::min(low, x[i]), high = std::max(high, x[i]);
        return high - low;
    };
    CHECK(height_of(0) == Approx(10));
    CHECK(height_of(1) == Approx(8));
    CHECK(data["notices"].dump().find("left out: 1") != std::string::npos);

    // Without its design: the numbers alone, as the file has them, and told so.
    folder.write("alone.jsonl", head + "}\n" + results);
    REQUIRE(run("report " + folder.file("alone.jsonl") + " --out " + folder.file("a.html")).code == 0);
    const Json alone = data_of(contents(folder.file("a.html")));
    CHECK(alone["views"].empty());
    CHECK(alone["columns"][0]["name"] == "height");
    CHECK(unpacked<double>(alone["columns"][0]["values"], "f64")[0] == Approx(0.008));
    CHECK(alone["notices"].dump().find("SI units") != std::string::npos);
    folder.write("other.jsonl", "{\"fettle_history\": 1}\n");
    CHECK(run("report " + folder.file("other.jsonl") + " --json").json().at("errors")[0].at("code") == "missing_key");

    // A file that anyone may have written.
    const auto refused = [&](const std::string& text) {
        folder.write("hostile.jsonl", text);
        const auto answer = run("report " + folder.file("hostile.jsonl") + " --json");
        CHECK(answer.code == 3);
        return answer.json().at("errors")[0].at("code").get<std::string>();
    };
    const std::string deep(100'000, '[');
    CHECK(refused(deep + "\n") == "missing_key");
    CHECK(refused(head + "}\n") == "missing_key");  // no result yet
    CHECK(refused(head + "}\n" + deep + "\n") == "missing_key");
    folder.write("odd.jsonl",
                 head + ", \"program\": 5}\n" + deep + "\n" +
                     R"({"key": "k", "status": "failed", "kind": [], "seed": {}, "reason": {"f64": "AAAA"}, "parameters": {}})" + "\n");
    REQUIRE(run("report " + folder.file("odd.jsonl") + " --out " + folder.file("odd.html")).code == 0);
    const Json odd = data_of(contents(folder.file("odd.html")));
    CHECK(odd["program"].is_string());
    for (const char* key : {"kind", "seed", "reason"}) CHECK(odd["designs"][0][key].is_null());
    CHECK(odd["notices"].dump().find("left out: 1") != std::string::npos);
}

TEST_CASE("report: an optimisation's has the design before and after, and the forces") {
    const DesignFolder folder;
    const std::string out = folder.file("opt");
    const auto answer = run("optimise " + folder.design() + " --out " + out + " --json");
    REQUIRE(answer.code <= 2);
    const std::string first = contents(out + "/report.html");
    const Json data = data_of(first);
    REQUIRE(data["views"].size() == 2);
    CHECK(data["views"][0]["name"] == "before");
    CHECK(data["parameters"].size() == 5);
    CHECK(data["requirements"][0]["pair"] == 0);
    CHECK(data["pairs"][0]["motion"] == true);
    CHECK(data["pairs"][0]["lower"].get<double>() == Approx(1e3 * answer.json().at("clearance").at("pairs")[0].at("lower").get<double>()));
    CHECK(data["history"]["objective"].size() == answer.json().at("evaluations").get<size_t>());
    CHECK_FALSE(data["scenarios"][0]["series"].empty());
    CHECK(data["margins"]["pairs"].size() >= 1);
    CHECK(data["files"] == Json({"motion.glb", "design.final.json", "trajectory.json", "result.json"}));
    CHECK(run("report " + out).code == 0);
    CHECK(contents(out + "/report.html") == first);  // with what is kept: the same
    REQUIRE(run("export " + out + "/trajectory.json --to " + folder.file("run.glb")).code == 0);
    CHECK(contents(out + "/motion.glb") == contents(folder.file("run.glb")));
    const Json notices = data["notices"];
    CHECK(notices.dump().find("has changed since") == std::string::npos);
}

TEST_CASE("report: an optimisation's has the curves of its own quantities, and the motions of all scenarios, which stay in the folder") {
    Json design = Json::parse(tests::design_support::small_design);
    design["scenarios"] =
        Json::parse(R"([{"name": "as drawn"}, {"name": "the same"}, {"name": "tilted", "set": {"/gravity": [1, 0, -9.81]}}])");
    design["quantities"] = Json::parse(R"({"spot": {"type": "marker_position", "body": "cube", "point": [0, 0, 0], "axis": [1, 0, 0]},
                                           "falling": {"type": "marker_speed", "body": "cube", "point": [0, 0, 0], "axis": [0, 0, 1]}})");
    design["optimiser"]["max_evaluations"] = 2;
    const DesignFolder folder(design.dump());
    const std::string out = folder.file("opt");
    REQUIRE(run("optimise " + folder.design() + " --out " + out + " --json").code <= 2);
    const Json data = data_of(contents(out + "/report.html"));
    REQUIRE(data["scenarios"].size() == 3);
    CHECK(data["views"].size() == 4);
    const auto curve = [&](std::size_t scenario, const std::string& name) {
        for (const Json& chart : data["scenarios"][scenario]["quantities"])
            for (const Json& line : chart["lines"])
                if (line["name"] == name) return unpacked<double>(line["values"], "f64");
        return std::vector<double>();
    };
    for (std::size_t s = 0; s < 3; ++s) {
        const std::string file =
            s == 0 ? "/trajectory.json" : "/trajectory.scenario." + data["scenarios"][s]["name"].get<std::string>() + ".json";
        const auto stored = core::records::read_trajectory(out + file);
        REQUIRE(stored);
        const std::vector<double> spot = curve(s, "spot");
        const auto& poses = stored->trajectory.poses;
        REQUIRE(spot.size() + 1 == poses.size());
        CHECK(curve(s, "falling").size() == spot.size());
        CHECK_FALSE(data["scenarios"][s]["series"].empty());
    }
    CHECK(curve(0, "spot") == curve(1, "spot"));
    CHECK(curve(0, "spot") != curve(2, "spot"));
    // Another run without scenarios leaves none of these.
    design.erase("scenarios");
    const DesignFolder plain(design.dump());
    REQUIRE(run("optimise " + plain.design() + " --out " + out + " --json").code <= 2);
    CHECK_FALSE(std::filesystem::exists(out + "/trajectory.scenario.tilted.json"));
}

TEST_CASE("report: of an optimisation, an interference is what is one, not what cannot be verified") {
    const DesignFolder folder;
    const auto data_with = [&](const std::string& last_triangle) {
        folder.write("case.obj",
                     "v -20 -20 -20\nv 20 -20 -20\nv -20 20 -20\nv 20 20 -20\nv -20 -20 20\nv 20 -20 20\nv -20 20 20\nv 20 20 20\n"
                     "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\n" +
                         last_triangle);
        folder.write("cased.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
            {"name": "case", "type": "static", "mesh": "case.obj"},
            {"name": "part", "type": "static", "density": 1000,
             "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}]})");
        folder.write("cased.design.json", R"({"fettle_design": 1, "scene": "cased.scene.json", "units": "mm",
            "parameters": [{"name": "place", "value": 0, "lower": -1, "upper": 1}],
            "set": {"/bodies/part/position": ["= place", 0, 0]},
            "objective": [{"type": "mass", "bodies": ["part"]}],
            "constraints": [{"type": "clearance", "a": "case", "b": "part", "minimum": 1}], "optimiser": {"max_evaluations": 1}})");
        const auto tuned = run("optimise " + folder.file("cased.design.json") + " --json --out " + folder.file("cased"));
        CAPTURE(last_triangle, tuned.out);
        REQUIRE(std::filesystem::exists(folder.file("cased/report.html")));
        const Json data = data_of(contents(folder.file("cased/report.html")));
        CHECK(data["requirements"][0]["fault"].is_string());
        CHECK(tuned.json().at("clearance").at("pairs")[0].at("clash") == (data["pairs"][0]["finding"] == "clash"));
        return data;
    };
    CHECK(data_with("")["pairs"][0]["finding"] != "clash");  // the case is open: the part may lie in a room of it
    CHECK(data_with("f 2 8 6\n")["pairs"][0]["finding"] == "clash");
}

TEST_CASE("a run that cannot begin leaves nothing of an earlier one's motion to be taken for its own") {
    const DesignFolder folder;
    const std::string out = folder.file("opt"), place = "\"name\": \"place\", \"value\": 3, \"lower\": -5, \"upper\": 20";
    REQUIRE(run("optimise " + folder.design() + " --out " + out).code <= 2);
    const std::vector<std::string> motion{"trajectory.json", "motion.glb", "trajectory.start.json", "steps.csv", "report.html"};
    for (const std::string& name : motion) CHECK(std::filesystem::exists(out + "/" + name));
    const std::string in_the_wall = fettle::tests::design_support::replaced(
        fettle::tests::design_support::small_design, place, "\"name\": \"place\", \"value\": 37, \"lower\": 36, \"upper\": 38");
    folder.write("wall.design.json", in_the_wall);
    const auto failed = run("optimise " + folder.file("wall.design.json") + " --no-report --json --out " + out);
    CHECK(failed.code == 2);
    CHECK(failed.json().at("status") == "start_failed");
    CHECK(Json::parse(contents(out + "/result.json"))["status"] == "start_failed");
    for (const std::string& name : motion) CHECK_FALSE(std::filesystem::exists(out + "/" + name));
    REQUIRE(run("report " + out).code == 0);
    CHECK(data_of(contents(out + "/report.html"))["files"] == Json({"design.final.json", "result.json"}));
}

// Every member of a value, however deep (of lists the first), taken away or replaced by something else.
void damage_each(Json& whole, Json& part, const std::function<void()>& look) {
    const std::size_t members = part.is_object() ? part.size() : part.is_array() ? std::min<std::size_t>(part.size(), 1) : 0;
    for (std::size_t k = 0; k < members; ++k) {
        const auto member = std::next(part.begin(), static_cast<std::ptrdiff_t>(k));
        damage_each(whole, *member, look);
        const Json kept = *member;
        for (const Json& other : {Json(), Json(7), Json("word"), Json::array(), Json::object()}) {
            *member = other;
            look();
        }
        *member = kept;
        if (!part.is_object()) continue;
        const std::string key = member.key();
        Json without = part;
        without.erase(key);
        std::swap(part, without);
        look();
        std::swap(part, without);
    }
}

TEST_CASE("report: of an answer that is damaged a report, or what is wrong with it", "[slow]") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json");
    const std::string simulated = folder.file("sim"), judged = folder.file("fit"), tuned = folder.file("opt");
    REQUIRE(run("simulate " + scene + " --steps 1 --no-report --out " + simulated).code == 0);
    REQUIRE(run("clearance " + scene + " --minimum 1mm --no-report --out " + judged).code <= 2);
    REQUIRE(run("optimise " + folder.design() + " --no-report --out " + tuned).code <= 2);
    ReportOptions quick;
    quick.should_stop = [] { return true; };
    quick.out = "/dev/null";
    int looks = 0, refused = 0;
    for (const std::string& out : {simulated, judged, tuned}) {
        Json answer = Json::parse(contents(out + "/result.json"));
        damage_each(answer, answer, [&] {
            ++looks;
            folder.write(std::filesystem::path(out).filename().string() + "/result.json", answer.dump());
            if (!write_report(out, quick)) ++refused;  // with its reason: what is thrown ends the test
        });
    }
    CHECK(looks > 300);
    CHECK(refused > 0);
}

}  // namespace fettle::design::report::report_data_test
