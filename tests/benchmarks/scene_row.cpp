// SPDX-License-Identifier: MIT
#include "tests/benchmarks/scene_row.hpp"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/files/atomic_file.hpp"
#include "core/files/json_document.hpp"

namespace fettle::tests::benchmarks {
namespace {

using core::files::JsonDocument;
using core::files::JsonNode;

std::string number(double x) {
    if (!std::isfinite(x)) return "null";
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' || c == '\t' ? ' ' : c;
    }
    return out + '"';
}

std::string program_json(const ProgramRun& run) {
    std::string out = "{\"status\": " + quoted(run.status);
    if (!run.message.empty()) out += ", \"message\": " + quoted(run.message);
    for (const auto& [key, value] : {std::pair{"cpu_seconds", run.cpu_seconds},
                                     {"wall_seconds", run.wall_seconds},
                                     {"start_seconds", run.start_seconds},
                                     {"stepping_seconds", run.stepping_seconds},
                                     {"certify_seconds", run.certify_seconds},
                                     {"peak_memory_bytes", run.peak_memory_bytes},
                                     {"minimum_distance", run.minimum_distance}})
        out += ", " + quoted(key) + ": " + number(value);
    return out + ", \"steps\": " + std::to_string(run.steps) + "}";
}

ProgramRun read_program(const JsonNode& node) {
    ProgramRun run;
    if (!node.exists()) return run;
    const auto real = [&](const char* key) { return node[key].unless_null().number().value_or(std::numeric_limits<double>::infinity()); };
    run.status = node["status"].string().value_or("");
    run.message = node["message"].string().value_or("");
    run.cpu_seconds = real("cpu_seconds");
    run.wall_seconds = real("wall_seconds");
    run.start_seconds = real("start_seconds");
    run.stepping_seconds = real("stepping_seconds");
    run.certify_seconds = real("certify_seconds");
    run.peak_memory_bytes = real("peak_memory_bytes");
    run.minimum_distance = real("minimum_distance");
    run.steps = static_cast<int>(node["steps"].number().value_or(0));
    return run;
}

SceneRow read_row(const JsonNode& node) {
    SceneRow row;
    const auto text = [&](const char* key) { return node[key].string().value_or(""); };
    const auto real = [&](const char* key) { return node[key].unless_null().number().value_or(std::numeric_limits<double>::infinity()); };
    const auto whole = [&](const char* key) { return static_cast<long>(node[key].number().value_or(0)); };
    row.scene = text("scene");
    row.status = text("status");
    row.message = text("message");
    row.bodies = whole("bodies");
    row.triangles = whole("triangles");
    row.steps = static_cast<int>(whole("steps"));
    row.steps_wanted = static_cast<int>(whole("steps_wanted"));
    row.newton_iterations = whole("newton_iterations");
    row.contacts = whole("contacts");
    row.cpu_seconds = real("cpu_seconds");
    row.wall_seconds = real("wall_seconds");
    row.build_seconds = real("build_seconds");
    for (const auto& [name, seconds] : node["phases"].members()) row.phases[name] = seconds.number().value_or(0);
    row.peak_memory_bytes = real("peak_memory_bytes");
    row.minimum_distance = real("minimum_distance");
    row.finite = node["finite"].boolean().value_or(false);
    row.repeatable = node["repeatable"].boolean().value_or(false);
    row.bits = std::strtoull(text("bits").c_str(), nullptr, 16);
    row.steps_checked = static_cast<int>(whole("steps_checked"));
    row.intersections = whole("intersections");
    row.first_intersection = text("first_intersection");
    row.program = read_program(node["program"]);
    return row;
}

}  // namespace

std::string to_json(const SceneRow& row, const std::string& extra) {
    std::string out = "{";
    const auto add = [&](const char* key, const std::string& value) {
        if (out.size() > 1) out += ", ";
        out += quoted(key) + ": " + value;
    };
    add("scene", quoted(row.scene));
    add("status", quoted(row.status));
    if (!row.message.empty()) add("message", quoted(row.message));
    if (row.program.status != ProgramRun().status) add("program", program_json(row.program));
    add("bodies", std::to_string(row.bodies));
    add("triangles", std::to_string(row.triangles));
    add("steps", std::to_string(row.steps));
    add("steps_wanted", std::to_string(row.steps_wanted));
    add("newton_iterations", std::to_string(row.newton_iterations));
    add("contacts", std::to_string(row.contacts));
    add("seconds_per_step", number(row.seconds_per_step()));
    if (!extra.empty()) out += ", " + extra;
    add("cpu_seconds", number(row.cpu_seconds));
    add("wall_seconds", number(row.wall_seconds));
    add("build_seconds", number(row.build_seconds));
    std::string phases = "{";
    for (const auto& [name, seconds] : row.phases) phases += (phases.size() > 1 ? ", " : "") + quoted(name) + ": " + number(seconds);
    add("phases", phases + "}");
    add("peak_memory_bytes", number(row.peak_memory_bytes));
    add("memory_limit_bytes", number(row.memory_limit_bytes()));
    add("minimum_distance", number(row.minimum_distance));
    add("finite", row.finite ? "true" : "false");
    add("repeatable", row.repeatable ? "true" : "false");
    char bits[20];
    std::snprintf(bits, sizeof bits, "%016" PRIx64, row.bits);
    add("bits", quoted(bits));
    add("steps_checked", std::to_string(row.steps_checked));
    add("intersections", std::to_string(row.intersections));
    if (!row.first_intersection.empty()) add("first_intersection", quoted(row.first_intersection));
    return out + "}";
}

std::optional<SceneRow> row_from_json(const std::string& text) {
    auto document = JsonDocument::parse(text, "row");
    if (!document) return std::nullopt;
    return read_row(document->root());
}

std::optional<std::vector<SceneRow>> read_baseline(const std::string& path) {
    auto document = JsonDocument::read(path);
    if (!document) {
        std::fprintf(stderr, "%s: %s\n", document.errors().front().where.c_str(), document.errors().front().message.c_str());
        return std::nullopt;
    }
    std::vector<SceneRow> rows;
    for (const JsonNode& row : document->root()["rows"].elements()) rows.push_back(read_row(row));
    return rows;
}

bool write_baseline(const std::string& path, const std::vector<SceneRow>& rows) {
    std::string text = "{\"scenes_baseline\": 1, \"rows\": [";
    for (std::size_t i = 0; i < rows.size(); ++i) text += (i > 0 ? ",\n  " : "\n  ") + to_json(rows[i]);
    return core::files::write_file_atomically(path, text + "\n]}\n").empty();
}

const SceneRow* find_row(const std::vector<SceneRow>& rows, const std::string& scene) {
    for (const SceneRow& row : rows)
        if (row.scene == scene) return &row;
    return nullptr;
}

}  // namespace fettle::tests::benchmarks
