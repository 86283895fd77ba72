// SPDX-License-Identifier: MIT
#include "design/reading/process_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_keys.hpp"
#include "core/files/nearest_word.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::reading {

const std::string process_ending = ".process.json";

namespace {

namespace fs = std::filesystem;
using core::files::JsonDocument;
using core::files::JsonNode;
using core::files::not_negative;
using core::files::positive;
using Json = nlohmann::ordered_json;
using tolerances::FeatureSpread;
using tolerances::Process;

std::string name_of_file(const std::string& path) {
    const std::string name = fs::path(path).filename().string();
    return name.ends_with(process_ending) ? name.substr(0, name.size() - process_ending.size()) : name;
}

class ProcessReader {
public:
    ProcessReader(const JsonNode& root, const std::string& path) : root_(root), path_(path) {}

    Process read() {
        if (!core::files::is_format(root_, "fettle_process", "process", 1)) return {};
        root_.allow_keys(
            {"$schema", "fettle_process", "description", "units", "based_on", "correlation", "minimum_gap", "part_tolerance", "features"});
        root_["$schema"].string();
        const auto unit = root_.require("units").choice({"um", "mm", "cm", "m", "in", "ft"});
        if (!unit) return {};
        unit_ = core::base::si_per_unit(*unit, core::base::Dimension::length).value();
        Process process = based_on();
        process.name = name_of_file(path_);
        process.description = root_["description"].string().value_or(process.description);
        process.correlation = root_["correlation"].number({0, 1}).value_or(process.correlation);
        read_features(process);
        read_clearance(process);
        return process;
    }

private:
    Process based_on() const {
        const JsonNode node = root_["based_on"];
        const auto name = node.exists() ? node.choice(tolerances::known_process_names()) : std::nullopt;
        Process process = name ? *tolerances::find_known_process(*name) : Process{};
        if (process.clearance) process.clearance->minimum_of = process.clearance->bands_of = *name;
        return process;
    }

    void read_features(Process& process) {
        const JsonNode features = root_["features"];
        if (!features.exists() && !root_["based_on"].exists())
            root_.fail(ErrorCode::missing_key, "a process has `features`, or is `based_on` one that has");
        std::vector<std::string_view> names = tolerances::feature_kind_names();
        std::erase(names, tolerances::to_string(tolerances::FeatureKind::angle));
        if (features.exists()) features.allow_keys(names);
        for (const std::string_view name : names) {
            if (!features.exists() || !features.is_object() || !features[name].exists()) continue;
            FeatureSpread feature = read_feature(features[name]);
            feature.kind = *tolerances::feature_kind(name);
            std::erase_if(process.features, [&](const FeatureSpread& each) { return each.kind == feature.kind; });
            process.features.push_back(std::move(feature));
        }
        std::sort(process.features.begin(), process.features.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
    }

    FeatureSpread read_feature(const JsonNode& node) const {
        FeatureSpread feature;
        node.allow_keys({"bias", "bias_per_size", "spread", "tolerance", "tolerance_per_size", "per_size_over", "general", "from", "up_to",
                         "correlation", "source", "measured"});
        if (!node.is_object()) return feature;
        feature.bias = node["bias"].length(unit_).value_or(0);
        feature.bias_per_size = node["bias_per_size"].number({-1, 1}).value_or(0);
        const int ways = node["spread"].exists() + node["tolerance"].exists() + node["general"].exists();
        if (ways != 1)
            node.fail(ways == 0 ? ErrorCode::missing_key : ErrorCode::inconsistent,
                      "a feature has a `spread` (one standard deviation), a `tolerance` (+-, three of them), or a class of ISO 2768-1 as "
                      "`general`: one of these");
        const auto spread = node["spread"].length(unit_, not_negative), tolerance = node["tolerance"].length(unit_, not_negative);
        feature.tolerance = spread ? 3 * *spread : tolerance.value_or(0);
        feature.tolerance_per_size = node["tolerance_per_size"].number({0, 1}).value_or(0);
        feature.per_size_over = node["per_size_over"].length(unit_, not_negative).value_or(0);
        feature.general_class = node["general"].choice({"f", "m", "c", "v"}).value_or("");
        if (node["general"].exists() && node["tolerance_per_size"].exists())
            node["tolerance_per_size"].fail(ErrorCode::inconsistent, "a class has limits by size of its own");
        if (node["per_size_over"].exists() && !node["tolerance_per_size"].exists())
            node["per_size_over"].fail(ErrorCode::inconsistent, "`per_size_over` goes with `tolerance_per_size`");
        feature.from = node["from"].length(unit_, not_negative).value_or(feature.from);
        feature.up_to = node["up_to"].length(unit_, positive).value_or(feature.up_to);
        if (feature.from > feature.up_to) node["from"].fail(ErrorCode::inconsistent, "`from` is above `up_to`");
        if (node["correlation"].exists()) feature.correlation = node["correlation"].number({0, 1});
        feature.source = node["source"].string().value_or(path_);
        return feature;
    }

    // Lengths of its own say what faces of parts are off by, unless `part_tolerance` does.
    void read_clearance(Process& process) const {
        const auto minimum = root_["minimum_gap"].length(unit_, not_negative);
        const auto part = root_["part_tolerance"].length(unit_, not_negative);
        if (minimum) process.clearance = tolerances::ClearanceNeed{*minimum, path_, {}, {}, {}};
        if (part && !process.clearance)
            root_["part_tolerance"].fail(ErrorCode::inconsistent, "`part_tolerance` goes with `minimum_gap`, or with `based_on`");
        if (!process.clearance) return;
        if (root_["features"].exists() && root_["features"].is_object() && root_["features"]["length"].exists())
            process.clearance->bands.clear();
        if (part) process.clearance->bands = {{std::numeric_limits<double>::infinity(), *part, path_}};
        if (part || process.clearance->bands.empty()) process.clearance->bands_of.clear();
    }

    const JsonNode& root_;
    const std::string& path_;
    double unit_ = 1;
};

fs::path file_of(const std::string& name, const std::string& folder) {
    return fs::path(folder) / (name.ends_with(process_ending) ? name : name + process_ending);
}

// Names of the profiles of a folder.
std::vector<std::string> profiles_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, code))
        if (entry.path().filename().string().ends_with(process_ending)) names.push_back(name_of_file(entry.path().string()));
    std::sort(names.begin(), names.end());
    return names;
}

// [m] in millimetres, to the nanometre.
double in_mm(double metres) { return std::round(metres * 1e9) / 1e6; }
double rounded(double ratio) { return std::round(ratio * 1e9) / 1e9; }

Json feature_json(const FeatureSpread& feature, const tolerances::KindFit& fit) {
    Json json = {{"bias", in_mm(feature.bias)}};
    if (fit.has_slope) json["bias_per_size"] = rounded(feature.bias_per_size);
    if (has_spread(fit)) {
        json["spread"] = in_mm(feature.tolerance / 3);
    } else if (!feature.general_class.empty()) {
        json["general"] = feature.general_class;
    } else {
        json["tolerance"] = in_mm(feature.tolerance);
        json["tolerance_per_size"] = feature.tolerance_per_size;
        json["per_size_over"] = in_mm(feature.per_size_over);
    }
    json["from"] = in_mm(feature.from);
    json["up_to"] = in_mm(feature.up_to);
    if (feature.correlation) json["correlation"] = rounded(*feature.correlation);
    json["source"] = feature.source;
    json["measured"] = {{"features", fit.features},
                        {"measurements", fit.measurements},
                        {"mean_size", in_mm(fit.mean_size)},
                        {"bias_at_mean_size", {in_mm(fit.bias.value), in_mm(fit.bias.least), in_mm(fit.bias.most)}},
                        {"spread", {in_mm(fit.spread.value), in_mm(fit.spread.least), in_mm(fit.spread.most)}}};
    if (!fit.components) return json;
    const tolerances::Interval &between = fit.components->between, &share = fit.components->share;
    json["measured"]["prints"] = fit.prints;
    json["measured"]["between_prints"] = {in_mm(between.value), in_mm(between.least), in_mm(between.most)};
    json["measured"]["shared"] = {rounded(share.value), rounded(share.least), rounded(share.most)};
    return json;
}

}  // namespace

Result<Process> parse_process(const std::string& text, const std::string& path) {
    Result<JsonDocument> document = JsonDocument::parse(text, path);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    const Process process = ProcessReader(root, path).read();
    if (!document->errors().empty()) return document->errors();
    return process;
}

Result<Process> read_process(const std::string& path) {
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    return parse_process(*text, path);
}

Result<Process> find_process(const std::string& name, const std::string& folder, const std::string& where) {
    if (const Process* known = tolerances::find_known_process(name)) return *known;
    const bool is_file = name.ends_with(process_ending);
    const fs::path path = file_of(name, folder);
    std::error_code code;
    if (!name.empty() && fs::exists(path, code)) return read_process(path.string());
    if (is_file)
        return Error{ErrorCode::file_not_found, where, "there is no file " + path.string() + " (a process as `fettle process` writes it)"};
    const std::vector<std::string> own = profiles_in(folder);
    std::vector<std::string_view> all = tolerances::known_process_names();
    all.insert(all.end(), own.begin(), own.end());
    return Error{ErrorCode::out_of_range, where,
                 "there is no process \"" + name + "\", nor a file " + path.string() + "; " + core::files::did_you_mean(name, all)};
}

std::string process_name_from(const std::string& name, const std::string& folder, const std::string& other) {
    if (tolerances::find_known_process(name) != nullptr) return name;
    const fs::path path = file_of(name, folder);
    std::error_code failure;
    const fs::path relative = fs::relative(fs::absolute(path), fs::current_path() / other, failure);
    return failure || relative.empty() ? fs::absolute(path).string() : relative.generic_string();
}

std::string process_text(const tolerances::ProcessFit& fit, const Process& fitted, const std::string& based_on) {
    Json features = Json::object();
    for (const tolerances::KindFit& kind : fit.kinds)
        features[tolerances::to_string(kind.kind)] = feature_json(*tolerances::find_feature(fitted, kind.kind), kind);
    const Json json = {{"fettle_process", 1},  {"description", fitted.description}, {"units", "mm"},
                       {"based_on", based_on}, {"correlation", fitted.correlation}, {"features", std::move(features)}};
    return core::files::dumped(json, 2) + "\n";
}

}  // namespace fettle::design::reading
