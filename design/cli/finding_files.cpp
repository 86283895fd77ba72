// SPDX-License-Identifier: MIT
#include "design/cli/finding_files.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_lines.hpp"
#include "design/answers/output_folder.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_finding(const Check& check) { return check.outcome != CheckOutcome::passed; }

const char* word(CheckOutcome outcome) {
    switch (outcome) {
        case CheckOutcome::passed:
            return "passed";
        case CheckOutcome::remarked:
            return "passed, with a remark";
        case CheckOutcome::failed:
            return "failed";
        case CheckOutcome::undecided:
            return "undecided";
        case CheckOutcome::fault:
            break;
    }
    return "could not be checked";
}

long count(const Checks& checks, CheckOutcome outcome) {
    return std::count_if(checks.list.begin(), checks.list.end(), [&](const Check& check) { return check.outcome == outcome; });
}

// "below threshold" -> "below-threshold": identifiers have no spaces.
std::string rule_id(const std::string& rule) {
    std::string id = rule;
    std::replace(id.begin(), id.end(), ' ', '-');
    return id;
}

std::string attribute(const char* name, const std::string& value) {
    return std::string(" ") + name + "=\"" + core::base::xml_text(value) + "\"";
}

// From the working directory, with the characters that RFC 3986 lets stand in a path.
std::string uri_of(const std::string& file) {
    const fs::path near = fs::absolute(file).lexically_relative(fs::current_path());
    const bool below = !near.empty() && *near.begin() != "..";
    std::string uri = below ? "" : "file://";
    for (const char c : (below ? near : fs::absolute(file).lexically_normal()).generic_string()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool kept =
            byte < 0x80 && (std::isalnum(byte) != 0 || std::string_view("-._~/!$&'()*+,;=:@").find(c) != std::string_view::npos);
        char escaped[4];
        std::snprintf(escaped, sizeof escaped, "%%%02X", byte);
        uri += kept ? std::string(1, c) : std::string(escaped);
    }
    return uri;
}

const char* level(CheckOutcome outcome) {
    if (outcome == CheckOutcome::remarked) return "note";
    return outcome == CheckOutcome::undecided ? "warning" : "error";
}

// A finding's own file, else the command's.
const std::string& place_of(const Check& check, const Checks& checks) { return check.file.empty() ? checks.about : check.file; }

// Where in its file: the line that a fault's place names ("a.json#/bodies/0", "a.json:3:8"), else the first.
int line_of(const Check& check, const std::string& place) {
    if (check.file.empty() || !check.name.starts_with(place) || check.name.size() == place.size()) return 1;
    const std::string within = check.name.substr(place.size());
    if (within.starts_with(":")) return std::max(1, std::atoi(within.c_str() + 1));
    if (!within.starts_with("#/")) return 1;
    const Result<std::string> text = core::files::read_file(place);
    return text ? core::files::line_of_pointer(*text, within.substr(1)) : 1;
}

Json result_of(const Check& check, const Checks& checks) {
    Json result{{"ruleId", rule_id(check.rule)}, {"kind", "fail"}, {"level", level(check.outcome)}};
    result["message"] = {{"text", check.name + ": " + check.message}};
    const std::string& place = place_of(check, checks);
    const std::string uri = uri_of(place.empty() ? "." : place);
    result["locations"] =
        Json::array({{{"physicalLocation", {{"artifactLocation", {{"uri", uri}}}, {"region", {{"startLine", line_of(check, place)}}}}}}});
    // The same finding in the next run. One file can have several warnings and faults, which their messages tell apart; those of a
    // requirement have numbers that change with every design.
    const bool is_told_by_message = check.outcome == CheckOutcome::remarked || check.outcome == CheckOutcome::fault;
    const std::string more = is_told_by_message ? ":" + core::files::hash_of(check.message) : "";
    result["partialFingerprints"] = {{"check/v1", rule_id(check.rule) + ":" + check.name + more}};
    return result;
}

// In a cell of a table no line ends, no cell begins, and nothing is taken for HTML or for emphasis.
std::string cell(const std::string& text) {
    std::string out;
    for (const char c : core::base::shown_on_one_line(text)) {
        if (c == '<') {
            out += "&lt;";
        } else if (c == '&') {
            out += "&amp;";
        } else {
            if (std::string_view("|\\`*_[]").find(c) != std::string_view::npos) out += '\\';
            out += c;
        }
    }
    return out;
}

// The escapes of GitHub's workflow commands.
std::string escaped(const std::string& text, bool is_property) {
    std::string out;
    for (const char c : core::base::shown(text)) {
        if (c == '%') {
            out += "%25";
        } else if (c == '\n') {
            out += "%0A";
        } else if (is_property && c == ':') {
            out += "%3A";
        } else if (is_property && c == ',') {
            out += "%2C";
        } else {
            out += c;
        }
    }
    return out;
}

bool is_job_summary(const std::string& file) {
    const char* summary = std::getenv("GITHUB_STEP_SUMMARY");
    std::error_code ignored;
    return summary != nullptr && fs::equivalent(file, summary, ignored);
}

}  // namespace

CheckOutcome to_check(core::clearance::PairStatus status) {
    using core::clearance::PairStatus;
    if (status == PairStatus::violated) return CheckOutcome::failed;
    return status == PairStatus::undecided ? CheckOutcome::undecided : CheckOutcome::passed;
}

int exit_code(core::clearance::PairStatus status) {
    using core::clearance::PairStatus;
    if (status == PairStatus::violated) return exit_violated;
    return status == PairStatus::undecided ? exit_undecided : exit_done;
}

Check not_judged(const std::string& why, const std::string& file) {
    return {"every pair is judged", CheckOutcome::undecided, "not judged", why, file};
}

std::string junit_xml(const Checks& checks) {
    const std::string numbers =
        attribute("tests", std::to_string(checks.list.size())) +
        attribute("failures", std::to_string(count(checks, CheckOutcome::failed) + count(checks, CheckOutcome::undecided))) +
        attribute("errors", std::to_string(count(checks, CheckOutcome::fault)));
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fettle\"" + numbers + ">\n  <testsuite" +
                      attribute("name", "fettle " + checks.command) + numbers + attribute("skipped", "0") + ">\n";
    for (const Check& check : checks.list) {
        xml += "    <testcase" + attribute("classname", check.file.empty() ? "fettle " + checks.command : check.file) +
               attribute("name", check.name);
        if (check.outcome == CheckOutcome::passed && check.message.empty()) {
            xml += "/>\n";
            continue;
        }
        const bool passed = check.outcome == CheckOutcome::passed || check.outcome == CheckOutcome::remarked;
        const std::string element = check.outcome == CheckOutcome::fault ? "error" : "failure";
        xml += passed ? ">\n      <system-out>" + core::base::xml_text(check.message) + "</system-out>\n"
                      : ">\n      <" + element + attribute("type", check.rule) + attribute("message", check.message) + "/>\n";
        xml += "    </testcase>\n";
    }
    return xml + "  </testsuite>\n</testsuites>\n";
}

std::string sarif_json(const Checks& checks) {
    Json rules = Json::array(), results = Json::array();
    std::map<std::string, bool> known;
    for (const Check& check : checks.list) {
        if (!is_finding(check)) continue;
        if (std::exchange(known[rule_id(check.rule)], true) == false)
            rules.push_back({{"id", rule_id(check.rule)}, {"shortDescription", {{"text", check.rule}}}});
        results.push_back(result_of(check, checks));
    }
    const Json driver{{"name", "fettle"}, {"version", core::base::version()}, {"rules", rules}};
    const bool done = checks.verdict != CheckOutcome::fault;
    const Json invocation{{"executionSuccessful", done}, {"exitCode", checks.exit_code}};
    const Json run{{"tool", {{"driver", driver}}}, {"invocations", Json::array({invocation})}, {"results", results}};
    const Json log{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"}, {"version", "2.1.0"}, {"runs", Json::array({run})}};
    return core::files::dumped(log, 2) + "\n";
}

std::string markdown_text(const Checks& checks) {
    std::string text = "### fettle " + checks.command + ": " + word(checks.verdict) + "\n\n";
    for (const CheckOutcome outcome :
         {CheckOutcome::fault, CheckOutcome::failed, CheckOutcome::undecided, CheckOutcome::remarked, CheckOutcome::passed})
        if (const long n = count(checks, outcome); n > 0) text += std::to_string(n) + " " + word(outcome) + ", ";
    if (checks.list.empty()) return text;
    text.replace(text.size() - 2, 2, "\n\n| | what | found |\n|---|---|---|\n");
    for (const Check& check : checks.list)
        text += std::string("| ") + word(check.outcome) + " | " + cell(check.name) + " | " + cell(check.message) + " |\n";
    return text + "\n";
}

std::string annotation_lines(const Checks& checks) {
    std::string text;
    for (const Check& check : checks.list) {
        if (!is_finding(check)) continue;
        const std::string kind = check.outcome == CheckOutcome::remarked    ? "notice"
                                 : check.outcome == CheckOutcome::undecided ? "warning"
                                                                            : "error";
        const std::string& place = place_of(check, checks);
        text += "::" + kind + " " + (place.empty() ? "" : "file=" + escaped(place, true) + ",") +
                "title=" + escaped("fettle " + checks.command + ": " + check.name, true) + "::" + escaped(check.message, false) + "\n";
    }
    return text;
}

Errors prepare_finding_files(FindingFiles& files) {
    Errors errors;
    for (std::string* file : {&files.junit, &files.sarif, &files.markdown}) {
        if (file->empty()) continue;
        if (const Errors found = answers::try_output_file(*file); !found.empty()) {
            errors.insert(errors.end(), found.begin(), found.end());
            file->clear();
        } else if (file == &files.markdown && is_job_summary(*file)) {
            if (const Result<std::string> there = core::files::read_file(*file)) files.summary_before = *there;
        } else if (!core::files::is_written_directly(*file)) {
            std::error_code ignored;
            fs::remove(*file, ignored);
        }
    }
    return errors;
}

Errors write_finding_files(const FindingFiles& files, const Checks& checks) {
    Errors errors;
    const auto write = [&](const std::string& file, const std::string& text) {
        if (file.empty()) return;
        const Errors found = core::files::write_file_atomically(file, text);
        errors.insert(errors.end(), found.begin(), found.end());
    };
    write(files.junit, junit_xml(checks));
    write(files.sarif, sarif_json(checks));
    write(files.markdown, files.summary_before + markdown_text(checks));
    return errors;
}

}  // namespace fettle::design::cli
