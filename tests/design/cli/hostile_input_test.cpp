// SPDX-License-Identifier: MIT
// Files of anybody: whatever stands in them, and whatever they are called, no command of the program breaks, waits for ever, or prints what
// a terminal or a runner of checks obeys.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "core/base/printed_text.hpp"
#include "core/base/text.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::hostile_input_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;
namespace fs = std::filesystem;

/// Every command that reads files, with FILE for the one that it is about and OUT for one that it may write.
const std::vector<std::string>& commands() {
    static const std::vector<std::string> all{
        "validate FILE",
        "simulate FILE --steps 1",
        "simulate FILE --steps 1 --out OUT",
        "clearance FILE --minimum 0.1mm",
        "clearance FILE --minimum 0.1mm --certificate OUT.json",
        "clearance FILE FILE --unit mm",
        "clearance FILE --baseline FILE --minimum 0.1mm",
        "ranges FILE",
        "ranges FILE --anywhere --minimum 0.1mm",
        "check FILE",
        "check FILE --resolution",
        "check-resolution FILE",
        "tolerance FILE",
        "gradient FILE",
        "optimise FILE --out OUT",
        "optimise FILE --out OUT --resume",
        "explore FILE --samples 1 --workers 1 --out OUT.jsonl",
        "report FILE",
        "draw FILE --out OUT.svg",
        "export FILE --to OUT.glb",
        "import FILE --out OUT.scene.json",
        "process FILE --name mine --in OUT",
        "shapes FILE",
        "new FILE",
    };
    return all;
}

std::string filled(std::string command, const std::string& file, const std::string& out) {
    for (const auto& [word, name] : {std::pair{std::string("FILE"), file}, {std::string("OUT"), out}})
        for (std::size_t at = 0; (at = command.find(word, at)) != std::string::npos; at += name.size())
            command.replace(at, word.size(), name);
    return command;
}

const std::string patient = "timeout -k 5 60 ";  // 124 or 137: it was waited for in vain

// Text, and with --json one object, on one of the streams.
void check_sane(const std::string& command, const std::string& in = {}) {
    const Answer text = run(command, true, in);
    CAPTURE(command, text.out);
    CHECK(text.code != 4);
    CHECK((text.code >= 0 && text.code < 124));
    CHECK(core::base::is_utf8(text.out));
    CHECK(core::base::printed(text.out) == text.out);
    const Answer answer = run(command + " --json", false, in);
    CAPTURE(answer.out);
    CHECK(answer.code != 4);
    CHECK((answer.out.empty() || nlohmann::json::parse(answer.out, nullptr, false).is_object()));
}

}  // namespace

TEST_CASE("no command waits for what nobody writes into a pipe") {
    const DesignFolder folder;
    for (const char* name : {"pipe", "pipe.json", "pipe.stl", "pipe.part.json", "pipe.urdf"}) {
        REQUIRE(::mkfifo(folder.file(name).c_str(), 0600) == 0);
        const bool all = std::string(name) == "pipe.json";
        for (const std::string& command : commands()) {
            if (!all && !command.starts_with("validate") && !command.starts_with("clearance FILE FILE") && !command.starts_with("import") &&
                !command.starts_with("shapes"))
                continue;
            const Answer answer = run(filled(command, folder.file(name), folder.file("out")), true, patient);
            CAPTURE(command, name, answer.out);
            CHECK(answer.code == 3);
        }
    }
    // Nor where another file names one.
    const DesignFolder named(small_design, replaced(small_scene, R"("shape": { "part": "box", "dimensions": { "size_x": 5,)",
                                                    R"("shape": { "part": "pipe.part.json", "dimensions": { "size_x": 5,)"));
    REQUIRE(::mkfifo(named.file("pipe.part.json").c_str(), 0600) == 0);
    const Answer answer = run("validate " + named.design(), true, patient);
    CHECK(answer.code == 3);
    CHECK(answer.says("pipe.part.json"));  // it is no file, so none is found
}

TEST_CASE("bytes that are no UTF-8 break no command, in a file or in its name", "[slow]") {
    const std::string bad = "na\xffme";
    const DesignFolder key(replaced(small_design, "\"name\": \"height\"", "\"" + bad + "\": \"height\"")),
        value(replaced(small_design, "\"name\": \"height\"", "\"name\": \"" + bad + "\""));
    for (const std::string& command : commands())
        for (const DesignFolder* folder : {&key, &value})
            check_sane(filled(command, folder->design(), folder->file("out")), patient + "env -C " + folder->path.string() + " ");
    const DesignFolder folder;
    const fs::path place = folder.path / bad;
    fs::create_directories(place);
    fs::copy(folder.design(), place / ("a" + bad + ".design.json"));
    fs::copy(folder.file("small.scene.json"), place / "small.scene.json");
    for (const std::string& command : commands())
        check_sane(filled(command, "'" + (place / ("a" + bad + ".design.json")).string() + "'", "'" + (place / "out").string() + "'"),
                   patient + "env -C '" + place.string() + "' ");
}

TEST_CASE("text of files reaches neither a terminal's controls nor the start of a line of a runner's") {
    const DesignFolder folder(replaced(
        small_design, R"({ "type": "stroke", "body": "cube", "axis": [0, 0, 1], "lower": 0, "upper": 30 })",
        R"({ "type": "stroke", "name": "::error::hello ##[error]x", "body": "cube", "axis": [0, 0, 1], "lower": 0, "upper": 30 })"));
    for (const char* command : {"validate FILE", "gradient FILE", "optimise FILE --no-report --out OUT", "check-resolution FILE"}) {
        const Answer answer = run(filled(command, folder.design(), folder.file("out")), true);
        CAPTURE(command, answer.out);
        CHECK(answer.code != 4);
        CHECK_FALSE(std::regex_search(answer.out, std::regex("(^|\\n)\\s*::")));
        CHECK_FALSE(answer.says("##["));
    }
    // Those of ours, too: colours are the console's alone.
    const std::string part = R"({"fettle_part": 1, "about": "\u001b[31mRED\u001b[0m", "dimensions":
        {"bore": {"value": 4, "about": "\u001b[32m"}}, "relations": [{"check": "bore > 1mm", "or": "\u001b[31m"}],
        "solid": {"extrude": {"rectangle": ["= bore", 4]}, "to": 4}})";
    const Answer shapes = run("shapes " + folder.write("red.part.json", part), true);
    CHECK(shapes.code == 0);
    CHECK(shapes.says("\\x1b[31mRED"));
    CHECK_FALSE(shapes.says("\033"));
    // A terminal, of util-linux; a machine without /dev/pts has none.
    if (std::system("script -qec true /dev/null >/dev/null 2>&1") != 0) {
        WARN("no terminal can be made here: not looked at");
        return;
    }
    const Answer seen = fettle::tests::support::run_program(
        "script", "-qec \"'" + std::string(FETTLE_PROGRAM) + "' shapes " + folder.file("red.part.json") + "\" /dev/null", true);
    CAPTURE(seen.out);
    CHECK(seen.says("\\x1b[31mRED"));
    CHECK_FALSE(seen.says("\033[31m"));
}

}  // namespace fettle::design::cli::hostile_input_test
