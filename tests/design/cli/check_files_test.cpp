// SPDX-License-Identifier: MIT
// What was found, as JUnit XML, SARIF, Markdown and annotations: the same verdict as the exit code, whatever stands in names.
#include "fettle/design/cli/check_files.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "fettle/core/mesh_files/mesh_writer.hpp"
#include "fettle/tests/design/small_design.hpp"
#include "fettle/tests/support/box_mesh.hpp"
#include "fettle/tests/support/program.hpp"
#include "fettle/tests/support/text.hpp"

namespace fettle::design::cli::check_files_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::box_mesh;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

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
    CHECK(annotations.find("|d\\x1b[31m%0Ae::") != std::string::npos);
    for (const std::string& text : {junit, markdown, annotations}) CHECK(text.find('\033') == std::string::npos);
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
    // An earlier pass is gone before the work begins, and a file that cannot be written is an error.
    folder.write("ci/junit.xml", "an earlier pass");
    CHECK(run("clearance " + scene + " --nonsense --junit " + folder.file("ci/junit.xml")).code == 3);
    CHECK(run("validate " + scene + " --junit /proc/none/junit.xml").code == 3);
    CHECK(run("validate " + scene + " --junit " + folder.path.string()).code == 3);
}

TEST_CASE("check files: a certificate's pairs are told with their bounds") {
    const DesignFolder folder;
    const std::string proof = folder.file("fit.certificate.json");
    REQUIRE(run("clearance " + folder.file("small.scene.json") + " --minimum 1mm --pairs cube:wall --certificate " + proof).code == 0);
    const Found close = found(folder, "validate " + proof + " --minimum 30mm");
    CHECK(close.answer.code == 1);
    CHECK(close.junit.find("message=\"at least 24.") != std::string::npos);
    CHECK(close.junit.find(" mm; disjoint solids; required 30mm\"") != std::string::npos);
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

}  // namespace fettle::design::cli::check_files_test
