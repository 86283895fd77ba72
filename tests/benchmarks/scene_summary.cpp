// SPDX-License-Identifier: MIT
#include "tests/benchmarks/scene_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fettle::tests::benchmarks {
namespace {

bool is_timed(const SceneRow& row) { return row.program.status == "ok" && row.program.cpu_seconds > 0 && row.program.steps > 0; }

// Bodies and contacts that the steps had to do with: a step costs something for each.
double body_and_contact_steps(const SceneRow& row) {
    return static_cast<double>(row.bodies) * row.steps + static_cast<double>(row.contacts);
}

}  // namespace

void Ratios::add(double ratio, const std::string& scene, bool counts_for_worst) {
    log_sum_ += std::log(ratio);
    ++count_;
    if (!counts_for_worst || (!worst_scene_.empty() && ratio >= worst_)) return;
    worst_ = ratio;
    worst_scene_ = scene;
}

std::string Ratios::json(const std::string& name) const {
    std::string text = "\"" + name + "\": {" + member("geometric_mean", std::exp(log_sum_ / count_));
    text += worst_scene_.empty() ? R"(, "worst": null)" : ", " + member("worst", worst_) + R"(, "worst_scene": ")" + worst_scene_ + "\"";
    return text + ", \"scenes\": " + std::to_string(count_) + "}";
}

std::string member(const std::string& key, double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%.5g", value);
    return "\"" + key + "\": " + (std::isfinite(value) ? text : "null");
}

double reference_ratio(const ReferenceRun* reference, const SceneRow& row) {
    return reference != nullptr && is_timed(row) ? reference->seconds_of(row.program.steps) / row.program.cpu_seconds : 0;
}

std::string summary_json(const std::vector<SceneRow>& rows, const std::vector<ReferenceRun>& references) {
    Ratios all, above_a_second;
    double certify = 0, stepping = 0, largest = 0;
    std::string largest_scene;
    for (const SceneRow& row : rows) {
        if (!is_timed(row)) continue;
        const ReferenceRun* reference = find_reference(references, row.scene);
        if (const double ratio = reference_ratio(reference, row); ratio > 0) {
            all.add(ratio, row.scene);
            if (reference->seconds > 1) above_a_second.add(ratio, row.scene);
        }
        certify += row.program.certify_seconds;
        stepping += row.program.stepping_seconds;
        const double share = row.program.certify_seconds / row.program.stepping_seconds;
        if (row.program.stepping_seconds > 0.05 && share > largest) largest = share, largest_scene = row.scene;
    }
    std::string text;
    if (all.count() > 0) text += all.json("against_reference") + ", ";
    if (above_a_second.count() > 0) text += above_a_second.json("against_reference_above_a_second") + ", ";
    return text + "\"certification\": {" + member("of_stepping", certify / stepping) + ", " + member("largest", largest) +
           R"(, "largest_scene": ")" + largest_scene + "\"}";
}

void print_table(const std::vector<SceneRow>& rows, const std::vector<ReferenceRun>& references) {
    std::fprintf(stderr,
                 "| scene | status | steps | Newton per step | reference, s | whole program, s | times as fast | start | stepping | "
                 "certification | peak MB | least distance, m |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const SceneRow& row : rows) {
        const ProgramRun& run = row.program;
        const bool stepped = row.steps > 0;
        std::fprintf(stderr, "| %s | %s%s | %d ", row.scene.c_str(),
                     stepped && row.status != "ok" ? row.status.c_str() : run.status.c_str(), row.is_sound() ? "" : ", UNSOUND",
                     stepped ? row.steps : run.steps);
        std::fprintf(stderr, stepped ? "| %.2f " : "| ", static_cast<double>(row.newton_iterations) / std::max(row.steps, 1));
        const ReferenceRun* reference = find_reference(references, row.scene);
        if (reference != nullptr)
            std::fprintf(stderr, "| %.4g | %.3g | %.3g ", reference->seconds_of(run.steps), run.cpu_seconds,
                         reference_ratio(reference, row));
        else
            std::fprintf(stderr, "| | %.3g | ", run.cpu_seconds);
        std::fprintf(stderr, "| %.3g | %.3g | %.3g | %.1f | %.3g |\n", run.start_seconds, run.stepping_seconds, run.certify_seconds,
                     run.peak_memory_bytes / 1e6, run.minimum_distance);
    }
}

void print_growth(const std::vector<SceneRow>& rows) {
    const auto per_body = [](const SceneRow& row) { return row.program.cpu_seconds / static_cast<double>(row.bodies) / row.steps; };
    const auto per_body_and_contact = [](const SceneRow& row) { return row.program.cpu_seconds / body_and_contact_steps(row); };
    const auto per_contact = [](const SceneRow& row) { return row.cpu_seconds / static_cast<double>(row.contacts); };
    for (const SceneRow& row : rows) {
        const SceneRow& first = rows.front();
        if (!is_timed(row) || !is_timed(first) || row.contacts == 0 || first.contacts == 0) continue;
        std::printf("{\"growth\": \"%s\", \"bodies\": %ld, %s, %s, %s, %s, %s, %s, %s}\n", row.scene.c_str(), row.bodies,
                    member("contacts_per_step", static_cast<double>(row.contacts) / row.steps).c_str(),
                    member("program_microseconds_per_body_and_step", 1e6 * per_body(row)).c_str(),
                    member("per_body_and_step", per_body(row) / per_body(first)).c_str(),
                    member("program_microseconds_per_body_and_contact", 1e6 * per_body_and_contact(row)).c_str(),
                    member("per_body_and_contact", per_body_and_contact(row) / per_body_and_contact(first)).c_str(),
                    member("stepping_microseconds_per_contact", 1e6 * per_contact(row)).c_str(),
                    member("stepping_per_contact", per_contact(row) / per_contact(first)).c_str());
    }
}

}  // namespace fettle::tests::benchmarks
