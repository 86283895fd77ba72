// SPDX-License-Identifier: MIT
#include "design/studies/exploration.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <map>

#include "core/base/parallel.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/design/small_problem.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::studies::exploration_test {

namespace {

using fettle::tests::design_support::DesignFolder;
using fettle::tests::design_support::problem_of;
using fettle::tests::support::TemporaryFolder;

problem::DesignProblem small_problem() { return problem_of(DesignFolder()); }

std::vector<description::Parameter> two_lengths() {
    description::Parameter a{"width", 9e-3, 5e-3, 15e-3, *core::base::find_unit("mm")}, b{"share", 0.5, 0, 1};
    return {a, b};
}

ErrorCode fault_of(const std::string& sweep) {
    const Result<SweptParameter> parsed = parse_sweep(sweep, two_lengths());
    REQUIRE_FALSE(parsed);
    CHECK(parsed.errors().front().where == "--sweep " + sweep);
    return parsed.errors().front().code;
}

// Objectives by job, whatever order they came in.
std::map<std::string, nlohmann::ordered_json> by_key(const Exploration& found) {
    std::map<std::string, nlohmann::ordered_json> results;
    for (nlohmann::ordered_json result : found.results) {
        result.erase("seconds");
        results[result["key"].get<std::string>()] = result;
    }
    return results;
}

}  // namespace

TEST_CASE("exploration: a sweep is a count between the bounds, or values in the parameter's unit") {
    CHECK(parse_sweep("width=3", two_lengths())->count == 3);
    const SweptParameter swept = parse_sweep("width=6:10:3", two_lengths()).value();
    REQUIRE(swept.values.size() == 3);
    CHECK(swept.values[0] == 6e-3);
    CHECK(swept.values[1] == Approx(8e-3));
    CHECK(swept.values[2] == 10e-3);
    CHECK(parse_sweep("width=6:900:1", two_lengths())->values == VectorX::Constant(1, 6e-3));
    for (const char* sweep : {"width", "=3", "width=", "width=x", "width=2.5", "width=1:2", "width=1mm:2mm:3", "width=1:2:3:4"})
        CHECK(fault_of(sweep) == ErrorCode::parse);
    for (const char* sweep : {"width=0", "width=-3", "width=6:10:0", "width=6:900:3", "width=9999999999", "share=-20:1:2"})
        CHECK(fault_of(sweep) == ErrorCode::out_of_range);
    for (const char* sweep : {"width=nan:10:2", "width=6:inf:2"}) CHECK(fault_of(sweep) == ErrorCode::not_finite);
    CHECK(fault_of("widht=3") == ErrorCode::unknown_key);
    CHECK(parse_sweep("widht=3", two_lengths()).errors().front().message.find("did you mean 'width'?") != std::string::npos);
}

TEST_CASE("exploration: every combination, each job once; all that is wrong is told") {
    const problem::DesignProblem problem = small_problem();
    const std::vector<description::Parameter>& parameters = problem.design().parameters;
    REQUIRE(parameters.size() >= 2);
    ExplorationRequest request;
    request.sweep = {{parameters[0].name, 2, {}, "a"}, {parameters[1].name, 3, {}, "b"}};
    request.samples = 2;
    request.starts = 2;
    const std::vector<ExplorationJob> jobs = jobs_of(problem, request).value();
    REQUIRE(jobs.size() == 10);
    CHECK(jobs[0].point[0] == parameters[0].lower);
    CHECK(jobs[1].point[1] == Approx((parameters[1].lower + parameters[1].upper) / 2));
    CHECK(jobs[5].point[0] == parameters[0].upper);
    CHECK(jobs[8].kind == ExplorationJob::Kind::optimise);
    CHECK(jobs[8].seed == 0);
    CHECK(jobs[9].seed == 1001);
    request.sweep[1] = {parameters[1].name, 0, VectorX::Constant(3, parameters[1].value), "b"};  // three times the same
    request.samples = request.starts = 0;
    CHECK(jobs_of(problem, request)->size() == 2);

    CHECK(jobs_of(problem, {}).errors().front().code == ErrorCode::missing_key);
    request.sweep = {{"nobody", 2, {}, "a"}, {parameters[0].name, 0, {}, "b"}, {parameters[0].name, 2, {}, "c"}};
    request.samples = -1;
    request.starts = most_designs + 1;
    std::vector<std::string> places;
    const auto refused = jobs_of(problem, request);
    REQUIRE_FALSE(refused);
    for (const Error& error : refused.errors()) places.push_back(error.where);
    CHECK(places == std::vector<std::string>{"samples", "starts", "a", "b", "c"});
}

TEST_CASE("exploration: results are those of evaluate, for any number of threads, and are not computed again") {
    const TemporaryFolder folder;
    const problem::DesignProblem problem = small_problem();
    const std::vector<ExplorationJob> jobs = jobs_of(problem, {{}, 5, 1, 3}).value();
    const nlohmann::ordered_json header = header_of(problem.design(), "small", "");
    std::map<std::string, nlohmann::ordered_json> first;
    for (const int threads : {1, 4}) {
        const core::base::ThreadLimit limit(threads);
        const std::string path = folder.file(std::to_string(threads) + ".jsonl");
        Result<ExplorationFile> file = ExplorationFile::open(path, header);
        REQUIRE(file);
        int told = 0;
        ExploreOptions options;
        options.on_result = [&](int done, int of, const nlohmann::ordered_json&) {
            CHECK(done == ++told);
            CHECK(of == 6);
        };
        const Explored end = explore(problem, jobs, *file, options);
        CHECK_FALSE(end.interrupted);
        CHECK(end.unwritten.empty());
        CHECK(told == 6);
        if (threads == 1) first = by_key(file->found());
        CHECK(by_key(file->found()) == first);
        CHECK(by_key(read_exploration(path).value()) == first);
    }
    for (const ExplorationJob& job : jobs) {
        if (job.kind != ExplorationJob::Kind::evaluate) continue;
        problem::EvaluateOptions plain;
        plain.gradients = false;
        const problem::DesignEvaluation at = problem.evaluate(job.point, plain);
        REQUIRE(at.usable);
        CHECK(first.at(job.key())["objective"].get<double>() == at.objective);
    }
    Result<ExplorationFile> again = ExplorationFile::open(folder.file("1.jsonl"), header);
    REQUIRE(again);
    ExploreOptions never;
    never.on_result = [](int, int, const nlohmann::ordered_json&) { FAIL("it is there"); };
    CHECK(explore(problem, jobs, *again, never).unwritten.empty());
    CHECK(again->found().results.size() == 6);
}

TEST_CASE("exploration: what was stopped goes on, and leaves no file where it found nothing") {
    const TemporaryFolder folder;
    const problem::DesignProblem problem = small_problem();
    const std::vector<ExplorationJob> jobs = jobs_of(problem, {{}, 4, 0, 1}).value();
    const nlohmann::ordered_json header = header_of(problem.design(), "small", "");
    const std::string path = folder.file("a.jsonl");
    const core::base::ThreadLimit limit(1);
    {
        Result<ExplorationFile> file = ExplorationFile::open(path, header);
        REQUIRE(file);
        CHECK(explore(problem, jobs, *file, {[] { return true; }, {}}).interrupted);
    }
    CHECK_FALSE(std::filesystem::exists(path));
    {
        Result<ExplorationFile> file = ExplorationFile::open(path, header);
        REQUIRE(file);
        CHECK(explore(problem, jobs, *file, {[&] { return file->found().results.size() == 2; }, {}}).interrupted);
        CHECK_FALSE(ExplorationFile::open(path, header));  // in use
    }
    std::ofstream(path, std::ios::app) << R"({"key": "cut o)";  // by a kill
    CHECK(read_exploration(path)->cut_off);
    CHECK(read_exploration(path)->results.size() == 2);
    Result<ExplorationFile> file = ExplorationFile::open(path, header);
    REQUIRE(file);
    CHECK_FALSE(explore(problem, jobs, *file, {}).interrupted);
    CHECK(file->found().results.size() == 4);
    CHECK(read_exploration(path)->results.size() == 4);
    CHECK_FALSE(read_exploration(path)->cut_off);
}

TEST_CASE("exploration: a file of something else is refused and left as it is") {
    const TemporaryFolder folder;
    const problem::DesignProblem problem = small_problem();
    const nlohmann::ordered_json header = header_of(problem.design(), "small", "");
    const std::string path = folder.file("a.jsonl"), head = header.dump() + "\n";
    const auto refused = [&](const std::string& text) {
        std::ofstream(path) << text;
        const Result<ExplorationFile> file = ExplorationFile::open(path, header);
        REQUIRE_FALSE(file);
        CHECK(core::files::read_file(path).value() == text);
        return file.errors().front();
    };
    for (const char* text : {"{\"a\": 1}", "a line\nand more\n", "\xff\xfe", "[[[["}) CHECK(refused(text).code == ErrorCode::parse);
    CHECK(refused(header_of(problem.design(), "other", "").dump() + "\n").code == ErrorCode::inconsistent);
    for (const char* line : {"null", "7", "[]", R"({"status": "feasible"})", R"({"key": "k", "status": 5})", "{broken",
                             R"({"key": "k", "status": "feasible", "objective": "low"})", R"({"key": "k", "status": "x", "terms": [1]})"}) {
        const Error fault = refused(head + line + "\n");
        CHECK(fault.code == ErrorCode::parse);
        CHECK(fault.where == path + ":2");
    }
}

TEST_CASE("exploration: the best are those that meet everything, the least objective first") {
    Exploration found;
    const auto add = [&](double objective, double violation) {
        found.results.push_back({{"objective", objective}, {"violation", violation}});
    };
    add(3, 0);
    add(1, 0.1);
    add(2, 0);
    found.results.push_back({{"objective", nullptr}, {"violation", 0}});
    found.results.push_back({{"status", "unusable"}});
    CHECK(found.best() == std::vector<std::size_t>{2, 0});
}

}  // namespace fettle::design::studies::exploration_test
