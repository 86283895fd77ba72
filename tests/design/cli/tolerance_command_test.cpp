// SPDX-License-Identifier: MIT
// `fettle tolerance`, as users have it.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files/atomic_file.hpp"
#include "tests/design/report/packed.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::tolerance_command_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::report_support::data_of;
using fettle::tests::report_support::unpacked;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

const std::string block = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
    "bodies": [{"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";

// 0.1 g/mm; lengths of 0 and less cannot be made: beyond 2 sigma.
const std::string made = R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
    "parameters": [{"name": "size", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_x": "= size"},
    "objective": [{"type": "mass", "bodies": ["block"]}],
    "constraints": [{"type": "mass", "name": "weight <b> & co", "bodies": ["block"], "upper": "1.5 g"}],
    "tolerances": {"size": "+-15 mm", "/bodies/block/density": {"lower": -60, "upper": 60}}})json";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

}  // namespace

TEST_CASE("tolerance: a report to look at") {
    const DesignFolder folder(made, block);
    const Answer told = run("tolerance " + folder.design() + " --samples 64 --json --report " + folder.file("r.html"));
    INFO(told.out);
    REQUIRE(told.code == 0);
    const auto json = told.json();
    CHECK(json.at("report") == folder.file("r.html"));
    const int failed = json.at("samples").at("failed").get<int>();
    CHECK(failed > 0);
    const std::string page = core::files::read_file(folder.file("r.html")).value();
    CHECK_FALSE(has(page, "<b> & co"));
    const nlohmann::json data(data_of(page));
    auto answer = json;
    answer.erase("report");
    CHECK(data.at("answer") == answer);
    CHECK(has(data.at("command").get<std::string>(), "fettle tolerance "));
    CHECK(has(data.at("text").get<std::string>(), std::to_string(json.at("samples").at("met").get<int>()) + " meet every requirement"));
    for (const auto& response : data.at("responses")) {
        CHECK(unpacked<double>(response.at("values"), "f64").size() == 64);
        CHECK_FALSE(unpacked<double>(response.at("predicted"), "f64").empty());
        CHECK(response.at("effects").size() == 2);
    }

    // Without samples what moves the numbers is shown.
    const Answer first = run("tolerance " + folder.design() + " --first-order --report " + folder.file("r.html"));
    REQUIRE(first.code == 0);
    CHECK(has(first.out, "report: " + folder.file("r.html")));
    const nlohmann::json predicted(data_of(core::files::read_file(folder.file("r.html")).value()));
    REQUIRE(predicted.at("responses").size() == 2);
    CHECK(unpacked<double>(predicted.at("responses")[1].at("values"), "f64").empty());
    CHECK(predicted.at("responses")[1].at("effects").size() == 2);

    // The page of an allocation is about the tolerances that were found.
    const Answer loosest = run("tolerance " + folder.design() + " --allocate --yield 0.9 --json --report " + folder.file("a.html"));
    INFO(loosest.out);
    REQUIRE(loosest.code <= 2);
    const nlohmann::json allocated(data_of(core::files::read_file(folder.file("a.html")).value()));
    CHECK(allocated.at("answer").at("tolerances")[1].at("upper") == loosest.json().at("study").at("tolerances")[1].at("upper"));
}

TEST_CASE("tolerance: a report that cannot be written is told before the work") {
    const DesignFolder folder(made, block);
    std::filesystem::create_directory(folder.file("taken"));
    for (const std::string& out :
         {folder.file("taken"), std::string("/proc/none/r.html"), folder.design(), folder.file("small.scene.json")}) {
        const Answer told = run("tolerance " + folder.design() + " --first-order --json --report " + out);
        INFO(told.out);
        CHECK(told.code == 3);
        CHECK_FALSE(told.json().at("errors").empty());
    }
    CHECK(core::files::read_file(folder.design()).value() == made);
    const Answer both =
        run("tolerance " + folder.design() + " --json --samples 2 --report " + folder.file("x") + " --samples-file " + folder.file("x"));
    CHECK(both.code == 3);
    CHECK_FALSE(std::filesystem::exists(folder.file("x")));
}

TEST_CASE("simulate: a sample of the tolerances, as made") {
    const DesignFolder folder(made, block);
    const std::string samples = " --samples-file " + folder.file("s.jsonl");
    const Answer told = run("tolerance " + folder.design() + " --samples 32 --first-order --seed 7" + samples);
    REQUIRE(told.code == 0);
    INFO(told.out);
    // The command for the worst sample, and for the jam, as it can be typed.
    CHECK(has(told.out, "could not be made or simulated"));
    CHECK(count_of(told.out, "to see it: fettle simulate " + folder.design() + " --made ") == 2);
    const auto json = run("tolerance " + folder.design() + " --samples 32 --first-order --json --seed 7" + samples).json();
    const int worst = json.at("worst_sample").at("sample").get<int>(), jam = json.at("kinds_of_failure").at(0).at("sample").get<int>();
    CHECK(json.at("samples").at("seed") == 7);
    CHECK(has(told.out, "--made " + std::to_string(worst) + " --seed 7 --out"));
    CHECK(has(told.out, "--made " + std::to_string(jam) + " --seed 7 --out"));

    const Answer seen =
        run("simulate " + folder.design() + " --json --out " + folder.file("out") + " --made " + std::to_string(worst) + samples);
    INFO(seen.out);
    REQUIRE(seen.code == 0);
    const auto answer = seen.json();
    CHECK(answer.at("made").at("sample") == worst);
    CHECK(answer.at("made").at("seed") == 7);
    REQUIRE(answer.at("made").at("deviations").size() == 2);
    CHECK(std::filesystem::exists(folder.file("out/report.html")));
    // Its mass follows from its deviations, and agrees with the one that the file keeps.
    const auto& by = answer.at("made").at("deviations");
    REQUIRE(by[1].at("of") == "size");
    const double mass = (10 + by[1].at("value").get<double>()) * 1e-4 * (1 + by[0].at("value").get<double>() / 1000);
    const auto& kept = answer.at("made").at("kept");
    CHECK(kept.at("reason").is_null());
    CHECK(kept.at("responses").at(1).at("value").get<double>() == Approx(mass).epsilon(1e-9));
    CHECK_FALSE(kept.at("responses").at(1).at("met").get<bool>());

    const auto refused = [&](const std::string& arguments, const std::string& why) {
        const Answer answer = run("simulate " + arguments, true);
        INFO(arguments << "\n" << answer.out);
        CHECK(answer.code == 3);
        CHECK(has(answer.out, why));
    };
    refused(folder.design() + " --made " + std::to_string(jam) + " --seed 7", "sample " + std::to_string(jam) + " cannot be made");
    refused(folder.design() + " --made 32" + samples, "it has no sample 32, of the 32 that are in it");
    refused(folder.design() + " --made -1", "--made");
    refused(folder.design() + " --made 1 --samples-file " + folder.file("none.jsonl"), "none.jsonl");
    refused(folder.design() + " --made 1 --samples-file " + folder.file("small.scene.json"), "not a file of samples");
    refused(folder.design() + " --made 1 --seed 3" + samples, "--seed");
    refused(folder.design() + " --seed 3", "--made");
    refused(folder.file("small.scene.json") + " --made 1", "this is a scene");
    folder.write("other.design.json", tests::support::replaced(made, "+-15 mm", "+-14 mm"));
    refused(folder.file("other.design.json") + " --made 1" + samples, "samples of another design");
    const std::size_t at = made.find(",\n    \"tolerances\"");
    folder.write("plain.design.json", made.substr(0, at) + "}");
    refused(folder.file("plain.design.json") + " --made 1", "it has no `tolerances`");
}

}  // namespace fettle::design::cli::tolerance_command_test
