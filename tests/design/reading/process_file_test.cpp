// SPDX-License-Identifier: MIT
#include "design/reading/process_file.hpp"

#include <catch2/catch.hpp>

#include "design/tolerances/known_processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::reading::process_file_test {

namespace {

using tolerances::FeatureKind;
using tolerances::FeatureSpread;
using tolerances::Process;

constexpr double mm = 1e-3;

// Every fault, a line each.
std::string faults(const std::string& text) {
    std::string told;
    const auto read = parse_process(text, "folder/mine.process.json");
    for (const Error& error : read.errors()) told += error.where + ": " + error.message + "\n";
    return told;
}

std::string with(const std::string& keys) { return R"({"fettle_process": 1, "units": "mm", )" + keys + "}"; }

}  // namespace

TEST_CASE("process files: what they say, and the rest of what they are based on") {
    const auto read = parse_process(with(R"("based_on": "fdm", "correlation": 0.8, "features": {
        "hole": {"bias": -0.1, "bias_per_size": 0.002, "spread": "40 um", "from": 3, "up_to": 8, "source": "coupon of May"},
        "length": {"tolerance": 0.12, "tolerance_per_size": 0.003, "per_size_over": 60}})"),
                                    "folder/mine.process.json");
    REQUIRE(read);
    CHECK(read->name == "mine");
    CHECK(read->correlation == 0.8);
    const FeatureSpread& hole = *find_feature(*read, FeatureKind::hole);
    CHECK(hole.bias == Approx(-0.1 * mm));
    CHECK(hole.bias_per_size == 0.002);
    CHECK(hole.tolerance == Approx(0.12 * mm));
    CHECK(hole.from == Approx(3 * mm));
    CHECK(hole.up_to == Approx(8 * mm));
    CHECK(hole.source == "coupon of May");
    CHECK(find_feature(*read, FeatureKind::length)->per_size_over == Approx(60 * mm));
    CHECK(find_feature(*read, FeatureKind::pin)->tolerance == Approx(0.3 * mm));  // of fdm
    REQUIRE(read->clearance);
    CHECK(read->clearance->minimum == Approx(0.2 * mm));
    CHECK(read->clearance->bands.empty());  // lengths of its own
    const auto alone =
        parse_process(with(R"("features": {"wall": {"general": "f"}}, "minimum_gap": 0.15, "part_tolerance": "0.05 mm")"), "x");
    REQUIRE(alone);
    CHECK(find_feature(*alone, FeatureKind::hole) == nullptr);
    CHECK(find_feature(*alone, FeatureKind::wall)->general_class == "f");
    CHECK(alone->clearance->bands.at(0).tolerance == Approx(0.05 * mm));
    CHECK(parse_process(with(R"("based_on": "sls")"), "x")->correlation == 0.5);
}

TEST_CASE("process files: faults, each with its place and remedy") {
    CHECK(faults("{") != "");
    CHECK(faults(R"({"units": "mm"})").find("fettle_process") != std::string::npos);
    CHECK(faults(R"({"fettle_process": 1})").find("units") != std::string::npos);
    CHECK(faults(with(R"("description": "")")) == "folder/mine.process.json#: a process has `features`, or is `based_on` one that has\n");
    CHECK(faults(with(R"("based_on": "fdn")")).find("did you mean `fdm`?") != std::string::npos);
    CHECK(faults(with(R"("features": {"bore": {"spread": 0.1}})")).find("#/features") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"bias": 0.1}})"))
              .find("#/features/hole: a feature has a `spread` (one standard deviation), a `tolerance`") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"spread": 0.1, "tolerance": 0.3}})")).find("one of these") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"spread": -0.1}})")).find("#/features/hole/spread") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"spread": 0.1, "from": 8, "up_to": 3}})")).find("`from` is above") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"general": "m", "tolerance_per_size": 0.1}})")).find("of its own") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"spread": 0.1, "per_size_over": 3}})")).find("goes with") != std::string::npos);
    CHECK(faults(with(R"("features": {"hole": {"spread": 0.1}}, "part_tolerance": 0.1)")).find("minimum_gap") != std::string::npos);
    CHECK(faults(with(R"("based_on": "fdm", "correlation": 1.5)")).find("#/correlation") != std::string::npos);
    CHECK(faults(with(R"("based_on": "fdm", "features": [])")) != "");
}

TEST_CASE("process files: found by name or file, in the folder") {
    const tests::support::TemporaryFolder folder;
    folder.write("mine.process.json", with(R"("based_on": "sla")"));
    folder.write("broken.process.json", with(R"("based_on": "slo")"));
    const auto find = [&](const std::string& name) { return find_process(name, folder.path.string(), "where"); };
    CHECK(find("fdm")->name == "fdm");
    CHECK(find("mine")->name == "mine");
    CHECK(find("mine.process.json")->correlation == 0.5);
    CHECK(find_process(folder.file("mine.process.json"), "", "")->name == "mine");
    CHECK(find_process(folder.file("mine"), "", "")->name == "mine");
    const Error none = find("mien").errors()[0];
    CHECK(none.where == "where");
    CHECK(none.message.find("did you mean \"mine\"?") != std::string::npos);
    CHECK(find("other.process.json").errors()[0].code == ErrorCode::file_not_found);
    CHECK(find("broken").errors()[0].where == folder.file("broken.process.json") + "#/based_on");
    CHECK(!find(""));
}

TEST_CASE("process files: a fit is written, and read back as the process that it is") {
    std::vector<tolerances::MeasuredFeature> features;
    const double off[] = {-0.21, -0.18, -0.19, -0.15, -0.16, -0.12};
    for (int i = 0; i < 6; ++i) features.push_back({"h", FeatureKind::hole, (3 + i) * mm, {(3 + i + off[i]) * mm}});
    for (int i = 0; i < 4; ++i) features.push_back({"w", FeatureKind::wall, (1 + i) * mm, {(1.1 + i) * mm}});  // no spread is seen
    for (int i = 0; i < 3; ++i) features.push_back({"p", FeatureKind::pin, (3 + i) * mm, {(3.05 + i + 0.01 * (i % 2)) * mm}});
    const auto fit = fit_process(features, "");
    REQUIRE(fit);
    const Process fitted = fitted_process(*fit, "mine", *tolerances::find_known_process("fdm"));
    const auto read = parse_process(process_text(*fit, fitted, "fdm"), "mine.process.json");
    for (const Error& error : read.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(read);
    CHECK(read->name == fitted.name);
    CHECK(read->correlation == fitted.correlation);
    REQUIRE(read->features.size() == fitted.features.size());
    for (const FeatureKind kind : {FeatureKind::hole, FeatureKind::pin, FeatureKind::wall}) {
        for (const double size : {2.0, 4.0, 7.5, 20.0, 150.0}) {
            const auto a = process_deviation(fitted, kind, size * mm, ""), b = process_deviation(*read, kind, size * mm, "");
            CHECK(a->limits.lower == Approx(b->limits.lower).margin(5e-9));  // rounded to the nanometre
            CHECK(a->limits.upper == Approx(b->limits.upper).margin(5e-9));
            CHECK(a->is_sure_size == b->is_sure_size);
        }
    }
}

TEST_CASE("process files: names that another folder's files use") {
    CHECK(process_name_from("fdm", "/a/b", "/a/c") == "fdm");
    CHECK(process_name_from("mine", "/a/b", "/a/b/out") == "../mine.process.json");
    CHECK(process_name_from("p/mine.process.json", "/a/b", "/a") == "b/p/mine.process.json");
}

}  // namespace fettle::design::reading::process_file_test
