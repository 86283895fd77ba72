// SPDX-License-Identifier: MIT
// Output that cannot be written: never exit code 0, the verdict told all the same, and the folder as it was before.
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::unwritable_output_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;
namespace fs = std::filesystem;

std::string scene_of(const DesignFolder& folder) { return folder.file("small.scene.json"); }

/// But for what a run leaves of its own motion, to go on with.
std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with("trajectory.running.")) continue;
        found[entry.path().string()] = contents(entry.path());
    }
    return found;
}

/// Files beyond so many blocks of 512 bytes (a shell's unit) cannot be written, as on a full disk.
std::string blocks(int count) { return "ulimit -f " + std::to_string(count) + "; "; }

}  // namespace

TEST_CASE("an answer that standard output does not take is exit code 3, of every command") {
    const DesignFolder folder;
    const std::string scene = scene_of(folder);
    const std::vector<std::string> commands{"--version",
                                            "--help",
                                            "simulate --help",
                                            "completion bash",
                                            "shapes",
                                            "joints",
                                            "validate " + scene,
                                            "simulate " + scene + " --steps 1",
                                            "clearance " + scene + " --minimum 0.1mm",
                                            "validate /nowhere.scene.json"};
    for (const std::string& command : commands) {
        for (const char* json : {"", " --json"}) {
            CAPTURE(command, json);
            CHECK(run(command + json + " >/dev/full").code == 3);
            CHECK(run(command + json + " >&-").code == 3);
        }
    }
    // A # leaves out what run() adds.
    const Answer told = run("validate " + scene + " 2>&1 >/dev/full #");  // stdout is full, stderr is read
    CHECK(told.says("standard output"));
    CHECK(told.says("No space left on device"));
    CHECK(told.says("file_unwritable"));
    CHECK(run("validate " + scene + " >&- 2>&- #").code == 3);  // and nobody can be told
    CHECK(run("validate " + scene + " <&- #").code == 0);
}

TEST_CASE("simulate: what cannot be written is told beside the verdict, and the folder stays as it was") {
    const DesignFolder folder;
    const std::string scene = scene_of(folder), out = folder.file("out");
    REQUIRE(run("simulate " + scene + " --steps 3 --out " + out).code == 0);
    const auto before = files_in(out);
    REQUIRE(before.count(out + "/report.html") == 1);
    const Answer answer = run("simulate " + scene + " --steps 20 --json --out " + out, false, blocks(2));
    CHECK(answer.code == 3);
    CHECK(answer.json().at("status") == "ok");
    CHECK(answer.json().at("minimum_distance").get<double>() > 0);
    CHECK(answer.json().at("unwritten").at(0).at("code") == "file_unwritable");
    CHECK(answer.json().at("unwritten").at(0).at("where").get<std::string>().find(out + "/") == 0);
    CHECK(files_in(out) == before);
    const Answer text = run("simulate " + scene + " --steps 20 --out " + out, true, blocks(2));
    CHECK(text.code == 3);
    CHECK(text.says("ok after 20 steps"));
    CHECK(text.says("[file_unwritable]"));
    CHECK(files_in(out) == before);
    // Some fit, and are not left beside the others.
    for (const int count : {8, 16, 40, 120, 300}) {
        CAPTURE(count);
        const int code = run("simulate " + scene + " --steps 20 --no-report --out " + out, false, blocks(count)).code;
        CHECK((code == 3 || code == 0));
        if (code == 3) CHECK(files_in(out) == before);
        if (code == 0) break;
    }
}

TEST_CASE("clearance: the verdict is told where files cannot be written, and none of them is") {
    const DesignFolder folder;
    const std::string scene = scene_of(folder), out = folder.file("out");
    fs::create_directories(out);
    const auto command = [&](const char* more) {
        return "clearance " + scene + " --pairs table:cube,cube:wall --minimum 0.001mm --json --certificate " + out + "/c.json --csv " +
               out + "/c.csv --out " + out + "/folder" + more;
    };
    REQUIRE(run(command("")).code == 0);
    const auto before = files_in(out);
    REQUIRE(before.size() >= 3);
    int failed = 0;
    for (const int count : {0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
        CAPTURE(count);
        const Answer answer = run(command(" --tolerance 0.01mm --no-report"), false, blocks(count));
        if (answer.code == 0) break;
        ++failed;
        CHECK(answer.code == 3);
        CHECK(answer.json().at("status") == "clear");
        CHECK(answer.json().at("unwritten").size() == 1);
        for (const char* key : {"certificate", "out", "report"}) CHECK_FALSE(answer.json().contains(key));
        CHECK(files_in(out) == before);
    }
    CHECK(failed >= 3);
}

TEST_CASE("optimise: a full disk costs the files, not the verdict") {
    const DesignFolder folder;
    const std::string out = folder.file("out");
    const Answer answer = run("optimise " + folder.design() + " --json --no-report --out " + out, false, blocks(4));
    CAPTURE(answer.out);
    CHECK(answer.code == 3);
    CHECK(answer.json().at("evaluations").get<int>() >= 8);
    CHECK(answer.json().at("parameters").contains("height"));
    const std::string faults = answer.json().at("unwritten").dump();
    CHECK(faults.find("history.jsonl") != std::string::npos);
    CHECK(faults.find("file_unwritable") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "out/result.json"));
    CHECK_FALSE(fs::exists(folder.path / "out/design.final.json"));
    const Answer text = run("optimise " + folder.design() + " --no-report --out " + out, true, blocks(4));
    CHECK(text.code == 3);
    CHECK(text.says("objective"));
    CHECK(text.says("warning: " + out + "/history.jsonl"));
    CHECK_FALSE(text.says("written to"));
}

TEST_CASE("a log that cannot be written is told, and exit code 3") {
    const DesignFolder folder;
    const std::string command = "simulate " + scene_of(folder) + " --steps 2 --json";
    const Answer full = run(command + " --quiet --log " + folder.file("log.txt"), true, blocks(0));
    CHECK(full.code == 3);
    CHECK(full.says("the log cannot be written"));
    CHECK(full.says("\"status\": \"ok\""));
    CHECK(run(command + " --log /dev/full").json().at("unwritten").at(0).at("where") == "/dev/full");
}

TEST_CASE("a report that cannot be made is told in the answer") {
    const DesignFolder folder;
    const std::string out = folder.file("out");
    REQUIRE(run("simulate " + scene_of(folder) + " --steps 2 --no-report --out " + out).code == 0);
    const auto largest = fs::file_size(out + "/motion.glb");
    const Answer answer =
        run("simulate " + scene_of(folder) + " --steps 2 --quiet --json --out " + out, false, blocks(static_cast<int>(largest / 512 + 8)));
    CHECK(answer.code == 3);
    CHECK(answer.json().at("status") == "ok");
    CHECK(answer.json().at("report").is_null());
    CHECK(answer.json().at("report_fault").get<std::string>().find("report.html") != std::string::npos);
    CHECK(fs::exists(out + "/result.json"));
}

TEST_CASE("names cannot write to a terminal, and are refused where they come in") {
    const DesignFolder folder(small_design, replaced(small_scene, "\"name\": \"wall\"", "\"name\": \"wa\\u001b[2Jll\""));
    const Answer refused = run("validate " + scene_of(folder), true);
    CHECK(refused.code == 3);
    CHECK(refused.says("\\x1b"));
    CHECK_FALSE(refused.says("\033"));
    const Answer path = run("validate \"$(printf '/no\\033where')\"", true);
    CHECK(path.code == 3);
    CHECK_FALSE(path.says("\033"));
    const DesignFolder output(replaced(small_design, "\"units\": \"mm\"", "\"units\": \"mm\", \"output\": \"a\\u001b[31mb\""));
    const Answer written = run("validate " + output.design() + " --json");
    CHECK(written.code == 3);
    CHECK(written.says("/output"));
    const DesignFolder parameter(replaced(small_design, "\"name\": \"height\"", "\"name\": \"hei\\nght\""));
    const Answer design = run("validate " + parameter.design() + " --json");
    CHECK(design.code == 3);
    CHECK(design.says("a name is text on one line"));
}

TEST_CASE("memory that cannot be had is an error of its own, at whatever point it runs out") {
    const DesignFolder folder;
    const auto within = [](int kilobytes) { return "ulimit -v " + std::to_string(kilobytes) + "; "; };
    const Answer large =
        run("draw " + scene_of(folder) + " --size 16384x16384 --json --out " + folder.file("large.png"), false, within(500000));
    CHECK(large.code == 3);
    CHECK(large.json().at("errors").at(0).at("code") == "out_of_memory");
    CHECK_FALSE(fs::exists(folder.path / "large.png"));
    int rounds = 0;
    for (int kilobytes = 60000; kilobytes >= 30000; kilobytes -= 2000) {
        CAPTURE(kilobytes);
        const Answer answer = run("simulate " + scene_of(folder) + " --threads 1 --steps 300 --json", false, within(kilobytes));
        if (answer.code == 127) continue;  // a library does not fit: the system does not start it
        ++rounds;
        CHECK((answer.code == 0 || answer.code == 3));
        if (answer.code == 3) CHECK(answer.json().at("errors").at(0).at("code") == "out_of_memory");
    }
    REQUIRE(rounds > 0);
}

TEST_CASE("memory that the BLAS cannot have is an error of its own, not a wait without end") {
    const DesignFolder folder;
    for (const int kilobytes : {160000, 200000}) {
        CAPTURE(kilobytes);
        const Answer answer = run("optimise " + folder.design() + " --threads 1 --json --out " + folder.file("out"), false,
                                  "ulimit -t 60; ulimit -v " + std::to_string(kilobytes) + "; ");
        CAPTURE(answer.out);
        if (answer.code == 127) continue;  // a library does not fit: the system does not start it
        REQUIRE(answer.code == 3);
        CHECK(answer.json().at("errors").at(0).at("code") == "out_of_memory");
    }
}

}  // namespace fettle::design::cli::unwritable_output_test
