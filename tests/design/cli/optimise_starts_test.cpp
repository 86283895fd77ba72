// SPDX-License-Identifier: MIT
// Many starts: which is the best one, and the program from outside.
#include "design/cli/optimise_starts.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::optimise_starts_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;

// An interrupted run from many starts leaves the best design of those that have been tried.
void check_best_so_far(const std::filesystem::path& out) {
    const Json answer = Json::parse(contents(out / "result.json"));
    CHECK(answer.at("status") == "interrupted");
    REQUIRE(answer.at("best_start").is_number());
    CHECK(answer.at("seed") == answer["best_start"]);
    const std::filesystem::path best = out / ("start-" + std::to_string(answer["best_start"].get<int>()));
    const Json of_best = Json::parse(contents(best / "result.json"));
    for (const char* key : {"objective", "constraint_violation", "parameters", "evaluations"}) CHECK(answer.at(key) == of_best.at(key));
    for (const Json& row : answer.at("starts"))
        if (row.value("constraint_violation", Json()) == 0 && of_best["constraint_violation"] == 0)
            CHECK(answer["objective"].get<double>() <= row["objective"].get<double>());
    CHECK(contents(out / "history.jsonl") == contents(best / "history.jsonl"));
    CHECK(contents(out / "trajectory.json") == contents(best / "trajectory.json"));
    const Answer final = run("gradient " + (out / "design.final.json").string() + " --json");
    CHECK(final.code == 0);
    CHECK(final.json().at("objective") == answer["objective"]);
}

StartResult ended(double violation, double objective) {
    StartResult start;
    start.result = {{"constraint_violation", violation}, {"objective", objective}};
    return start;
}

}  // namespace

TEST_CASE("the best start meets the requirements, then is lowest; the first of equals") {
    StartResult failed, unusable;
    failed.status = "failed";
    unusable.result = {{"constraint_violation", nullptr}, {"objective", nullptr}};
    CHECK(!best_run(std::vector<StartResult>{}));
    CHECK(!best_run(std::vector<StartResult>{failed, unusable}));
    CHECK(best_run(std::vector<StartResult>{failed, ended(0.5, 1), ended(0.2, 9), unusable}) == 2);
    CHECK(best_run(std::vector<StartResult>{ended(0.5, 1), ended(0, 9), ended(0, 8), ended(0, 8)}) == 2);
    CHECK(best_run(std::vector<StartResult>{ended(0, 3), ended(1e-9, 2)}) == 0);
    // With --repair the least change, not the least objective.
    StartResult near = ended(0, 9), far = ended(0, 1);
    near.result["repair"] = {{"distance", 0.1}};
    far.result["repair"] = {{"distance", 0.2}};
    CHECK(best_run(std::vector<StartResult>{far, near}) == 1);
}

TEST_CASE("the share of random starts that reach the best is told with its interval") {
    const auto random = [](std::uint64_t seed, double violation, double objective) {
        StartResult start = ended(violation, objective);
        start.seed = seed;
        start.status = "optimal";
        start.result["evaluations"] = 3;
        start.result["limited_by"] = Json::array();
        return start;
    };
    StartResult failed, waiting;
    failed.seed = 1004;
    failed.status = "failed";
    waiting.seed = 1005;
    waiting.status = "not run";
    const std::vector<StartResult> starts{random(0, 0, 1), random(1001, 0, 1.0009), random(1002, 0, 1.0011), random(1003, 0.1, 0.9), failed,
                                          waiting};
    const auto reached = best_reached(starts);
    REQUIRE(reached);
    CHECK(reached->starts == 1);
    CHECK(reached->of == 4);
    // 1 of 4: (1 - p)^4 = 0.975, and the p at which at most one of four has 0.025.
    CHECK(reached->least == Approx(1 - std::pow(0.975, 0.25)));
    const double p = reached->most;
    CHECK(std::pow(1 - p, 4) + 4 * p * std::pow(1 - p, 3) == Approx(0.025));
    CHECK(starts_text(starts).find("1 of 4 random starts reach the best within 0.1%") != std::string::npos);
    CHECK(best_reached_json(starts).at("of") == 4);
    CHECK(!best_reached({random(1001, 0.1, 1)}));  // none meets every requirement
    CHECK(!best_reached({random(0, 0, 1)}));       // none is random
    CHECK(best_reached_json({}).is_null());
}

TEST_CASE("a start's line tells what holds a design that meets its requirements, and by how much another fails") {
    StartResult met = ended(0, 1), violated = ended(0.25, 2);
    met.result["evaluations"] = violated.result["evaluations"] = 3;
    met.result["limited_by"] = {"mass", "width (upper bound)"};
    violated.result["limited_by"] = {"width is at its upper bound; more of it would help"};
    const std::string good = starts_text({met}), bad = starts_text({violated});
    CHECK(good.find("held by mass; width (upper bound)") != std::string::npos);
    CHECK(bad.find("held by") == std::string::npos);
    CHECK(bad.find("largest violation 0.25") != std::string::npos);
    StartResult stopped = ended(0, 0);
    stopped.result = {{"constraint_violation", nullptr}, {"objective", nullptr}, {"evaluations", 0}};
    stopped.message = "stopped as asked after 0 evaluations";
    const std::string none = starts_text({stopped});
    CHECK(none.find("nan") == std::string::npos);
    CHECK(none.find("stopped as asked after 0 evaluations") != std::string::npos);
}

TEST_CASE("--starts: seeds that are too large are refused") {
    const DesignFolder folder;
    CHECK(run("optimise " + folder.design() + " --starts 2 --seed 2000001 --out " + (folder.path / "x").string()).code == 3);
    CHECK(run("optimise " + folder.design() + " --starts 0").code == 3);
}

TEST_CASE("many starts: a table, the best one kept, each run as it is alone") {
    const DesignFolder folder;
    const std::filesystem::path out = folder.path / "many";
    const Answer many = run("optimise " + folder.design() + " --starts 3 --seed 5 --json --out " + out.string());
    const Json answer = many.json();
    REQUIRE(answer.at("starts").size() == 3);
    double best = 1e300;
    for (const Json& row : answer["starts"]) {
        for (const char* key : {"seed", "status", "objective", "evaluations", "limited_by", "parameters_start", "parameters", "out"})
            CHECK(row.contains(key));
        if (row["constraint_violation"] == 0) best = std::min(best, row["objective"].get<double>());
    }
    CHECK(answer["starts"][0]["seed"] == 0);
    CHECK(answer["starts"][2]["seed"] == 5002);
    CHECK(answer["objective"] == best);
    CHECK(answer["replayed_evaluations"] == answer["evaluations"]);
    const std::filesystem::path kept = out / ("start-" + std::to_string(answer["seed"].get<int>()));
    CHECK(contents(out / "history.jsonl") == contents(kept / "history.jsonl"));
    CHECK(contents(out / "trajectory.json") == contents(kept / "trajectory.json"));

    // A row is what its seed gives alone.
    const std::filesystem::path alone = out / "start-alone";
    run("optimise " + folder.design() + " --seed 5002 --threads 2 --out " + alone.string());
    CHECK(contents(alone / "design.final.json") == contents(out / "start-5002" / "design.final.json"));
    CHECK(Json::parse(contents(alone / "result.json"))["parameters_start"] == answer["starts"][2]["parameters_start"]);

    const Json again = run("optimise " + folder.design() + " --starts 3 --seed 5 --resume --json --out " + out.string()).json();
    CHECK(again["parameters"] == answer["parameters"]);
    CHECK(again["starts"][1]["objective"] == answer["starts"][1]["objective"]);
    CHECK(!std::filesystem::exists(out / "history.1.jsonl"));
}

TEST_CASE("--starts: a link where a log goes is not followed, and runs that leave no result are told") {
    const DesignFolder folder;
    const std::string kept = folder.write("kept.txt", "mine"), out = folder.file("many");
    std::filesystem::create_directories(out + "/start-0");
    std::filesystem::create_symlink(kept, out + "/start-0/log.txt");
    const std::string quick = replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 1");
    folder.write("quick.design.json", quick);
    CHECK(run("optimise " + folder.file("quick.design.json") + " --starts 1 --no-report --out " + out).code <= 2);
    CHECK(contents(kept) == "mine");
    CHECK_FALSE(std::filesystem::is_symlink(out + "/start-0/log.txt"));

    const std::string theirs = folder.write("theirs/start-0/result.json", R"({"my": "numbers"})");
    const Answer left =
        run("optimise " + folder.file("quick.design.json") + " --starts 1 --no-report --json --out " + folder.file("theirs"));
    CHECK(left.code == 3);
    CHECK(left.json().at("message").get<std::string>().find("was not written by fettle") != std::string::npos);
    CHECK(contents(theirs) == R"({"my": "numbers"})");

    const std::string none = folder.file("none");
    folder.write("none/start-0", "a file where a folder is expected");
    const Answer failed = run("optimise " + folder.file("quick.design.json") + " --starts 1 --no-report --json --out " + none);
    CHECK(failed.code == 3);
    CHECK(failed.json().at("starts").at(0).at("status") == "failed");
    CHECK(failed.json().at("message").get<std::string>().find("cannot be written") != std::string::npos);
}

TEST_CASE("many starts, killed and resumed, end as they do undisturbed; so do they when they are asked to stop") {
    const DesignFolder folder;
    const std::string whole = (folder.path / "whole").string(), cut = (folder.path / "cut").string();
    const std::string arguments = "optimise " + folder.design() + " --starts 3 --seed 5 --json --out ";
    const Json undisturbed = run(arguments + whole).json();
    for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
        CAPTURE(signal);
        std::filesystem::remove_all(cut);
        const pid_t process = fork();
        if (process == 0) {
            const std::string program = FETTLE_PROGRAM, design = folder.design();
            const std::string log = (folder.path / "log").string();
            if (!freopen(log.c_str(), "w", stdout) || !freopen(log.c_str(), "a", stderr)) _exit(127);
            execl(program.c_str(), "fettle", "optimise", design.c_str(), "--starts", "3", "--seed", "5", "--out", cut.c_str(), nullptr);
            _exit(127);
        }
        REQUIRE(process > 0);
        // In the middle: two runs have begun, and have something behind them.
        const std::filesystem::path history = std::filesystem::path(cut) / "start-0" / "history.jsonl";
        for (int wait = 0; wait < 3000; ++wait) {
            if (std::filesystem::exists(history) && std::filesystem::file_size(history) > 3000) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        kill(process, signal);
        int status = 0;
        REQUIRE(waitpid(process, &status, 0) == process);
        if (signal != SIGKILL) {
            CHECK(WIFEXITED(status));
            CHECK(WEXITSTATUS(status) == 2);
            CHECK(contents(folder.path / "log").find("--resume") != std::string::npos);
            check_best_so_far(cut);
        }
        const Json resumed = run(arguments + cut + " --resume").json();
        CHECK(resumed["parameters"] == undisturbed["parameters"]);
        CHECK(resumed["objective"] == undisturbed["objective"]);
        CHECK(resumed["seed"] == undisturbed["seed"]);
        for (size_t k = 0; k < 3; ++k) CHECK(resumed["starts"][k]["parameters"] == undisturbed["starts"][k]["parameters"]);
    }
}

TEST_CASE("--repair: the smallest change, told by parameter; nothing where nothing is violated") {
    const DesignFolder folder;
    const Answer repair = run("optimise " + folder.design() + " --repair --json --out " + (folder.path / "repaired").string());
    const Json answer = repair.json();
    CHECK((repair.code == 0 || repair.code == 2));
    CHECK(answer["constraint_violation"] == 0);
    CHECK(answer["repair"]["changes"].size() == 5);
    const std::string final = (folder.path / "repaired" / "design.final.json").string();
    const Json again = run("optimise " + final + " --repair --json --out " + (folder.path / "again").string()).json();
    CHECK(again["status"] == "optimal");
    CHECK(again["evaluations"] == 1);
    CHECK(again["repair"]["distance"] == 0);
}

}  // namespace fettle::design::cli::optimise_starts_test
