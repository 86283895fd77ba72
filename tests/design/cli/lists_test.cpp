// SPDX-License-Identifier: MIT
// Finding one's way: lists from the readers' own tables, starters that work, completion and manual pages.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/scene/joint_kind.hpp"
#include "design/cli/starters.hpp"
#include "design/optimisers/optimisation.hpp"
#include "design/reading/quantity_reader.hpp"
#include "design/shapes/part_library.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::lists_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;
using nlohmann::json;

}  // namespace

TEST_CASE("Lists: what the readers' tables have, entry for entry") {
    const json shapes = run("shapes --json").json()["shapes"];
    REQUIRE(shapes.size() == shapes::part_library().size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        CHECK(shapes[i]["name"] == shapes::part_library()[i].name);
        const auto part = shapes::find_part(std::string(shapes::part_library()[i].name)).value();
        REQUIRE(shapes[i]["dimensions"].size() == part.dimensions().size());
        for (std::size_t k = 0; k < part.dimensions().size(); ++k)
            CHECK(shapes[i]["dimensions"][k]["default"] == part.dimensions()[k].value);
        CHECK(shapes[i]["relations"].size() == part.relations().size());
    }
    CHECK(run("quantities --json").json()["quantities"].size() == reading::quantity_table().size());
    CHECK(run("joints --json").json()["joints"].size() == core::scene::joint_kinds().size());
    CHECK(run("optimisers --json").json()["optimisers"].size() == optimisers::optimiser_names().size());
    CHECK(run("joints screw --json").json()["joints"][0]["coordinate"] == "angle");
    CHECK(run("joints ball --json").json()["joints"][0]["coordinate"].is_null());
    for (std::size_t i = 0; i < core::scene::joint_kinds().size(); ++i)  // indexed by kind
        CHECK(static_cast<std::size_t>(core::scene::joint_kinds()[i].kind) == i);
    const Answer wrong = run("shapes boxx", true);
    CHECK(wrong.code == 3);
    CHECK(wrong.says("box"));
}

TEST_CASE("Lists: a shape is drawn, and its relations are told") {
    const TemporaryFolder folder;
    CHECK(run("shapes box --draw " + folder.file("box.svg")).code == 0);
    CHECK(contents(folder.file("box.svg")).find("box, default dimensions") != std::string::npos);
    CHECK(run("shapes geneva_wheel --draw " + folder.file("wheel.svg")).code == 0);
    CHECK(run("shapes geneva_wheel").says("or the slots break into the bore"));
    // Variables that relations use, also by way of others, and no others.
    const Answer gear = run("shapes spur_gear");
    CHECK(gear.says("\n    cutter_depth = "));
    CHECK(gear.says("\n    pitch_radius = module * teeth / 2\n"));
    const std::string used = folder.write("used.part.json", R"({"fettle_part": 1, "dimensions": {"long": 5},
        "variables": {"half": "= long / 2", "# half": "of it", "third": "= long / 3", "most": "= 4 * half"},
        "relations": [{"check": "long < most + 1mm"}], "solid": {"extrude": {"circle": 1}, "to": "= third"}})");
    CHECK(run("shapes " + used).says("  where\n    half = long / 2  (of it)\n    most = 4 * half\n"));
    CHECK(run("shapes --json " + used).json()["shapes"][0]["variables"].size() == 2);
    const std::string own = folder.write("rod.part.json", R"({"fettle_part": 1, "dimensions": {"long": 5},
        "solid": {"extrude": {"circle": 1}, "to": "= long"}})");
    CHECK(run("shapes " + own + " --draw " + folder.file("rod.svg")).code == 0);
    CHECK(run("shapes " + own).says("long"));
    CHECK(run("shapes --draw " + folder.file("x.svg")).code == 3);
    CHECK(run("shapes box --draw " + folder.file("x.gif")).code == 3);
}

TEST_CASE("Starters: each is written, valid, and simulates; none is overwritten") {
    const TemporaryFolder folder;
    const json listed = run("new --json").json()["starters"];
    REQUIRE(listed.size() == starters().size());
    REQUIRE(listed.size() >= 10);
    for (const Starter& starter : starters()) {
        CAPTURE(starter.name);
        CHECK_FALSE(starter.description.empty());
        const Answer written = run("new " + starter.name + " --in " + folder.path.string() + " --json");
        REQUIRE(written.code == 0);
        const auto files = written.json()["files"].get<std::vector<std::string>>();
        CHECK(files.size() == starter.files.size());
        for (const std::string& file : files) {
            if (file.ends_with(".part.json")) {
                CHECK(run("shapes " + file).code == 0);
                continue;
            }
            CHECK(contents(file).find("\"# ") != std::string::npos);  // commented
            const Answer valid = run("validate " + file + " --json");
            CAPTURE(valid.out);
            CHECK(valid.code == 0);
        }
        CHECK(run("simulate " + files.front() + " --steps 2 --json").json()["status"] == "ok");
        CHECK(run("new " + starter.name + " --in " + folder.path.string()).code == 3);
    }
    CHECK(run("new hindge", true).says("hinge"));
}

TEST_CASE("Starters: hinge, ratchet, latch and lock box are tuned to what they ask for", "[slow]") {
    const TemporaryFolder folder;
    for (const std::string name : {"hinge", "ratchet", "latch", "lock_box"}) {
        CAPTURE(name);
        REQUIRE(run("new " + name + " --in " + folder.path.string()).code == 0);
        const Answer answer = run("optimise " + folder.file(name + ".design.json") + " --out " + folder.file(name + ".out") + " --json");
        CAPTURE(answer.out);
        CHECK(answer.code == 0);
        CHECK(answer.json()["status"] == "optimal");
        CHECK(answer.json()["clearance"]["least"].get<double>() >= 0.2e-3);
        CHECK(answer.json()["clearance"]["least"].get<double>() < 0.205e-3);
    }
}

TEST_CASE("Comments: a key that starts with # says nothing, anywhere; others are still refused") {
    const TemporaryFolder folder;
    const auto scene = [&](const std::string& more) {
        return folder.write("a.scene.json", R"({"fettle_scene": 1, "units": "mm", "# a": "x", "bodies": [{"#": 1, "name": "a", )" + more +
                                                R"("shape": {"part": "box", "# b": {}}, "density": 1}]})");
    };
    CHECK(run("validate " + scene("\"# more\": null, ")).code == 0);
    CHECK(run("validate " + scene("\"more\": null, ")).code == 3);
}

TEST_CASE("Completion and manual: made from the program's own options") {
    const TemporaryFolder folder;
    const Answer bash = run("completion bash");
    REQUIRE(bash.code == 0);
    const std::string script = folder.write("fettle.bash", bash.out);
    const auto completed = [&](const std::string& words, int at) {
        const std::string command = "bash -c 'source " + script + "; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                                    "; _fettle; echo ${COMPREPLY[@]}' > " + folder.file("out");
        REQUIRE(std::system(command.c_str()) == 0);
        return contents(folder.file("out"));
    };
    CHECK(completed("fettle sim", 1) == "simulate\n");
    CHECK(completed("fettle simulate --con", 2) == "--continue\n");
    CHECK(completed("fettle --quiet draw --vi", 3) == "--view\n");
    CHECK(completed("fettle export x --arrange p", 4) == "plate parts\n");
    CHECK(completed("fettle optimise --optimiser sl", 3) == "slsqp\n");
    CHECK(completed("fettle clearance a.stl --process \\\"\\\"", 4).find("fdm sla") == 0);
    CHECK(completed("fettle tolerance a --process f", 4) == "fdm\n");
    CHECK(completed("fettle tolerance a --process mi", 4) == "\n");  // the shell offers files
    CHECK(run("completion fish").says("-l process -r -a 'fdm sla"));
    CHECK(run("completion fish").says("complete -c fettle -n __fish_use_subcommand -f -a simulate"));
    CHECK(run("completion zsh").says("bashcompinit"));
    CHECK(run("completion tcsh").code == 3);

    REQUIRE(run("manual --to " + folder.file("man")).code == 0);
    const std::string page = contents(folder.file("man/fettle.1")), draw = contents(folder.file("man/fettle-draw.1"));
    CHECK(page.find(".TH FETTLE 1") == 0);
    for (const char* command : {"simulate", "optimise", "export", "new"}) {
        CHECK(page.find(std::string("fettle\\-") + command) != std::string::npos);
        CHECK(std::filesystem::exists(folder.path / "man" / (std::string("fettle-") + command + ".1")));
    }
    CHECK(draw.find("\\fB\\-\\-view\\fR \\fITEXT\\fR") != std::string::npos);
    const Answer help = run("--help");
    for (const char* group : {"Start:", "Check:", "Simulate and tune:", "Show and export:", "About the program:"}) CHECK(help.says(group));
}

}  // namespace fettle::design::cli::lists_test
