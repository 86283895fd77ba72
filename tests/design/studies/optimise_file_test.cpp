// SPDX-License-Identifier: MIT
#include "design/studies/optimise_file.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "design/reading/design_text.hpp"
#include "tests/design/small_problem.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::studies::optimise_file_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;
using fettle::tests::support::contents;

}  // namespace

TEST_CASE("a simulated design, killed and resumed, ends the same, bit for bit", "[slow]") {
    const DesignFolder folder;
    const reading::DesignFile file = file_of(folder);
    const auto created = problem::DesignProblem::create(file.design);
    REQUIRE(created);
    const problem::DesignProblem& problem = *created;
    RunFolder run{(folder.path / "whole").string(), false};
    const Result<FileOutcome> whole = optimise_file(file, problem, run, {});
    REQUIRE(whole);
    REQUIRE(whole->outcome.report.evaluations > 4);

    run.directory = (folder.path / "killed").string();
    std::filesystem::create_directories(run.directory);
    const std::string history = contents(folder.path / "whole" / "history.jsonl");
    size_t cut = 0;
    for (int line = 0; line < 4; ++line) cut = history.find('\n', cut) + 1;
    std::ofstream(std::filesystem::path(run.directory) / "history.jsonl", std::ios::binary) << history.substr(0, cut + 57);
    run.resume = true;
    const Result<FileOutcome> resumed = optimise_file(file, problem, run, {});
    REQUIRE(resumed);
    CHECK(resumed->outcome.replayed == 3);
    CHECK(resumed->outcome.report.evaluations == whole->outcome.report.evaluations);
    CHECK(std::memcmp(resumed->outcome.report.point.data(), whole->outcome.report.point.data(), 5 * sizeof(double)) == 0);
    CHECK(contents(folder.path / "killed" / "design.final.json") == contents(folder.path / "whole" / "design.final.json"));
    CHECK(contents(folder.path / "killed" / "trajectory.json") == contents(folder.path / "whole" / "trajectory.json"));

    // The file has the design that was found: read again, it has the same numbers.
    const Result<reading::DesignFile> final = reading::read_design((folder.path / "whole" / "design.final.json").string());
    REQUIRE(final);
    const VectorX values = values_of(final->design.parameters);
    const auto again = problem::DesignProblem::create(final->design)->evaluate(values);
    CHECK(again.objective == whole->outcome.report.best.objective);
}

TEST_CASE("whatever a history says, the status is that of the design as it is now", "[design]") {
    const DesignFolder folder(replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 3"));
    const reading::DesignFile file = file_of(folder);
    const problem::DesignProblem problem = problem_of(folder);
    RunFolder run{(folder.path / "out").string(), false};
    const Result<FileOutcome> first = optimise_file(file, problem, run, {});
    REQUIRE(first);
    REQUIRE(first->outcome.report.feasible);
    run.resume = true;
    const Result<FileOutcome> again = optimise_file(file, problem, run, {});
    REQUIRE(again);
    CHECK(again->outcome.replayed == again->outcome.report.evaluations);
    CHECK(again->outcome.report.status == first->outcome.report.status);
    CHECK(again->outcome.report.message == first->outcome.report.message);

    // The cube has become heavier than it may be, which nothing has told the history of.
    const DesignFolder changed(replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 3"),
                               replaced(small_scene, "\"size_y\": 12", "\"size_y\": 28"));
    const Result<FileOutcome> stale = optimise_file(file, problem_of(changed), run, {});
    REQUIRE(stale);
    const OptimiseOutcome& outcome = stale->outcome;
    CHECK(outcome.replayed == outcome.report.evaluations);
    CHECK(outcome.report.status == optimisers::OptimiserStatus::infeasible);
    CHECK_FALSE(outcome.report.feasible);
    CHECK(outcome.report.violation == outcome.final.violation);
    CHECK(outcome.final.violation > 0);
    CHECK(outcome.report.message.find("history") != std::string::npos);
    CHECK_FALSE(outcome.limits.empty());
}

TEST_CASE("a history is not gone on with once a process was measured anew", "[design]") {
    const DesignFolder folder(
        replaced(small_design, R"("optimiser":)", R"("tolerances": {"height": {"feature": "length", "process": "mine"}}, "optimiser":)"));
    const auto measured = [&](const char* bias) {
        folder.write("mine.process.json", std::string(R"({"fettle_process": 1, "units": "mm", "features": {"length": {"bias": )") + bias +
                                              R"(, "spread": 0.05}}})");
    };
    measured("0");
    const std::string out = (folder.path / "out").string();
    REQUIRE(History::open(out, {reading::design_hash(file_of(folder)), {}, {}}, LineFileMode::resume));
    REQUIRE(History::open(out, {reading::design_hash(file_of(folder)), {}, {}}, LineFileMode::resume));
    measured("-0.3");
    const Result<History> stale = History::open(out, {reading::design_hash(file_of(folder)), {}, {}}, LineFileMode::resume);
    REQUIRE_FALSE(stale);
    CHECK(stale.errors().at(0).code == ErrorCode::inconsistent);
}

TEST_CASE("a design that was found has the settings of the one that the search began with", "[design]") {
    const DesignFolder folder;
    const reading::DesignFile file = file_of(folder);
    const problem::DesignProblem first = problem_of(folder);
    VectorX found = values_of(file.design.parameters);
    found[0] *= 1.2;
    found[3] *= 0.6;  // what decides about the stiffness of contact: the cube's weight
    std::filesystem::create_directories(folder.path / "out");
    const std::string path = (folder.path / "out" / "design.final.json").string();
    std::ofstream(path) << reading::design_text(file, found, (folder.path / "out").string());

    const auto read = reading::read_design(path);
    REQUIRE(read);
    CHECK(values_of(read->design.parameters) == found);
    CHECK(description::references_of(read->design.parameters) == values_of(file.design.parameters));
    const auto again = problem::DesignProblem::create(read->design);
    REQUIRE(again);
    CHECK(again->kappa() == first.kappa());
    CHECK(again->evaluate(found).objective == first.evaluate(found).objective);

    // Written again, it keeps them; without them, it has others.
    const std::string second = reading::design_text(*read, values_of(file.design.parameters), (folder.path / "out").string());
    CHECK(second.find("\"reference\": 1000") != std::string::npos);
    auto json = nlohmann::json::parse(contents(path));
    for (auto& parameter : json["parameters"]) parameter.erase("reference");
    std::ofstream(path) << json;
    CHECK(problem::DesignProblem::create(reading::read_design(path)->design)->kappa() != first.kappa());
}

TEST_CASE("the parts of a design that was found have the facets that they had in the search", "[design]") {
    // A post whose facets are chosen by how far they may be from the round: more of them, the larger it is.
    const std::string box = R"("shape": { "part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 } })";
    const std::string post = R"("shape": { "part": "cylinder", "facets": 0.05, "dimensions": { "radius": 8, "length": 10 } })";
    const DesignFolder folder(
        replaced(replaced(small_design, "dimensions/size_z", "dimensions/length"), "dimensions/size_x", "dimensions/radius"),
        replaced(small_scene, box, post));
    const reading::DesignFile file = file_of(folder);
    const problem::DesignProblem first = problem_of(folder);
    VectorX found = values_of(file.design.parameters);
    found[1] = 29e-3;
    const std::string path = (folder.path / "found.design.json").string();
    std::ofstream(path) << reading::design_text(file, found, folder.path.string());
    const auto facets = [&] { return problem::DesignProblem::create(reading::read_design(path)->design)->model_at(found)->bodies[1].mesh; };
    const core::geometry::Mesh in_search = first.model_at(found)->bodies[1].mesh;
    CHECK(facets().vertices == in_search.vertices);
    CHECK(facets().triangles == in_search.triangles);

    auto json = nlohmann::json::parse(contents(path));
    for (auto& parameter : json["parameters"]) parameter.erase("reference");
    std::ofstream(path) << json;
    CHECK(facets().vertices.cols() > in_search.vertices.cols());
}

}  // namespace fettle::design::studies::optimise_file_test
