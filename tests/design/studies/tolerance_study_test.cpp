// SPDX-License-Identifier: MIT
// Published stacks as designs, and a part whose mass and fall have closed forms.
#include "design/studies/tolerance_study.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/parallel.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::studies::tolerance_study_test {

namespace {

constexpr double degree = std::numbers::pi / 180;

const char* const block = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
    "variables": {"length": "10 mm", "twice": "2 * length"},
    "bodies": [{"name": "block", "density": 1000,
                "shape": {"part": "box", "dimensions": {"size_x": "= length", "size_y": 10, "size_z": 10}}}]})";

// One-way clutch: hub a, roller c, ring e; the wedge's angle is acos((a + c)/(e - c)) (Gao, Chase and Magleby).
const char* const clutch = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "a", "value": 27.645, "lower": 20, "upper": 30}, {"name": "c", "value": 11.43, "lower": 10, "upper": 12},
                   {"name": "e", "value": 50.8, "lower": 45, "upper": 55}],
    "objective": [{"type": "expression", "expression": "acos((a + c) / (e - c)) / 1 deg"}],
    "constraints": [{"type": "relation", "name": "angle", "expression": "acos((a + c) / (e - c))", "lower": "6.5 deg", "upper": "7.5 deg"}],
    "tolerances": {"a": "+-0.05 mm", "c": "+-0.01", "e": {"lower": "-0.0125 mm", "upper": 0.0125}}})json";

// The same as parts that touch: a roller on the hub's flat rolls by its weight into the wedge between hub and ring.
std::string clutch_scene(double dhat) {
    return R"json({"fettle_scene": 1, "units": "mm", "gravity": [9.81, 0, 0], "timestep": 0.05, "integrator": "quasi_static",
    "variables": {"a": "27.645 mm", "c": "11.43 mm", "e": "50.8 mm"}, "contact": {"kappa": 1e7, "dhat": )json" +
           std::to_string(dhat) + R"json(},
    "bodies": [
      {"name": "hub", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 20, "size_z": 30}},
       "position": [5, "= a - 10 mm", 0]},
      {"name": "ring", "type": "static", "shape": {"part": "washer", "counts": {"segments": 720}, "dimensions": {"shaft_radius": "= e - 1 mm",
       "clearance": 1, "wall": 5, "thickness": 20}}, "position": [0, 0, -10]},
      {"name": "roller", "density": 7850, "shape": {"part": "cylinder", "counts": {"segments": 512}, "dimensions": {"radius": "= c",
       "length": 14}}, "position": ["= sqrt((e - c) ^ 2 - (a + c) ^ 2) - 1.3 mm", "= a + c + 0.03 mm", 0]}]})json";
}
const char* const touching_clutch = R"json({"fettle_design": 1, "scene": "clutch.scene.json", "units": "mm", "simulation": {"steps": 20},
    "parameters": [{"name": "a", "lower": 27, "upper": 28}],
    "quantities": {"x": {"type": "marker_position", "body": "roller", "point": [0, 0, 0], "axis": [1, 0, 0], "over": "end"},
                   "y": {"type": "marker_position", "body": "roller", "point": [0, 0, 0], "axis": [0, 1, 0], "over": "end"}},
    "objective": [{"type": "expression", "expression": "atan2(x, y) / 1 deg"}],
    "tolerances": {"a": "+-0.05 mm", "c": "+-0.01 mm", "e": "+-0.0125 mm"}})json";

// Nominal 10 mm long, 10 mm on a side, 1 g/cm^3.
const char* const made_block = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_y": "= depth"},
    "objective": [{"type": "mass", "bodies": ["block"]}],
    "constraints": [{"type": "mass", "name": "mass", "bodies": ["block"], "upper": "1.02 g"}],
    "tolerances": TOLERANCES})json";

struct Folder : tests::support::TemporaryFolder {
    Folder() { write("block.scene.json", block); }
    Result<reading::DesignFile> read(const std::string& text) {
        reading::DesignReadOptions options;
        options.as_made = true;
        return reading::parse_design(text, file("x.design.json"), options);
    }
    Result<reading::DesignFile> read_block(const std::string& tolerances) {
        std::string text = made_block;
        return read(text.replace(text.find("TOLERANCES"), 10, tolerances));
    }
};

ToleranceReport study(const Result<reading::DesignFile>& file, const ToleranceOptions& options = {}) {
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    ToleranceReport report = study_tolerances(*problem, file->tolerances, options);
    INFO(report.reason << report.no_second_order);
    REQUIRE(report.reason.empty());
    return report;
}

std::vector<MadeSample> failures(const ToleranceReport& report) {
    std::vector<MadeSample> out;
    for (const MadeSample& sample : report.samples)
        if (sample.failed()) out.push_back(sample);
    return out;
}

}  // namespace

TEST_CASE("tolerances of a stack: the motor of the Dimensioning and Tolerancing Handbook, chapter 9, of variables and a parameter") {
    Folder folder;
    folder.write("block.scene.json", R"({"fettle_scene": 1, "units": "in",
        "variables": {"A": "0.375 in", "B": "0.032 in", "C": "0.060 in", "D": "0.438 in", "E": "0.120 in",
                      "F": "1.5 in", "G": "0.12 in", "H": "0.438 in", "I": "0.45 in", "J": "3.019 in"},
        "bodies": [{"name": "any", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 1, "size_y": 1, "size_z": 1}}}]})");
    const ToleranceReport report = study(folder.read(R"({"fettle_design": 1, "scene": "block.scene.json", "units": "in",
        "simulation": {"steps": 1}, "parameters": [{"name": "K", "value": 0.3, "lower": 0.2, "upper": 0.4}],
        "constraints": [{"type": "relation", "name": "gap", "expression": "-A + B + C + D + E + F + G + H + I - J + K", "lower": 0}],
        "tolerances": {"A": {"lower": -0.031, "upper": 0}, "B": "+-0.002", "C": "+-0.003", "D": {"lower": -0.015, "upper": 0},
            "E": "+-0.005", "F": {"lower": -0.004, "upper": 0.01}, "G": "+-0.005", "H": {"lower": -0.015, "upper": 0}, "I": "+-0.007",
            "J": {"lower": 0, "upper": 0.012}, "K": "+-0.03"}})"));
    REQUIRE(report.responses.size() == 2);  // the objective is one, of nothing
    constexpr double inch = 0.0254;
    const Response& gap = report.responses[1];
    CHECK(gap.nominal == Approx(0.064 * inch).epsilon(1e-12));
    CHECK(gap.linear.mean == Approx(0.0615 * inch).epsilon(1e-12));
    CHECK(3 * gap.linear.standard_deviation == Approx(0.03808 * inch).margin(5e-6 * inch));
    CHECK(gap.worst.least == Approx(-0.034 * inch).epsilon(1e-10));
    CHECK(gap.worst.most == Approx(0.157 * inch).epsilon(1e-10));
    REQUIRE(gap.contributions.size() == 11);
}

TEST_CASE("tolerances of the one-way clutch: the published sensitivities, shares, moments and worst case") {
    Folder folder;
    ToleranceOptions options;
    options.worst_case = true;
    const ToleranceReport report = study(folder.read(clutch), options);
    REQUIRE(report.responses.size() == 2);
    CHECK(report.no_second_order.empty());
    const Response& angle = report.responses[1];
    CHECK(angle.nominal / degree == Approx(7.018389803).epsilon(1e-9));
    CHECK(angle.gradient[0] * 1e-3 / degree == Approx(-11.910473).epsilon(1e-6));
    CHECK(angle.gradient[1] * 1e-3 / degree == Approx(-23.731700).epsilon(1e-6));
    CHECK(angle.gradient[2] * 1e-3 / degree == Approx(11.821227).epsilon(1e-6));
    CHECK(angle.linear.standard_deviation / degree == Approx(0.2192924).epsilon(1e-6));
    REQUIRE(angle.contributions.size() == 3);
    CHECK(angle.contributions[0].share == Approx(0.81942).epsilon(1e-4));
    CHECK(angle.contributions[1].share == Approx(0.13013).epsilon(1e-4));
    CHECK(angle.contributions[2].share == Approx(0.05045).epsilon(1e-3));
    CHECK((angle.worst.most - angle.worst.least) / 2 / degree == Approx(0.980606).epsilon(1e-5));
    CHECK(angle.least_found->value / degree == Approx(5.957365).epsilon(1e-6));
    CHECK(angle.most_found->value / degree == Approx(7.938469).epsilon(1e-6));
    REQUIRE(angle.second_order);
    CHECK(angle.second_order->mean / degree == Approx(7.0149565).epsilon(1e-4));
    CHECK(angle.second_order->standard_deviation / degree == Approx(0.2196700).epsilon(1e-4));
    CHECK(skewness(*angle.second_order) == Approx(-0.0943927).epsilon(0.02));
    CHECK(kurtosis(*angle.second_order) == Approx(3.0238976).epsilon(1e-3));
    REQUIRE(angle.second_order_yield);
}

// Contact keeps parts apart by some of dhat, and round surfaces of n facets by r (pi / n)^2 / 2 each: this gap g is as much added to a + c
// - e, by which the angle is smaller and its derivatives, in 1 / sin, are larger. What is left of them with the angle as it is stays below
// 0.2%.
TEST_CASE("tolerances of the one-way clutch as parts that touch: sensitivities within 1%, and what dhat does to them") {
    const double h = 27.645 + 11.43, r = 50.8 - 11.43, ring_cover = 50.8 * std::pow(std::numbers::pi / 720, 2) / 2,
                 roller_cover = 11.43 * std::pow(std::numbers::pi / 512, 2) / 2;  // [mm]
    for (const double dhat : {0.0005, 0.02}) {
        Folder folder;
        folder.write("clutch.scene.json", clutch_scene(dhat));
        ToleranceOptions options;
        options.second_order = false;
        const ToleranceReport report = study(folder.read(touching_clutch), options);
        REQUIRE(report.responses.size() == 1);
        const Response& angle = report.responses[0];
        CAPTURE(dhat, angle.nominal);
        const double sine = std::sin(std::acos(h / r)), sine_there = std::sin(angle.nominal * degree);
        const std::array<double, 3> exact{-1 / (r * sine), -(1 / r + h / (r * r)) / sine, h / (r * r * sine)};  // [rad/mm]
        for (std::size_t k = 0; k < 3; ++k) {
            const double found = angle.gradient[static_cast<Eigen::Index>(k)] * 1e-3 * degree;
            CAPTURE(k, found / exact[k]);
            if (dhat < 0.001) CHECK(found == Approx(exact[k]).epsilon(0.01));
            CHECK(found == Approx(exact[k] * sine / sine_there).epsilon(0.002));
        }
        CHECK(angle.nominal * degree <= std::acos((h + roller_cover) / (r - roller_cover - ring_cover)));
        CHECK(angle.nominal * degree >= std::acos((h + roller_cover + dhat) / (r - roller_cover - ring_cover - dhat)));
    }
}

// (a - c - 16.2)^2 is 0.000225 mm^2 as drawn, 0 within the limits, and 0.005625 mm^2 at a corner.
TEST_CASE("tolerances: the extremes of a response that is not monotone lie within the limits") {
    Folder folder;
    ToleranceOptions options;
    options.worst_case = true;
    for (const bool second_order : {true, false}) {
        options.second_order = second_order;
        const ToleranceReport report = study(folder.read(R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
            "parameters": [{"name": "a", "value": 27.645, "lower": 20, "upper": 30}, {"name": "c", "value": 11.43, "lower": 10, "upper": 12}],
            "objective": [{"type": "expression", "expression": "(a + c) / 1 mm"}],
            "constraints": [{"type": "relation", "name": "square", "expression": "(a - c - 16.2 mm)^2", "lower": "0 mm^2", "upper": "1 mm^2"}],
            "tolerances": {"a": "+-0.05 mm", "c": "+-0.01"}})json"),
                                             options);
        const Response& square = report.responses[1];
        CHECK(square.nominal == Approx(0.000225e-6).epsilon(1e-6));
        CHECK(square.most_found->value == Approx(0.005625e-6).epsilon(1e-6));
        CHECK(square.most_found->deviations.isApprox(Vector2(0.05e-3, -0.01e-3)));
        CHECK(square.least_found->value < 0.0000003e-6);
        CHECK(square.least_found->value >= 0);
        CHECK(square.most_found->settled);
        CHECK(square.least_found->settled);
        CHECK(square.worst.least < 0);  // what is linear knows no better
    }
}

// Eleven times as steep from 5 um above the drawn size, where sigma is 16.7 um.
TEST_CASE("tolerances: a response with a kink within a standard deviation is called rough") {
    Folder folder;
    ToleranceOptions options;
    options.samples = 200;
    const ToleranceReport report = study(folder.read(R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
            "parameters": [{"name": "a", "value": 27.645, "lower": 20, "upper": 30}],
            "objective": [{"type": "expression", "expression": "a / 1 mm"}],
            "constraints": [{"type": "relation", "name": "kink", "expression": "a + 10 * max(a - 27.65 mm, 0 mm)", "upper": "28 mm"}],
            "tolerances": {"a": "+-0.05 mm"}})json"),
                                         options);
    CHECK_FALSE(report.responses[0].is_rough);
    CHECK(report.responses[0].sampled->unexplained < 1e-9);
    const Response& kink = report.responses[1];
    CHECK(kink.is_rough);
    CHECK(kink.second_order->standard_deviation > 0);
    CHECK(kink.sampled->unexplained > much_unexplained);
    REQUIRE(report.switched.size() == 1);
    CHECK(report.switched.front().responses == std::vector<int>{1});
    CHECK(report.switched.front().changes.empty());  // it is no contact's
}

TEST_CASE("tolerances: samples of the clutch agree with the second order, and are the same for any number of threads") {
    Folder folder;
    ToleranceOptions options;
    options.samples = 512;
    const auto file = folder.read(clutch);
    const ToleranceReport report = study(file, options);
    const Response& angle = report.responses[1];
    REQUIRE(angle.sampled);
    CHECK(report.samples.size() == 512);
    CHECK(failures(report).empty());
    const tolerances::SampleMoments& sampled = angle.sampled->moments;
    CHECK(std::abs(sampled.moments.mean - angle.second_order->mean) < 3 * sampled.mean_error);
    CHECK(std::abs(sampled.moments.standard_deviation - angle.second_order->standard_deviation) < 3 * sampled.standard_deviation_error);
    CHECK(angle.sampled->unexplained < 0.01);
    CHECK(angle.sampled->met == report.met_all);
    CHECK(static_cast<double>(report.met_all) / 512 == Approx(angle.second_order_yield->within).margin(0.02));
    options.samples = 40;
    const ToleranceReport fewer = study(file, options);
    CHECK(fewer.responses[1].sampled->least >= angle.sampled->least);  // the first of the same samples
    CHECK(description::DeviationSamples(file->tolerances, 1).at(7) != description::DeviationSamples(file->tolerances, 2).at(7));
}

TEST_CASE("tolerances of a parameter, a variable of the scene, and a place of it") {
    Folder folder;
    const auto file =
        folder.read_block(R"({"depth": "+-0.3 mm", "length": "h10", "/bodies/block/shape/dimensions/size_z": {"general": "m"}})");
    const ToleranceReport report = study(file);
    REQUIRE(file->tolerances.size() == 3);
    const Response& mass = report.responses[1];
    // 10 g/mm of each side's 10 mm: 0.1 g/mm.
    for (int k = 0; k < 3; ++k) {
        INFO(file->tolerances[k].of << " " << file->tolerances[k].stated);
        CHECK(mass.gradient[k] == Approx(0.1).epsilon(1e-9));  // kg/m
    }
    CHECK(mass.nominal == Approx(1e-3));
    const auto deviation_of = [&](const std::string& of) {
        for (const description::Tolerance& tolerance : file->tolerances)
            if (tolerance.of == of) return tolerance.deviation;
        FAIL(of);
        return tolerances::Distribution();
    };
    CHECK(deviation_of("depth").upper == Approx(0.3e-3));
    CHECK(deviation_of("length").lower == Approx(-58e-6));
    CHECK(deviation_of("length").upper == 0);
    CHECK(deviation_of("/bodies/block/shape/dimensions/size_z").lower == Approx(-0.2e-3));
    CHECK(mass.worst.most - mass.worst.least == Approx(0.1 * (0.6e-3 + 58e-6 + 0.4e-3)).epsilon(1e-6));
    // The product of three independent numbers: its second order is exact but for the third.
    REQUIRE(mass.second_order);
    CHECK(mass.second_order->mean == Approx(1e-3 * (1 - 29e-6 / 10e-3)).epsilon(1e-9));
}

TEST_CASE("tolerances: without deviations the design as made is the design, bit for bit") {
    Folder folder;
    const std::string tolerances =
        R"({"depth": "+-0.3 mm", "length": "h10", "/bodies/block/shape/dimensions/size_z": "+-0.1", "/gravity/2": "+-0.1"})";
    const auto made = folder.read_block(tolerances);
    const ToleranceReport report = study(made, {.second_order = false});
    std::string text = made_block;
    const auto drawn = reading::parse_design(text.replace(text.find("TOLERANCES"), 10, tolerances), folder.file("x.design.json"));
    REQUIRE(drawn);
    CHECK(drawn->tolerances.empty());
    CHECK(count_of(drawn->design.parameters) == 1);
    const auto problem = problem::DesignProblem::create(drawn->design);
    REQUIRE(problem);
    const problem::DesignEvaluation at = problem->evaluate(description::values_of(problem->design().parameters));
    REQUIRE(at.usable);
    CHECK(report.responses[0].nominal == at.objective);
    CHECK(report.responses[1].nominal == at.constraints[0].value);
}

TEST_CASE("tolerances: what cannot be made is counted, and told") {
    Folder folder;
    const auto file = folder.read_block(R"({"depth": {"lower": -15, "upper": 15, "distribution": "uniform"}})");
    ToleranceOptions options;
    options.samples = 64;
    const ToleranceReport report = study(file, options);
    CHECK(report.samples.size() == 64);
    const std::vector<MadeSample> failed = failures(report);
    CHECK(failed.size() > 5);  // a sixth has no depth
    CHECK(failed.size() < 20);
    CHECK(report.met_all + count_of(failed) <= 64);
    CHECK_FALSE(failed.front().reason.empty());
    CHECK(failed.front().deviations[0] <= -10e-3);
}

TEST_CASE("tolerances: parts of one print vary together") {
    Folder folder;
    const auto file = folder.read_block(R"({"depth": {"lower": -0.3, "upper": 0.3, "group": "print", "correlation": 0.64},
        "length": {"lower": -0.3, "upper": 0.3, "group": "print", "correlation": -1}, "/bodies/block/shape/dimensions/size_z": "+-0.3"})");
    ToleranceOptions options;
    options.samples = 4096;
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    // Sampled deviations: sigma 0.1 mm each, correlations -0.8, 0, 0.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    const description::DeviationSamples samples(file->tolerances, 1);
    for (int k = 0; k < options.samples; ++k) {
        const VectorX d = samples.at(k);
        covariance += d * d.transpose() / options.samples;
    }
    const auto index_of = [&](const std::string& of) {
        int k = 0;
        while (file->tolerances[k].of != of) ++k;
        return k;
    };
    const int depth = index_of("depth"), length = index_of("length"), size = 3 - depth - length;
    for (int k = 0; k < 3; ++k) CHECK(covariance(k, k) == Approx(1e-8).epsilon(0.01));
    CHECK(covariance(depth, length) == Approx(-0.8e-8).epsilon(0.02));
    CHECK(covariance(depth, size) == Approx(0).margin(0.02e-8));
    // Mass: 0.1 g/mm of each; variance (0.01 g)^2 (3 - 2 * 0.8).
    options.samples = 0;
    const ToleranceReport report = study(file, options);
    const Response& mass = report.responses[1];
    CHECK(mass.linear.standard_deviation == Approx(1e-5 * std::sqrt(1.4)).epsilon(1e-6));
    REQUIRE(mass.contributions.size() == 4);
    double shares = 0;
    for (const Contribution& c : mass.contributions) shares += c.share;
    CHECK(shares == Approx(1));
    REQUIRE(mass.second_order);
    CHECK(mass.second_order->mean == Approx(1e-3 - 0.8e-8 * 10).epsilon(1e-6));  // E[dl dd] times 10 g/cm^2
    CHECK(mass.second_order->standard_deviation == Approx(mass.linear.standard_deviation).epsilon(1e-3));
}

TEST_CASE("tolerances: what to tighten, and what may be wider") {
    Folder folder;
    // Mass 1 g at most 1.02 g: Cpk 1 needs a sigma of 0.02 g / 3.
    const auto file =
        folder.read_block(R"({"depth": "+-0.3 mm", "length": "+-0.1 mm", "/bodies/block/shape/dimensions/size_z": "+-0.01 mm"})");
    ToleranceReport report = study(file);
    const std::vector<Tightening> tighten = what_to_tighten(report);
    REQUIRE(tighten.size() == 1);
    CHECK(tighten[0].response == 1);
    CHECK(tighten[0].needed == Approx(0.02e-3 / 3).epsilon(1e-6));
    REQUIRE(tighten[0].tolerance);
    CHECK(file->tolerances[*tighten[0].tolerance].of == "depth");
    // 0.1 g/mm: the others leave sqrt(0.2^2 - 0.1^2 - 0.01^2) mm of depth's 0.3 mm.
    CHECK(tighten[0].factor == Approx(std::sqrt(0.04 - 0.01 - 0.0001) / 0.3).epsilon(1e-3));
    REQUIRE(what_may_be_loosened(report, file->tolerances).size() == 1);
    CHECK(file->tolerances[what_may_be_loosened(report, file->tolerances)[0]].of == "/bodies/block/shape/dimensions/size_z");
    report.responses[1].bounds.upper = 0.9e-3;
    CHECK(what_to_tighten(report)[0].needed < 0);
    report.responses[1].bounds.upper = 1.2e-3;
    CHECK(what_to_tighten(report).empty());
}

TEST_CASE("tolerances of variables that are set, that follow from others, and of the design's own") {
    Folder folder;
    // 12 mm (20 mm in the scenario `long`) by 10 mm by 8 mm + twice the length; h10 is of 12 mm.
    const auto study_of = [&](const std::string& scenario) {
        return folder.read(R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
            "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}], "variables": {"room": "depth - 2 mm"},
            "set": {"/variables/length": "12 mm", "/bodies/block/shape/dimensions/size_y": "= depth",
                    "/bodies/block/shape/dimensions/size_z": "= room + twice"},
            "scenarios": [{"name": "short"}, {"name": "long", "set": {"/variables/length": "= depth + 10 mm"}}],
            "objective": [{"type": "mass", "bodies": ["block"], "scenario": ")json" +
                           scenario + R"json("}],
            "tolerances": {"length": "h10", "twice": "+-0.1 mm", "room": {"class": "js9"}, "depth": "+-1"}})json");
    };
    const auto gradient_of = [](const Result<reading::DesignFile>& file) {
        ToleranceOptions options;
        options.second_order = false;
        std::map<std::string, double> out;
        const ToleranceReport report = study(file, options);
        for (int k = 0; k < count_of(file->tolerances); ++k)
            out[file->tolerances[k].of] = 1e-3 * report.responses[0].gradient[k];  // of grams
        return out;
    };
    const auto file = study_of("short");
    std::map<std::string, double> slopes = gradient_of(file);
    CHECK(slopes["length"] == Approx(0.32 * 1e3 * 1e-3 + 0.24).epsilon(1e-9));  // kg/m: 10 * 32 + 12 * 10 * 2 mm^2 of 1 g/cm^3
    CHECK(slopes["twice"] == Approx(0.12).epsilon(1e-9));
    CHECK(slopes["room"] == Approx(0.12).epsilon(1e-9));
    CHECK(slopes["depth"] == Approx(12e-3 * 32e-3 * 1e3 + 0.12).epsilon(1e-9));
    for (const description::Tolerance& tolerance : file->tolerances) {
        if (tolerance.of == "length") CHECK(tolerance.deviation.lower == Approx(-70e-6));
        if (tolerance.of == "room") CHECK(tolerance.deviation.upper == Approx(18e-6));
    }
    slopes = gradient_of(study_of("long"));
    CHECK(slopes["length"] == Approx(0.48 + 0.4).epsilon(1e-9));
    CHECK(slopes["twice"] == Approx(0.2).epsilon(1e-9));
}

TEST_CASE("tolerances: faults name the entry and say what is allowed") {
    Folder folder;
    const auto fault = [&](const std::string& tolerances) {
        const auto file = folder.read_block(tolerances);
        REQUIRE_FALSE(file);
        return file.errors().front().where + ": " + file.errors().front().message;
    };
    CHECK(fault(R"({"dept": "+-0.3 mm"})").find("did you mean `depth`") != std::string::npos);
    CHECK(fault(R"({"/bodies/blok/density": "+-3"})").find("block") != std::string::npos);
    CHECK(fault(R"({"depth": "H99"})").find("#/tolerances/depth") != std::string::npos);
    CHECK(fault(R"({"depth": {"lower": 0.1}})").find("upper") != std::string::npos);
    CHECK(fault(R"({"depth": {"lower": 0.1, "upper": -0.1}})").find("above") != std::string::npos);
    CHECK(fault(R"({"depth": {"class": "H7", "general": "m"}})").find("one of these") != std::string::npos);
    CHECK(fault(R"({"depth": {"lower": -1, "upper": 1, "group": "print", "distribution": "uniform"}})").find("normal") !=
          std::string::npos);
    CHECK(fault(R"({"depth": {"lower": -1, "upper": 1, "correlation": 0.5}})").find("`group`") != std::string::npos);
    CHECK(fault(R"({"depth": {"lower": -1, "upper": 1, "distribution": "truncated", "shift": 5}})").find("within the limits") !=
          std::string::npos);
    CHECK(fault(R"({"/bodies/block/mu": "+-0.1"})").find("leaves this number to its default") != std::string::npos);
    CHECK(fault(R"({"twice": "+-0.1 mm"})").find("nothing of the design follows from the deviation of twice") != std::string::npos);
    CHECK(fault(R"({"depth": "+-1 deg"})").find("length") != std::string::npos);
    CHECK(fault(R"({"depth": {"lower": -1, "upper": 1, "sigma_level": 0}})").find("sigma_level") != std::string::npos);
}

}  // namespace fettle::design::studies::tolerance_study_test
