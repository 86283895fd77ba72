// SPDX-License-Identifier: MIT
// What was found, as JUnit XML, SARIF, Markdown and annotations: the same verdict as the exit code, whatever stands in names.
#include "design/cli/finding_files.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "core/mesh_files/mesh_writer.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::finding_files_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::box_mesh;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

// The file that a SARIF result is about.
std::string uri_of(const Json& result) {
    return result.at("locations")[0].at("physicalLocation").at("artifactLocation").at("uri").get<std::string>();
}

// Every tag is closed by its own, attributes are quoted, and no character stands that XML has not.
bool is_well_formed(const std::string& xml) {
    std::vector<std::string> open;
    std::size_t at = xml.find("?>");
    if (at == std::string::npos) return false;
    for (at = xml.find('<', at); at != std::string::npos; at = xml.find('<', at + 1)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1),
                          name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /", 1) - (tag[0] == '/' ? 1 : 0));
        if (tag.find('<') != std::string::npos || std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
        if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return false;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
    }
    for (std::size_t amp = xml.find('&'); amp != std::string::npos; amp = xml.find('&', amp + 1))
        if (xml.find(';', amp) > amp + 8) return false;
    return open.empty() && std::none_of(xml.begin(), xml.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; });
}

struct Found {
    Answer answer;
    std::string junit, markdown;
    Json sarif;
    const Json& results() const { return sarif.at("runs")[0].at("results"); }
};

Found found(const TemporaryFolder& folder, const std::string& arguments) {
    const std::string junit = folder.file("ci/junit.xml"), sarif = folder.file("ci/a.sarif"), markdown = folder.file("ci/a.md");
    Found all;
    all.answer = run(arguments + " --junit " + junit + " --sarif " + sarif + " --markdown " + markdown);
    all.junit = contents(junit);
    all.markdown = contents(markdown);
    all.sarif = Json::parse(contents(sarif));
    CAPTURE(arguments, all.answer.out, all.junit);
    CHECK(is_well_formed(all.junit));
    CHECK(all.sarif.at("version") == "2.1.0");
    const Json& run_json = all.sarif.at("runs")[0];
    CHECK(run_json.at("tool").at("driver").at("name") == "fettle");
    CHECK(run_json.at("invocations")[0].at("exitCode") == all.answer.code);
    std::set<std::string> rules;
    for (const Json& rule : run_json.at("tool").at("driver").at("rules")) rules.insert(rule.at("id").get<std::string>());
    for (const Json& result : all.results()) {
        CHECK(rules.count(result.at("ruleId").get<std::string>()) == 1);
        CHECK(!result.at("message").at("text").get<std::string>().empty());
        CHECK(result.at("locations")[0].at("physicalLocation").at("region").at("startLine") >= 1);
        const std::string level = result.at("level");
        CHECK((level == "error" || level == "warning" || level == "note"));
    }
    // The verdict is that of the exit code.
    const bool passed = all.junit.find("<failure") == std::string::npos && all.junit.find("<error") == std::string::npos;
    CHECK(passed == (all.answer.code == 0));
    return all;
}

}  // namespace

TEST_CASE("check files: names of any kind stand in all of them") {
    const std::string name = "a<b>&\"c\"|d\x1b[31m\ne", file = "a folder/ä,b.stl";
    const Checks checks{"clearance",
                        1,
                        CheckOutcome::failed,
                        {{name, CheckOutcome::failed, "below threshold", "at least 0.1 mm", file},
                         {"two", CheckOutcome::undecided, "undecided", "100% open:\nnot told", ""},
                         {"three", CheckOutcome::passed, "clear", "", file},
                         {"four", CheckOutcome::remarked, "warning", "odd", file}}};
    const std::string junit = junit_xml(checks);
    CAPTURE(junit);
    CHECK(is_well_formed(junit));
    CHECK(junit.find("tests=\"4\" failures=\"2\" errors=\"0\"") != std::string::npos);
    CHECK(junit.find("a&lt;b&gt;") != std::string::npos);
    const Json sarif = Json::parse(sarif_json(checks));
    const Json& results = sarif["runs"][0]["results"];
    REQUIRE(results.size() == 3);
    CHECK(results[0]["ruleId"] == "below-threshold");
    CHECK(results[0]["level"] == "error");
    CHECK(results[1]["level"] == "warning");
    CHECK(results[2]["level"] == "note");
    CHECK(results[0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "a%20folder/%C3%A4,b.stl");
    const std::string markdown = markdown_text(checks);
    CAPTURE(markdown);
    CHECK(markdown.find("### fettle clearance: failed") == 0);
    CHECK(std::count(markdown.begin(), markdown.end(), '\n') == 11);  // no name ends a row
    CHECK(markdown.find("\\|d") != std::string::npos);
    const std::string annotations = annotation_lines(checks);
    CHECK(annotations.find("::error file=a folder/ä%2Cb.stl,title=fettle clearance%3A a<b>") == 0);
    CHECK(annotations.find("::warning title=fettle clearance%3A two::100%25 open:%0Anot told\n") != std::string::npos);
    CHECK(annotations.find("three") == std::string::npos);
    CHECK(annotations.find('\033') == std::string::npos);
}

TEST_CASE("check files: clearance of meshes, clear, too close and undecided") {
    const TemporaryFolder folder;
    const core::geometry::Mesh a = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01}), b = box_mesh({0.0105, 0, 0}, {0.02, 0.01, 0.01});
    const std::string files = folder.write("cad/a.stl", core::mesh_files::stl_bytes({{"a", &a}})) + " " +
                              folder.write("cad/b.stl", core::mesh_files::stl_bytes({{"b", &b}})) + " --unit mm";
    const Found clear = found(folder, "clearance " + files + " --minimum 0.4mm");
    CHECK(clear.answer.code == 0);
    CHECK(clear.results().empty());
    CHECK(clear.markdown.find("### fettle clearance: passed") == 0);
    const Found close = found(folder, "clearance " + files + " --minimum 0.6mm");
    CHECK(close.answer.code == 1);
    REQUIRE(close.results().size() == 1);
    CHECK(close.results()[0]["ruleId"] == "below-threshold");
    CHECK(close.results()[0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"].get<std::string>().ends_with("/cad/a.stl"));
    CHECK(close.markdown.find("| failed | a:b | at least 0.49") != std::string::npos);
    const Found open = found(folder, "clearance " + files + " --minimum 0.5mm --tolerance 0.1mm");
    CHECK(open.answer.code == 2);
    REQUIRE(open.results().size() == 1);
    CHECK(open.results()[0]["level"] == "warning");
    const Answer annotated = run("clearance " + files + " --minimum 0.6mm --json --annotations");
    CHECK(annotated.json().is_object());  // stdout has the one object
    CHECK(run("clearance " + files + " --minimum 0.6mm --annotations", true).says("::error file="));
}

TEST_CASE("check files: other commands, faults, and what no pass may come of") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json");
    CHECK(found(folder, "validate " + scene).answer.code == 0);
    CHECK(found(folder, "simulate " + scene + " --steps 2").answer.code == 0);
    const Found missing = found(folder, "validate " + folder.file("gone.scene.json"));
    CHECK(missing.answer.code == 3);
    CHECK(missing.junit.find("<error type=\"file_not_found\"") != std::string::npos);
    const Found tuned = found(folder, "optimise " + folder.design() + " --no-report --out " + folder.file("out"));
    CHECK(tuned.junit.find("clearance cube:wall over the motion") != std::string::npos);
    CHECK(found(folder, "draw " + scene + " --out " + folder.file("a.png")).answer.code == 0);  // by its exit code alone
    CHECK(run("validate " + scene + " --junit /proc/none/junit.xml").code == 3);
    CHECK(run("validate " + scene + " --junit " + folder.path.string()).code == 3);
}

TEST_CASE("check files: warnings are remarks, about their file, and errors where asked to be strict") {
    const std::string body = "\"shape\": {\"part\": \"box\", \"dimensions\": {\"size_x\": 40000, \"size_y\": 9, \"size_z\": 9}}";
    const DesignFolder folder(small_design,
                              replaced(small_scene,
                                       R"("shape": { "part": "box", "dimensions": { "size_x": 5, "size_y": 60, "size_z": 60 } },)"
                                       R"( "position": [40, 0, 0])",
                                       body + ", \"position\": [0, 0, 500]"));
    const std::string scene = folder.file("small.scene.json");
    for (const char* command : {"validate ", "clearance --minimum 0.01mm --pairs table:cube ", "simulate --steps 1 "}) {
        const Found all = found(folder, command + scene + " --json");
        CAPTURE(command, all.answer.out, all.junit);
        CHECK(all.answer.code == 0);
        CHECK(all.answer.json().at("warnings").dump().find("its size is 40 m") != std::string::npos);
        REQUIRE(all.results().size() == 1);
        CHECK(all.results()[0].at("ruleId") == "warning");
        CHECK(uri_of(all.results()[0]).ends_with("small.scene.json"));
        CHECK(all.markdown.find("its size is 40 m") != std::string::npos);
        CHECK(run(command + scene + " --strict").code == 3);
    }
    const Answer strict = run("validate " + folder.design() + " --strict", true);
    CHECK(strict.code == 3);
    CHECK(strict.says("its size is 40 m"));
    // What is about no file of its own is about the command's; a place in a file names the file.
    CHECK(uri_of(found(folder, "clearance " + scene + " --minimum 3").results()[0]).ends_with("small.scene.json"));
    const Found broken = found(folder, "validate " + folder.write("broken.scene.json", "{\n \"fettle_scene\": }"));
    CHECK(uri_of(broken.results()[0]).ends_with("broken.scene.json"));
    const auto line_of = [](const Json& result) {
        return result.at("locations")[0].at("physicalLocation").at("region").at("startLine").get<int>();
    };
    CHECK(line_of(broken.results()[0]) == 2);
    const Found unknown =
        found(folder, "validate " +
                          folder.write("c.scene.json", "{\"fettle_scene\": 1, \"units\": \"mm\",\n \"bodies\": [\n  {\"colour\": 1}\n]}"));
    CHECK(std::any_of(unknown.results().begin(), unknown.results().end(), [&](const Json& result) {
        return result.at("message").at("text").get<std::string>().find("colour") != std::string::npos && line_of(result) == 3;
    }));
}

TEST_CASE("check files: a fault before the work replaces an earlier pass") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json"), junit = folder.file("ci/junit.xml");
    const std::vector<std::string> commands{
        "clearance " + scene + " --nonsense --junit " + junit, "clearance --junit=" + junit + " " + scene + " --steps",
        "clearence " + scene + " --junit " + junit, "validate " + scene + " --log /proc/none/log.txt --junit " + junit,
        "validate " + scene + " --sarif /proc/none/a.sarif --junit " + junit};
    for (const std::string& command : commands) {
        folder.write("ci/junit.xml", "an earlier pass");
        const Answer answer = run(command + " --json");
        CAPTURE(command, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.json().at("status") == "error");
        CHECK(contents(junit).find("<error") != std::string::npos);
        CHECK(is_well_formed(contents(junit)));
    }
}

TEST_CASE("check files: pipes and devices are written to, and stay") {
    const DesignFolder folder;
    const std::string validate = "validate " + folder.file("small.scene.json"), told = folder.file("told.md");
    CHECK(run(validate + " --markdown /dev/fd/3 3>" + told).code == 0);
    CHECK(contents(told).find("### fettle validate: passed") == 0);
    const std::string pipe = folder.file("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(run(validate + " --junit " + pipe, false, "timeout 5 cat " + pipe + " >" + told + " & ").code == 0);
    CHECK(std::filesystem::is_fifo(pipe));
    std::filesystem::create_symlink("/dev/null", folder.path / "link");
    CHECK(run(validate + " --sarif " + folder.file("link")).code == 0);
    CHECK(std::filesystem::is_symlink(folder.path / "link"));
    // One that takes nothing: one answer, which tells it, and no file that says all was well.
    for (const char* option : {"--junit", "--sarif", "--markdown"}) {
        const std::string other = std::string(option) == "--junit" ? " --markdown " : " --junit ";
        const Answer full = run(validate + " --json " + option + " /dev/full" + other + told);
        CAPTURE(option, full.out);
        CHECK(full.code == 3);
        REQUIRE(full.json().is_object());
        CHECK(full.json().at("status") == "ok");
        CHECK(full.json().at("unwritten").at(0).at("where") == "/dev/full");
        CHECK(contents(told).find(other == " --junit " ? "<error type=\"file_unwritable\"" : "could not be checked") != std::string::npos);
    }
}

TEST_CASE("check files: output that cannot be written is a fault in them") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json"), junit = folder.file("j.xml"), sarif = folder.file("a.sarif");
    const std::string files = " --junit " + junit + " --sarif " + sarif;
    CHECK(run("simulate " + scene + " --steps 20 --no-report --out " + folder.file("out") + files, false, "ulimit -f 8; ").code == 3);
    CHECK(contents(junit).find("<error type=\"file_unwritable\"") != std::string::npos);
    CHECK(Json::parse(contents(sarif)).at("runs")[0].at("invocations")[0].at("exitCode") == 3);
    CHECK(run("validate " + scene + files + " >/dev/full").code == 3);  // known when the files are there
    CHECK(contents(junit).find("standard output") != std::string::npos);
    CHECK(contents(sarif).find("file_unwritable") != std::string::npos);
}

TEST_CASE("check files: no output takes the place of an input, nor of another output") {
    const DesignFolder folder;
    core::geometry::Mesh box = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01});
    const std::string scene = folder.file("small.scene.json"), part = folder.write("part.stl", core::mesh_files::stl_bytes({{"a", &box}}));
    const std::string poses = folder.write("poses.csv", "not read");
    const std::vector<std::string> commands{
        "validate " + scene + " --junit " + scene,
        "validate " + scene + " --log " + folder.file("../") + folder.path.filename().string() + "/small.scene.json",
        "validate " + folder.design() + " --sarif " + scene,  // which the design reads
        "validate " + part + " --markdown " + part,
        "validate " + scene + " --log " + part,
        "clearance " + scene + " --csv " + scene,
        "clearance " + scene + " --poses " + poses + " --csv " + poses,
        "clearance " + scene + " --poses " + poses + " --junit " + poses,
        "validate " + poses + " --nonsense --junit " + poses,
        "validate " + scene + " --junit " + folder.file("x") + " --sarif " + folder.file("./x")};
    const std::string before = contents(scene), mesh = contents(part);
    for (const std::string& command : commands) {
        const Answer answer = run(command, true);
        CAPTURE(command, answer.out);
        CHECK(answer.code == 3);
        CHECK(contents(scene) == before);
        CHECK(contents(part) == mesh);
        CHECK(contents(poses) == "not read");
    }
    const Answer named = run("validate " + scene + " --junit " + scene, true);
    CHECK(named.says("--junit"));
    CHECK(named.says("FILE"));
    CHECK(run("validate " + scene + " --junit /dev/null --sarif /dev/null --log /dev/null").code == 0);
}

TEST_CASE("check files: nor of what an input names") {
    const DesignFolder folder;
    core::geometry::Mesh box = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01});
    const std::string part = folder.write("in/rod.stl", core::mesh_files::stl_bytes({{"rod", &box}}));
    const std::string scene = folder.write("in/m.scene.json", R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.02,
        "bodies": [{"name": "rod", "mesh": "rod.stl", "mesh_unit": "mm", "density": 1000}]})");
    const std::string in = folder.file("in"), run_folder = folder.file("run"), proof = folder.file("fit.certificate.json");
    REQUIRE(run("export " + scene + " --to " + folder.file("other.stl")).code == 0);
    REQUIRE(run("simulate " + folder.file("small.scene.json") + " --steps 2 --out " + run_folder).code == 0);
    REQUIRE(run("clearance " + folder.file("small.scene.json") + " --minimum 0.001mm --certificate " + proof).code < 3);
    const std::vector<std::pair<std::string, std::string>> commands{
        {"export " + scene + " --to " + part, part},
        {"export " + scene + " --to " + in + " --format stl --arrange separate --in-place", part},
        {"export " + in + " --unit mm --to " + in + " --format stl --arrange separate", part},
        {"report " + run_folder + " --out " + run_folder + "/result.json", run_folder + "/result.json"},
        {"report " + run_folder + " --out " + run_folder + "/trajectory.json", run_folder + "/trajectory.json"},
        {"validate " + proof + " --junit " + folder.file("fit.trajectory.json"), folder.file("fit.trajectory.json")}};
    for (const auto& [command, file] : commands) {
        const std::string before = contents(file);
        const Answer answer = run(command, true);
        CAPTURE(command, answer.out);
        CHECK(answer.code == 3);
        CHECK(contents(file) == before);
        CHECK_FALSE(before.empty());
    }
    CHECK(run("export " + scene + " --to " + part, true).says("m.scene.json"));
    CHECK(run("export " + scene + " --to " + folder.file("other.stl")).code == 0);  // which nothing reads
    CHECK(run("report " + run_folder).code == 0);
}

TEST_CASE("check files: every finding of SARIF has a place, for code scanning refuses all where one has none") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json");
    for (const std::string& command :
         {"clearance " + scene + " --minimum 0.001mm --csv /dev/full", "validate " + folder.file("nowhere.scene.json"),
          "simulate " + scene + " --stpes 3", "clearance " + scene + " --minimum 0.3", "simulate " + scene + " --steps 1 --out /proc/x",
          std::string("clearance")}) {
        const Found fault = found(folder, command);
        CAPTURE(command, fault.sarif.dump());
        CHECK(fault.answer.code == 3);
        CHECK_FALSE(fault.results().empty());
        for (const Json& result : fault.results())
            CHECK_FALSE(result.at("locations").at(0).at("physicalLocation").at("artifactLocation").at("uri").get<std::string>().empty());
    }
}

TEST_CASE("check files: options of a certificate are not passed over where there is none") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json");
    const Answer minimum = run("validate " + scene + " --minimum 0.3mm", true);
    CHECK(minimum.code == 3);
    CHECK(minimum.says("use fettle clearance"));
    CHECK(run("validate " + scene + " --trajectory x.json").code == 3);
    CHECK(run("draw " + scene + " --trajectory x.json --out " + folder.file("x.png")).code == 3);
    CHECK(run("export " + scene + " --arrange plate --to " + folder.file("x.glb")).code == 3);
    CHECK(run("gradient " + folder.design() + " --check-limit 1").code == 3);
}

TEST_CASE("check files: the summary of GitHub's job is added to") {
    const DesignFolder folder;
    const std::string summary = folder.write("summary.md", "before\n");
    ::setenv("GITHUB_STEP_SUMMARY", summary.c_str(), 1);
    CHECK(run("validate " + folder.design() + " --markdown " + summary).code == 0);
    ::unsetenv("GITHUB_STEP_SUMMARY");
    CHECK(contents(summary).find("before\n### fettle validate: passed") == 0);
    CHECK(run("validate " + folder.design() + " --markdown " + summary).code == 0);
    CHECK(contents(summary).find("### fettle validate: passed") == 0);
}

}  // namespace fettle::design::cli::finding_files_test
