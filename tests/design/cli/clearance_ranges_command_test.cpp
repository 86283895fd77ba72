// SPDX-License-Identifier: MIT
// fettle clearance SCENE --ranges from outside: reports, refusals, certificates.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::clearance_ranges_command_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;

const char* two_arms = "examples/two_arm/two_arm.scene.json";
// From the shoulder to the hand's farthest corner, in the scene's millimetres.
const double reach = 60 + std::hypot(40.0, 6.0);

Json coordinate(const Json& pair, const std::string& joint) {
    for (const Json& c : pair.at("coordinates"))
        if (c.at("joint") == joint) return c;
    return nullptr;
}

}  // namespace

TEST_CASE("ranges: the two-armed robot's worst combination, by hand") {
    const Answer answer =
        run(std::string("clearance ") + two_arms + " --ranges --json --minimum 5mm --tolerance 0.001mm --pairs 'post:*_hand'");
    CHECK(answer.code == 0);
    const Json pair = answer.pair("post", "left_hand");
    REQUIRE(!pair.is_null());
    const double gap = 1e-3 * (110 - reach);
    CHECK(pair["lower"].get<double>() <= gap);
    CHECK(pair["upper"].get<double>() >= gap - 1e-15);
    CHECK(pair["upper"].get<double>() - pair["lower"].get<double>() <= 1e-6);
    CHECK(pair["status"] == "clear");
    CHECK(pair["coordinates"].size() == 2);
    CHECK(coordinate(pair, "left_shoulder")["value"].get<double>() == Approx(-M_PI / 2).margin(1e-2));
    CHECK(coordinate(pair, "left_shoulder")["low"].get<double>() == Approx(-100 * M_PI / 180));
    CHECK(coordinate(pair, "left_elbow")["value"].get<double>() == Approx(-std::atan2(6, 40)).margin(2e-2));
    CHECK(coordinate(pair, "left_elbow")["unit"] == "rad");
    CHECK(pair["point_b"].is_array());
    // The poses are of all bodies that the pair's joints move: the hand where `pose_b` has it, the arm turned by the shoulder alone.
    const Json& poses = pair["poses"];
    CHECK(poses.size() == 2);
    CHECK(poses["left_hand"] == pair["pose_b"]);
    const double shoulder = coordinate(pair, "left_shoulder")["value"].get<double>();
    const Json& arm = poses["left_arm"];
    CHECK(arm["rotation"][0][0].get<double>() == Approx(std::cos(shoulder)).margin(1e-12));
    CHECK(arm["position"][0].get<double>() == Approx(-0.12 - 0.03 * std::sin(shoulder)).margin(1e-12));
    CHECK(arm["position"][1].get<double>() == Approx(0.03 * std::cos(shoulder)).margin(1e-12));
    CHECK(run(std::string("clearance ") + two_arms + " --ranges --minimum 10mm --pairs 'post:*_hand'").code == 1);
}

TEST_CASE("ranges: bodies that joints join are not judged unless named, options that do not go with it are refused") {
    const Answer answer = run(std::string("clearance ") + two_arms + " --ranges --json --minimum 1mm --pairs 'left_arm:left_hand'");
    CHECK(answer.code == 1);
    CHECK(answer.pair("left_arm", "left_hand")["finding"] == "clash");
    const Answer told = run(std::string("clearance ") + two_arms + " --ranges --explain --minimum 1mm --pairs 'left_arm:left_hand'");
    CHECK(told.says("the parts share material; of the places looked at, worst at "));
    CHECK_FALSE(told.says("e-1"));
    const Answer all = run(std::string("clearance ") + two_arms + " --ranges --json --minimum 1mm --ignore '*_hand:*'");
    CHECK(all.code == 0);
    const Json left_out = all.json()["left_out"];
    CHECK(std::count(left_out.begin(), left_out.end(), Json("base:post")) == 1);
    CHECK(all.pair("base", "left_arm")["status"] == "clear");  // told to collide
    for (const char* other : {"--motion", "--kinematic", "--steps 3"})
        CHECK(run(std::string("clearance ") + two_arms + " --ranges " + other).code == 3);
    const DesignFolder folder;
    const Answer none = run("clearance " + folder.file("small.scene.json") + " --ranges", true);
    CHECK(none.code == 3);
    CHECK(none.says("there is no joint"));
}

TEST_CASE("ranges: findings against an earlier report, a table with the joints' positions, a folder with a report") {
    const DesignFolder folder;
    const std::string command = std::string("clearance ") + two_arms + " --ranges --json --pairs 'post:*_hand' ";
    const Answer strict = run(command + "--minimum 10mm --out " + folder.file("out"));
    REQUIRE(strict.code == 1);
    const Json kept = Json::parse(contents(folder.file("out/result.json")));
    CHECK(kept["pairs"] == strict.json()["pairs"]);
    CHECK(kept["command"].get<std::string>().find("--ranges") != std::string::npos);
    CHECK(contents(folder.file("out/trajectory.json")).find("fettle_trajectory") != std::string::npos);
    const std::string page = contents(folder.file("out/report.html"));
    const size_t data = page.find("id=\"fettle-report\">");
    REQUIRE(data != std::string::npos);
    const size_t note = page.find("worst at left_shoulder -90", data);
    CHECK(note != std::string::npos);
    CHECK(page.find("\"ranges\":true", data) != std::string::npos);

    const std::string before = " --baseline " + folder.file("out/result.json");
    const Answer same = run(command + "--minimum 10mm" + before), loose = run(command + "--minimum 5mm" + before);
    CHECK(same.json()["baseline"]["existing"] == 2);
    CHECK(same.json()["baseline"]["new"] == 0);
    CHECK(same.pair("post", "left_hand")["change"] == "existing");
    CHECK(same.pair("post", "left_hand")["before"]["upper"] == strict.pair("post", "left_hand")["upper"]);
    CHECK(loose.code == 0);
    CHECK(loose.json()["baseline"]["resolved"] == 2);
    const Answer one = run(std::string("clearance ") + two_arms + " --ranges --json --minimum 10mm --pairs post:left_hand" + before);
    CHECK(one.json()["baseline"]["missing"] == Json({"post:right_hand"}));
    CHECK(run(command + "--baseline " + folder.file("none.json")).code == 3);

    const std::string csv = folder.file("worst.csv");
    REQUIRE(run(command + "--minimum 5mm --tolerance 0.001mm --csv " + csv).code == 0);
    std::istringstream lines(contents(csv));
    std::string head, row;
    std::getline(lines, head);
    CHECK(head == "a,b,required[mm],lower[mm],upper[mm],finding,left_shoulder[deg],right_shoulder[deg],left_elbow[deg],right_elbow[deg]");
    int rows = 0;
    while (std::getline(lines, row)) {
        ++rows;
        std::vector<std::string> words;
        std::istringstream cells(row);
        for (std::string word; std::getline(cells, word, ',');) words.push_back(word);
        if (row.back() == ',') words.emplace_back();
        REQUIRE(words.size() == 10);
        CHECK(words[2] == "5");
        CHECK(std::stod(words[3]) <= 110 - reach);
        CHECK(std::stod(words[4]) >= 110 - reach - 1e-12);
        const size_t own = words[1] == "left_hand" ? 6 : 7, other = own == 6 ? 7 : 6;
        CHECK(std::abs(std::abs(std::stod(words[own])) - 90) < 1);
        CHECK(words[other].empty());
    }
    CHECK(rows == 2);
}

TEST_CASE("ranges: groups, checks and the tolerance are those of a path") {
    const DesignFolder folder;
    const std::string junit = folder.file("ranges.xml"), sarif = folder.file("ranges.sarif");
    const std::string command = std::string("clearance ") + two_arms + " --ranges --pairs post:left --group left=left_arm,left_hand ";
    const Answer group = run(command + "--json --minimum 5mm --junit " + junit + " --sarif " + sarif);
    CHECK(group.code == 0);
    const Json pair = group.pair("post", "left");
    CHECK(pair["body_b"] == "left_hand");
    CHECK(pair["finding"] == "clear");
    CHECK(group.json()["tolerance"] == 1e-6);
    CHECK(contents(junit).find("worst at left_shoulder -90") != std::string::npos);
    const Answer strict = run(command + "--minimum 10mm --sarif " + sarif);
    CHECK(strict.code == 1);
    CHECK(strict.says("1 pair over the ranges of the joints: 1 below threshold"));
    CHECK(contents(sarif).find("below-threshold") != std::string::npos);
    CHECK(run(command + "--json --minimum 0.5mm").json()["tolerance"] == 5e-7);
    CHECK(run(std::string("clearance ") + two_arms + " --json --minimum 0.5mm --pairs post:left_hand").json()["tolerance"] == 5e-7);
    const std::string proof = folder.file("none.certificate.json");
    const Answer nothing =
        run(std::string("clearance ") + two_arms + " --ranges --json --pairs left_arm:left_hand --ignore '*:*' --certificate " + proof);
    CHECK(nothing.code == 2);
    CHECK(nothing.json()["certificate"].is_null());
    CHECK(nothing.json()["message"] == "nothing was judged: every pair is ignored");
}

TEST_CASE("ranges: a certificate is accepted, and stale when joints, limits or meshes have changed") {
    const DesignFolder folder(small_design, contents(two_arms));
    const std::string scene = folder.file("small.scene.json"), proof = folder.file("fit.certificate.json");
    const std::string command = "clearance " + scene + " --ranges --minimum 5mm --pairs 'post:*_hand' --certificate " + proof;
    REQUIRE(run(command).code == 0);
    const Answer sound = run("validate " + proof + " --minimum 5mm --json");
    CHECK(sound.code == 0);
    CHECK(sound.json()["status"] == "accepted");
    CHECK(sound.json()["judgement"] == "clear");
    CHECK(sound.json()["leaves"].get<long>() > 10);
    const std::string text = contents(two_arms);
    for (const auto& [from, to] : {std::pair<const char*, const char*>{"[-100, 30]", "[-100, 35]"},
                                   {"\"point\": [-120, 60, 0]", "\"point\": [-120, 59, 0]"},
                                   {"\"size_x\": 12", "\"size_x\": 11"}}) {
        folder.write("small.scene.json", replaced(text, from, to));
        const Answer stale = run("validate " + proof + " --json");
        CHECK(stale.code == 1);
        CHECK(stale.json()["status"] == "stale");
    }
    folder.write("small.scene.json", text);
    Json damaged = Json::parse(contents(proof));
    damaged["pairs"][0]["lower"] = damaged["pairs"][0]["upper"];
    folder.write("fit.certificate.json", damaged.dump());
    const Answer rejected = run("validate " + proof + " --json");
    CHECK(rejected.code == 1);
    CHECK(rejected.json()["status"] == "rejected");
}

TEST_CASE("ranges: limits of what follows a joint are told where they narrow its range, and leave no verdict where they leave none") {
    const auto with_follower = [](const std::string& limits) {
        const std::string box = R"("density": 1240, "shape": {"part": "box", "dimensions": {"size_x": 40, "size_y": 8, "size_z": 4}})";
        return R"({"fettle_scene": 1, "units": "mm", "timestep": 0.02, "bodies": [{"name": "one", )" + box +
               R"(}, {"name": "two", "position": [0, 0, 20], )" + box + R"(}], "joints": [
            {"name": "drive", "type": "revolute", "b": "one", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [0, 30]},
            {"name": "keep", "type": "revolute", "b": "two", "point": [0, 0, 20], "axis": [0, 0, 1], "limits": )" +
               limits + R"(}, {"name": "mimic", "type": "gear", "of": ["drive", "keep"], "ratio": -1}]})";
    };
    const auto asked = [&](const std::string& limits) {
        const DesignFolder folder(small_design, with_follower(limits));
        return run("clearance " + folder.file("small.scene.json") + " --ranges --minimum 1mm", true);
    };
    const Answer none = asked("[0, 30]"), some = asked("[-20, 30]"), all = asked("[-30, 30]");
    CHECK(none.code == 2);
    CHECK(none.says("the range of `drive` is 0 to 0 deg: `keep` narrows it from 0 to 30 deg"));
    CHECK(some.code == 0);
    CHECK(some.says("the range of `drive` is 0 to 20 deg: `keep` narrows it from 0 to 30 deg"));
    CHECK(all.code == 0);
    CHECK(!all.says("narrows"));
}

TEST_CASE("ranges: a joint without limits is named, or turns wholly") {
    const std::string text = contents(two_arms);
    const DesignFolder free(small_design, replaced(text, "\"limits\": [-120, 5]", "\"collide\": false"));
    const Answer whole = run("clearance " + free.file("small.scene.json") + " --ranges --json --minimum 5mm --pairs post:left_hand");
    CHECK(whole.code == 0);  // the same farthest corner
    CHECK(coordinate(whole.pair("post", "left_hand"), "left_elbow")["whole_turn"] == true);
    const DesignFolder slide(small_design,
                             replaced(replaced(text, "\"left_elbow\", \"type\": \"revolute\"", "\"left_elbow\", \"type\": \"prismatic\""),
                                      ", \"limits\": [-120, 5]", ""));
    const Answer refused = run("clearance " + slide.file("small.scene.json") + " --ranges", true);
    CHECK(refused.code == 3);
    CHECK(refused.says("`left_elbow`: has no limits"));
}

TEST_CASE("the two-armed robot runs; joints part between nodes no more than is asked for") {
    const std::string command = std::string("simulate ") + two_arms + " --steps 40 --json";
    const Answer plain = run(command), held = run(command + " --joint-gap 0.001mm");
    REQUIRE(plain.json()["status"] == "ok");
    REQUIRE(held.json()["status"] == "ok");
    CHECK(plain.json()["path_joint_gap"].get<double>() > 1e-6);
    CHECK(held.json()["path_joint_gap"].get<double>() <= 1e-6);
    CHECK(held.json()["nodes_added"].get<int>() > 0);
    CHECK(held.json()["bodies"] == plain.json()["bodies"]);
    CHECK(run(std::string("simulate ") + two_arms + " --joint-gap 0mm").code == 3);
    const Answer loose = run(std::string("simulate ") + two_arms + " --steps 5 --json --joint-gap 1e-12mm");
    CHECK(loose.code == 2);
    CHECK(loose.json()["status"] == "joints_part");
    CHECK(loose.json()["message"].get<std::string>().find("between nodes of step") != std::string::npos);
}

TEST_CASE("kinematic: joints that motors do not determine are refused by name, loops that they do are followed") {
    const Answer open = run(std::string("clearance ") + two_arms + " --kinematic", true);
    CHECK(open.code == 3);
    CHECK(open.says("left_arm, left_hand, right_arm, right_hand some freedom"));
    // The elbows follow the shoulders: everything is driven.
    Json scene = Json::parse(contents(two_arms));
    for (const char* side : {"left", "right"}) {
        const std::string name = side;
        scene["joints"].push_back(
            {{"name", name + "_gear"}, {"type", "gear"}, {"of", {name + "_shoulder", name + "_elbow"}}, {"ratio", 0.5}});
    }
    const DesignFolder folder(small_design, scene.dump());
    const std::string command = "clearance " + folder.file("small.scene.json") + " --json --minimum 1mm ";
    const Answer followed = run(command + "--kinematic --steps 50");
    CHECK(followed.code == 0);
    const Json pair = followed.pair("post", "left_hand");
    REQUIRE(!pair.is_null());
    // At the end the shoulder is at -80 degrees, the elbow at -40: within the worst over all positions, and no worse than what gears allow.
    const Answer ranges = run(command + "--ranges");
    CHECK(ranges.pair("post", "left_hand")["coordinates"].size() == 2);  // one free coordinate, two joints that it moves
    CHECK(ranges.pair("post", "left_hand")["lower"].get<double>() <= pair["upper"].get<double>());
    CHECK(followed.pair("left_arm", "left_hand").is_null());

    // Bounds are of joints met at all times, and so is the certificate.
    CHECK(pair["joint_charge"].get<double>() > 0);
    CHECK(pair["joint_charge"].get<double>() < 1e-4);
    CHECK(followed.says("bounds hold for joints met at all times"));
    const std::string proof = folder.file("fit.certificate.json");
    CHECK(run(command + "--kinematic --steps 50 --pairs post:left_hand --certificate " + proof).code == 0);
    const Answer valid = run("validate " + proof + " --json");
    CHECK(valid.code == 0);
    const Json claim = valid.json()["pairs"][0];
    CHECK(claim["lower"].get<double>() > 0);
    CHECK(claim["upper"].get<double>() - claim["lower"].get<double>() > 2 * pair["joint_charge"].get<double>());
    CHECK(run("validate " + proof).says("over the motion, for joints met at all times"));
    Json doctored = Json::parse(contents(proof));
    for (Json& deviation : doctored["joints"]["deviations"]) deviation = 0;
    const Answer rejected =
        run("validate " + folder.write("less.certificate.json", doctored.dump()) + " --trajectory " + folder.file("fit.trajectory.json"));
    CHECK(rejected.code == 1);
    CHECK(rejected.says("joints may have the body farther from the path than is claimed"));
    doctored = Json::parse(contents(proof));
    doctored.erase("joints");
    for (const bool with_source : {true, false}) {  // then nothing says what its bounds are worth
        if (!with_source) doctored.erase("source");
        const std::string file =
            folder.write("none.certificate.json", doctored.dump()) + " --trajectory " + folder.file("fit.trajectory.json");
        const Answer doubtful = run("validate " + file + " --minimum 1mm --json");
        CHECK(doubtful.code == 2);
        CHECK(doubtful.json()["judgement"] == "undecided");
        CHECK(doubtful.json()["pairs"][0]["status"] == "undecided");
        CHECK(doubtful.says("it has no joints"));
        const std::string junit = folder.file("j.xml");
        CHECK(run("validate " + file + " --junit " + junit).code == 2);  // accepted; whether the minimum that it states holds is not known
        CHECK(contents(junit).find("<failure type=\"undecided\"") != std::string::npos);
        CHECK(contents(junit).find("between whose nodes the joints may put the bodies elsewhere") != std::string::npos);
        CHECK(contents(junit).find("it has no joints") != std::string::npos);
    }
    scene["motors"][0]["name"] = "other";  // a name is none of the mathematics; a joint's place is
    folder.write("small.scene.json", scene.dump());
    CHECK(run("validate " + proof).code == 0);
    scene["joints"].back()["ratio"] = 0.6;
    folder.write("small.scene.json", scene.dump());
    CHECK(run("validate " + proof).says("stale: the joints or motors"));
}

TEST_CASE("kinematic: where joints are not proven to have bodies there is no bound, and no certificate of them") {
    // One arm alone is driven; its hand has a prescribed coordinate beside its joints, of which nothing can be proven.
    Json scene = Json::parse(contents(two_arms));
    scene.erase("springs");
    scene["motors"] = {{{"name", "drive"}, {"joint", "left_shoulder"}, {"angle", {{"rate", -20}}}}};
    scene["joints"].push_back({{"name", "gear"}, {"type", "gear"}, {"of", {"left_shoulder", "left_elbow"}}, {"ratio", 0.5}});
    for (Json& body : scene["bodies"])
        if (body["name"] == "left_hand") body["prescribed"] = {{"pz", {{"rate", 0}}}};
    scene["bodies"].push_back({{"name", "wall"},
                               {"type", "static"},
                               {"shape", {{"part", "box"}, {"dimensions", {{"size_x", 1}, {"size_y", 1}, {"size_z", 1}}}}},
                               {"position", {900, 0, 0}}});
    const DesignFolder folder(small_design, scene.dump());
    const std::string proof = folder.file("fit.certificate.json");
    const std::string command = "clearance " + folder.file("small.scene.json") + " --kinematic --steps 5 --json --minimum 1mm",
                      junit = folder.file("j.xml");
    const Answer answer = run(command + " --pairs post:left_hand,post:wall --certificate " + proof + " --junit " + junit);
    INFO(answer.out);
    CHECK(answer.code == 2);
    const Json pair = answer.pair("post", "left_hand");
    REQUIRE(!pair.is_null());
    CHECK(pair["status"] == "undecided");
    for (const char* bound : {"lower", "upper", "gap", "joint_charge"}) CHECK(pair[bound].is_null());
    CHECK(answer.json()["least"].is_null());
    CHECK(answer.pair("post", "wall")["status"] == "clear");
    CHECK(answer.pair("post", "wall")["lower"].get<double>() > 0.8);
    const Answer valid = run("validate " + proof + " --minimum 1mm --json");
    CHECK(valid.code == 0);
    REQUIRE(valid.json()["pairs"].size() == 1);
    CHECK(valid.json()["pairs"][0]["b"] == "wall");
    CHECK(contents(junit).find("message=\"no bound is proven: ") != std::string::npos);
    CHECK(contents(junit).find("at most inf") == std::string::npos);
    CHECK(contents(junit).find("at least 0 mm") == std::string::npos);
    // Where nothing is proven there is no certificate, nor an earlier one.
    const std::string trajectory = folder.file("fit.trajectory.json");
    REQUIRE(std::filesystem::exists(trajectory));
    const Answer none = run(command + " --pairs post:left_hand --certificate " + proof);
    CHECK(none.code == 2);
    CHECK(none.json().at("certificate").is_null());
    CHECK_FALSE(std::filesystem::exists(proof));
    CHECK_FALSE(std::filesystem::exists(trajectory));
    folder.write("fit.certificate.json", "{\"theirs\": 1}");  // no certificate: it is left alone
    CHECK(run(command + " --pairs post:left_hand --certificate " + proof).code == 2);
    CHECK(std::filesystem::exists(proof));
}

TEST_CASE("ranges: a ball and socket over its swing, with a certificate") {
    const DesignFolder folder;
    const auto scene = [&](const std::string& swing) {
        return folder.write("ball.scene.json", R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "bodies": [
            {"name": "socket", "type": "static", "shape": {"part": "ball_socket", "dimensions": {"clearance": 0.4}}},
            {"name": "stud", "density": 1000, "shape": {"part": "ball_stud"}}],
            "joints": [{"name": "ball", "type": "ball", "a": "socket", "b": "stud", "point": [0, 0, 0], "axis": [0, 0, 1], "swing": )json" +
                                                   swing + "}]}");
    };
    const std::string certificate = folder.file("fit.certificate.json");
    const std::string command = "clearance " + scene("10") + " --ranges --pairs socket:stud --minimum 0.2mm ";
    const Answer answer = run(command + "--json --certificate " + certificate);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    const Json pair = answer.pair("socket", "stud");
    CHECK(pair["status"] == "clear");
    CHECK(pair["coordinates"].size() == 3);
    CHECK(coordinate(pair, "ball")["high"].get<double>() == Approx(M_PI / 18));
    CHECK(contents(certificate).find("\"fettle_certificate\": 4") != std::string::npos);
    const Answer checked = run("validate " + certificate);
    CAPTURE(checked.out);
    CHECK(checked.code == 0);
    const std::string wider = scene("11");
    CHECK(run("validate " + certificate, true).says("stale"));
    CHECK(run("clearance " + scene("50") + " --ranges --pairs socket:stud --minimum 0.2mm").code == 1);
    // The least work that there is decides nothing, and is told.
    const Answer cut = run("clearance " + scene("10") + " --ranges --pairs socket:stud --minimum 0.2mm --budget 1e-6");
    CAPTURE(cut.out);
    CHECK(cut.code == 2);
    CHECK(cut.says("budget"));
    CHECK(run(command + "--budget 0").code == 3);
}

TEST_CASE("ranges: a four-bar over all positions of its crank, with a certificate") {
    const DesignFolder folder;
    const std::string joints = R"json("joints": [
        {"name": "A", "type": "revolute", "b": "crank", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [-20, 20]},
        {"name": "B", "type": "revolute", "a": "crank", "b": "coupler", "point": [0, 20, 4], "axis": [0, 0, 1]},
        {"name": "C", "type": "revolute", "b": "rocker", "point": [60, 0, 8], "axis": [0, 0, 1]},
        {"name": "D", "type": "revolute", "a": "coupler", "b": "rocker", "point": [60, 40, 8], "axis": [0, 0, 1]}])json";
    const std::string bodies = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "bodies": [
        {"name": "crank", "density": 1000, "position": [0, 10, 0], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 20, "size_z": 2}}},
        {"name": "coupler", "density": 1000, "position": [30, 30, 4], "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 4, "size_z": 2}}},
        {"name": "rocker", "density": 1000, "position": [60, 20, 8], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 40, "size_z": 2}}},
        {"name": "post", "type": "static", "position": [30, 60, 4], "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}],
        )json";
    const std::string scene = folder.write("bars.scene.json", bodies + joints + "}"), certificate = folder.file("bars.certificate.json");
    const Answer answer = run("clearance " + scene + " --ranges --minimum 1mm --json --certificate " + certificate);
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    const Json report = answer.json();
    CHECK(report["source"] == "over the ranges of the joints");
    CHECK_FALSE(report.contains("tolerances"));
    const Json pair = answer.pair("coupler", "post");
    CHECK(pair["status"] == "clear");
    CHECK(pair["coordinates"].size() >= 2);
    CHECK_FALSE(pair.contains("worst_deviations"));
    const Answer checked = run("validate " + certificate);
    CAPTURE(checked.out);
    CHECK(checked.code == 0);
    CHECK(checked.says("over all positions of the joints"));
    folder.write("bars.scene.json", bodies + fettle::tests::support::replaced(joints, "[-20, 20]", "[-20, 25]") + "}");
    CHECK(run("validate " + certificate, true).says("stale"));
    folder.write("bars.scene.json", bodies + fettle::tests::support::replaced(joints, ", \"limits\": [-20, 20]", "") + "}");
    CHECK(run("clearance " + scene + " --ranges --minimum 1mm", true).says("that nothing drives"));
    CHECK(run("ranges " + scene, true).says("closes a loop"));
}

}  // namespace fettle::design::cli::clearance_ranges_command_test
