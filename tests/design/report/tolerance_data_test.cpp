// SPDX-License-Identifier: MIT
// The data of the page of tolerances, against closed forms: what each tolerance moves a mass by, quantiles of a prediction, samples.
#include "design/report/tolerance_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files/atomic_file.hpp"
#include "design/studies/tolerance_file.hpp"
#include "tests/design/report/packed.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::report::tolerance_data_test {

namespace {

using Json = nlohmann::ordered_json;
using tests::design_support::DesignFolder;
using tests::report_support::data_of;
using tests::report_support::unpacked;

const std::string block = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
    "description": "A <b>block</b>.",
    "bodies": [{"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";

// 0.1 g/mm times a density that varies by 6%; lengths of 0 and less cannot be made.
std::string made(const std::string& size, const std::string& density) {
    return R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "size", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_x": "= size"},
        "objective": [{"type": "mass", "bodies": ["block"]}],
        "constraints": [{"type": "mass", "name": "weight", "bodies": ["block"], "upper": "1.5 g"}],
        "tolerances": {"size": )json" +
           size + R"(, "/bodies/block/density": )" + density + "}}";
}

struct Studied {
    Studied(const std::string& design, int samples, bool second_order = true) : folder(design, block) {
        reading::DesignReadOptions read;
        read.as_made = true;
        file.emplace(reading::read_design(folder.design(), read).value());
        studies::ToleranceOptions options;
        options.samples = samples;
        options.second_order = second_order;
        study = studies::study_tolerances(*file, "", options).value();
        data = tolerance_data({*file, study, "as told", "fettle tolerance x"});
    }
    DesignFolder folder;
    std::optional<reading::DesignFile> file;
    studies::ToleranceReport study;
    Json data;
};

// Place of a contributor in a response's list, of the answer.
std::size_t place_of(const Json& contributions, const std::string& of) {
    for (std::size_t k = 0; k < contributions.size(); ++k)
        if (contributions[k]["of"] == of) return k;
    FAIL("no contributor " << of);
    return 0;
}

}  // namespace

TEST_CASE("tolerance data: what each tolerance, alone at its limits, moves a number by") {
    const Studied studied(made(R"({"lower": -1, "upper": 2})", R"({"lower": -60, "upper": 60})"), 0);
    const Json& data = studied.data;
    CHECK(data["kind"] == "tolerance");
    CHECK(data["name"] == "small");
    CHECK(data["command"] == "fettle tolerance x");
    CHECK(data["text"] == "as told");
    REQUIRE(data["responses"].size() == 2);
    REQUIRE(data["answer"]["responses"].size() == 2);
    const Json &weight = data["responses"][1], &told = data["answer"]["responses"][1];
    CHECK(told["unit"] == "g");
    CHECK(weight["scale"] == 1e-3);
    CHECK(weight["required"].get<std::string>().find("at most 1.5 g") == 0);
    CHECK(data["responses"][0]["required"].is_null());
    const std::size_t by_size = place_of(told["contributions"], "size"), by_density = 1 - by_size;
    REQUIRE(weight["effects"].size() == 2);
    CHECK(weight["effects"][by_size]["at_lower"].get<double>() == Approx(-1e-4).epsilon(1e-6));
    CHECK(weight["effects"][by_size]["at_upper"].get<double>() == Approx(2e-4).epsilon(1e-6));
    CHECK(weight["effects"][by_density]["at_lower"].get<double>() == Approx(-0.06e-3).epsilon(1e-6));
    CHECK(weight["effects"][by_density]["at_upper"].get<double>() == Approx(0.06e-3).epsilon(1e-6));
    CHECK(weight["effects"][by_size]["shared"] == false);
    // Nothing was sampled.
    CHECK(unpacked<double>(weight["values"], "f64").empty());
    CHECK(unpacked<std::uint32_t>(data["samples"], "u32").empty());
    for (const Json& each : data["deviations"]) CHECK(each.is_null());
}

TEST_CASE("tolerance data: quantiles of a prediction are those of its distribution") {
    // Linear: a uniform size makes a uniform mass; a density that does not vary adds nothing.
    const Studied studied(made(R"({"lower": -1, "upper": 1, "distribution": "uniform"})", R"({"lower": 0, "upper": 0})"), 0, false);
    const auto quantiles = unpacked<double>(studied.data["responses"][1]["predicted"], "f64");
    REQUIRE(quantiles.size() > 100);
    const double last = static_cast<double>(quantiles.size() - 1);
    for (std::size_t k = 0; k < quantiles.size(); ++k) {
        CHECK(quantiles[k] == Approx(1e-3 * (0.9 + 0.2 * static_cast<double>(k) / last)).margin(1e-6));
        if (k > 0) CHECK(quantiles[k] >= quantiles[k - 1]);
    }
}

TEST_CASE("tolerance data: each sample has its deviations and values, and none where it could not be made") {
    const Studied studied(made(R"("+-15 mm")", R"({"lower": -60, "upper": 60})"), 64);
    const Json& data = studied.data;
    const auto numbers = unpacked<std::uint32_t>(data["samples"], "u32"), met = unpacked<std::uint32_t>(data["responses"][1]["met"], "u32");
    const auto values = unpacked<double>(data["responses"][1]["values"], "f64");
    REQUIRE(numbers.size() == 64);
    REQUIRE(values.size() == 64);
    REQUIRE(met.size() == 64);
    const std::size_t size = place_of(data["answer"]["tolerances"], "size");
    const auto deviations = unpacked<double>(data["deviations"][size], "f64");
    REQUIRE(deviations.size() == 64);
    CHECK(data["deviations"][1 - size].is_null());  // moves no number most
    std::size_t failed = 0;
    for (std::size_t k = 0; k < 64; ++k) {
        CHECK(numbers[k] == k);
        if (std::isnan(values[k])) {
            ++failed;
            CHECK(met[k] == 0);
            CHECK(deviations[k] <= -10 + 1e-6);
        } else {
            CHECK(values[k] == Approx(1e-4 * (10 + deviations[k])).epsilon(0.07));
            CHECK((met[k] == 1) == (values[k] <= 1.5e-3));
        }
    }
    CHECK(failed > 0);
    CHECK(failed == data["answer"]["samples"]["failed"].get<std::size_t>());
    CHECK(data["answer"]["failed"].size() == failed);
}

TEST_CASE("tolerance data: the page holds them, and no name of theirs is markup") {
    const Studied studied(made(R"("+-1 mm")", R"({"lower": -60, "upper": 60})"), 4);
    const std::string file = studied.folder.file("r.html");
    REQUIRE(write_tolerance_report(file, {*studied.file, studied.study, "<b>told</b>"}).empty());
    const std::string page = core::files::read_file(file).value();
    CHECK(page.find("<b>told") == std::string::npos);
    CHECK(page.find("<b>block") == std::string::npos);
    const Json data = data_of(page);
    CHECK(data["text"] == "<b>told</b>");
    CHECK(data["command"].is_null());
    CHECK_FALSE(write_tolerance_report("/proc/none/r.html", {*studied.file, studied.study}).empty());
}

}  // namespace fettle::design::report::tolerance_data_test
