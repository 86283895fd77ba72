// SPDX-License-Identifier: MIT
// fettle clearance of many pairs from outside: those that stay twice their minimum apart are told so without their distance, and that is
// true; all others are told as if there were few.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::cli::clearance_many_test {

namespace {

using Json = nlohmann::json;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

constexpr int cubes = 16;  // 120 pairs

// Cubes of 10 mm in a row, 0.5, 0.9 and 2 mm apart in turns; each turns a little about an axis of its own, in 0.3 s.
std::string row() {
    std::string text = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "end_time": 0.3, "bodies": [)";
    double x = 0;
    for (int i = 0; i < cubes; ++i) {
        text += std::string(i > 0 ? "," : "") + R"({"name": "cube)" + std::to_string(i) + R"(", "type": "kinematic", "shape": )" +
                R"({"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}, "position": [)" + std::to_string(x) +
                R"(, 0, 0], "prescribed": {"rx": {"rate": )" + std::to_string(5 + 10 * (i % 3)) + "}}}";
        x += i % 3 == 0 ? 10.5 : i % 3 == 1 ? 10.9 : 12;
    }
    return text + "]}";
}

}  // namespace

TEST_CASE("clearance: of many pairs the far ones are told without their distance") {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string scene = folder.write("row.scene.json", row());
    for (const std::string over : {"", "--kinematic "}) {
        const std::string command = "clearance " + scene + " --minimum 0.6mm --json " + over;
        const Answer many = run(command);
        const Answer measured = run(command + "--csv " + folder.file("margins.csv"));  // margin curves are of every pair
        CHECK(many.code == measured.code);
        CHECK(many.code == 1);
        const Json short_report = many.json(), whole = measured.json();
        REQUIRE(short_report.at("pairs").size() == 120);
        CHECK(whole.at("not_measured") == 0);
        CHECK(short_report.at("least") == whole.at("least"));
        int far = 0;
        for (const Json& pair : short_report.at("pairs")) {
            const Json exact = measured.pair(pair.at("a"), pair.at("b"));
            CAPTURE(over, pair.at("a"), pair.at("b"));
            CHECK(pair.at("status") == exact.at("status"));
            CHECK(pair.at("finding") == exact.at("finding"));
            CHECK(pair.at("solids") == exact.at("solids"));
            if (!pair.at("upper").is_null()) {
                CHECK(pair == exact);
                CHECK(exact.at("lower").get<double>() < 1.2e-3);
                continue;
            }
            ++far;
            CHECK(pair.at("measured") == false);
            CHECK(pair.at("lower").get<double>() >= 1.2e-3);
            CHECK(pair.at("lower").get<double>() <= exact.at("upper").get<double>());
            for (const char* key : {"time", "gap", "sampled", "point_a", "point_b", "witness"}) CHECK(pair.at(key).is_null());
        }
        CHECK(short_report.at("not_measured") == far);
        CHECK(far == 110);  // ten neighbours are nearer than 1.2 mm
    }
}

TEST_CASE("clearance: who names a pair, or has few, is told its distance") {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string command = "clearance " + folder.write("row.scene.json", row()) + " --json ";
    const Answer named = run(command + "--pairs '*:*,cube0:cube15=0.6mm' --minimum 0.6mm");
    CHECK(named.pair("cube0", "cube15").at("upper").get<double>() > 0.1);
    CHECK(named.pair("cube0", "cube14").at("upper").is_null());
    CHECK(run(command + "--pairs 'cube0:*' --minimum 0.6mm").pair("cube0", "cube15").at("upper").get<double>() > 0.1);
    CHECK(run(command).pair("cube0", "cube15").at("upper").get<double>() > 0.1);  // without a minimum distances are what is wanted
}

TEST_CASE("clearance: reports with far pairs are read, explained and certified") {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string command = "clearance " + folder.write("row.scene.json", row()) + " --kinematic --minimum 0.4mm ";
    const Answer first = run(command + "--json");
    CHECK(first.code == 0);
    const std::string before = folder.write("before.json", first.out);
    const Json baseline = run(command + "--json --baseline " + before).json();
    CHECK(baseline.at("baseline").at("new") == 0);
    CHECK(baseline.at("baseline").at("missing").empty());
    for (const Json& pair : baseline.at("pairs")) {
        CHECK(pair.at("before").at("lower") == pair.at("lower"));
        CHECK(pair.at("before").at("upper") == pair.at("upper"));
    }
    const Answer text = run(command + "--explain 200");
    CHECK(text.says("115 of them are not listed: they stay at least twice as far apart as is required"));
    CHECK(text.says("cube0:cube1"));
    CHECK_FALSE(text.says("cube0:cube2"));
    const std::string certificate = folder.file("row.certificate.json");
    const Json certified = run(command + "--json --certificate " + certificate).json();
    CHECK(certified.at("not_measured") == 115);
    const Answer check = run("validate " + certificate + " --minimum 0.4mm --json");
    CHECK(check.code == 0);
    CHECK(check.json().at("status") == "accepted");
    REQUIRE(check.json().at("pairs").size() == 120);
    const Json pairs = check.json().at("pairs");
    for (const Json& pair : pairs) {
        const Json claim = [&] {
            for (const Json& p : certified.at("pairs"))
                if (p.at("a") == pair.at("a") && p.at("b") == pair.at("b")) return p;
            return Json();
        }();
        CHECK(pair.at("lower") == claim.at("lower"));
        CHECK((!claim.at("upper").is_null() || pair.at("lower").get<double>() >= 0.8e-3));
    }
}

}  // namespace fettle::design::cli::clearance_many_test
