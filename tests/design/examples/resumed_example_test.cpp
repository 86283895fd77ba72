// SPDX-License-Identifier: MIT
// A run that is killed in any of its stages, or between them, or while it judges its end, ends as it does undisturbed.
#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <sstream>

#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::examples::resumed_example_test {

namespace {

using fettle::tests::support::contents;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::stringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
    return lines;
}

}  // namespace

TEST_CASE("killed in any stage and resumed, the four-bar linkage's tuning ends the same, bit for bit", "[slow]") {
    const tests::support::TemporaryFolder folder;
    const auto file = reading::read_design("examples/four_bar/four_bar.design.json");
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    const std::filesystem::path whole = folder.file("whole");
    const auto undisturbed = studies::optimise_file(*file, *problem, {whole.string(), false}, {});
    REQUIRE(undisturbed);
    const std::vector<std::string> history = lines_of(contents(whole / "history.jsonl"));
    REQUIRE(history.size() == static_cast<size_t>(undisturbed->outcome.report.evaluations) + 1);

    // After the start alone; the first and the last evaluation of each stage; in the verdict, which comes last.
    std::set<size_t> cuts{2, history.size() - 2, history.size() - 4};
    size_t end = 2;
    for (const auto& stage : undisturbed->outcome.report.stages) {
        cuts.insert(end + 1);
        end += static_cast<size_t>(stage.evaluations);
        cuts.insert(std::min(end, history.size() - 1));
    }
    CHECK(undisturbed->outcome.report.stages.size() >= 2);
    for (const size_t cut : cuts) {
        CAPTURE(cut, history.size());
        const std::filesystem::path killed = folder.file("killed-" + std::to_string(cut));
        std::filesystem::create_directories(killed);
        std::string kept;
        for (size_t k = 0; k < cut; ++k) kept += history[k];
        std::ofstream(killed / "history.jsonl", std::ios::binary) << kept << history[cut].substr(0, history[cut].size() / 2);
        const auto resumed = studies::optimise_file(*file, *problem, {killed.string(), true}, {});
        REQUIRE(resumed);
        CHECK(resumed->outcome.replayed == static_cast<int>(cut) - 1);
        for (const char* name : {"design.final.json", "trajectory.json"}) CHECK(contents(killed / name) == contents(whole / name));
    }
}

}  // namespace fettle::design::examples::resumed_example_test
