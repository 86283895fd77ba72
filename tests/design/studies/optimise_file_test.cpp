// SPDX-License-Identifier: MIT
#include "fettle/design/studies/optimise_file.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>

#include "fettle/tests/design/small_problem.hpp"
#include "fettle/tests/support/text.hpp"

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

    // What is written is what was found: read again, it has the same numbers.
    const Result<reading::DesignFile> final = reading::read_design((folder.path / "whole" / "design.final.json").string());
    REQUIRE(final);
    const VectorX values = values_of(final->design.parameters);
    const auto again = problem::DesignProblem::create(final->design)->evaluate(values);
    CHECK(again.objective == whole->outcome.report.best.objective);
}

}  // namespace fettle::design::studies::optimise_file_test
