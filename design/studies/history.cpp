// SPDX-License-Identifier: MIT
#include "design/studies/history.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "core/base/version.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_text.hpp"

namespace fettle::design::studies {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json to_json(const VectorX& v) { return std::vector<double>(v.data(), v.data() + v.size()); }

VectorX to_vector(const Json& json) {
    const auto values = json.get<std::vector<double>>();
    return Eigen::Map<const VectorX>(values.data(), values.size());
}

Json rows_json(const MatrixX& matrix) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(to_json(matrix.row(i).transpose()));
    return rows;
}

// Throws if a row has another length.
MatrixX to_matrix(const Json& rows, Eigen::Index columns) {
    MatrixX matrix(rows.size(), columns);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        const VectorX row = to_vector(rows[i]);
        if (row.size() != columns) throw std::runtime_error("sizes do not match the header");
        matrix.row(i) = row.transpose();
    }
    return matrix;
}

Json branches_json(const optimisers::Branches& branches) {
    return {{"of", branches.of}, {"values", to_json(branches.values)}, {"jacobian", rows_json(branches.jacobian)}};
}

// None where the key is not there. Throws if sizes do not agree, or one is of a function that is not there.
optimisers::Branches to_branches(const Json& entry, const char* key, Eigen::Index columns, int functions) {
    optimisers::Branches branches;
    branches.jacobian.resize(0, columns);
    if (!entry.contains(key)) return branches;
    branches.of = entry.at(key).at("of").get<std::vector<int>>();
    branches.values = to_vector(entry.at(key).at("values"));
    branches.jacobian = to_matrix(entry.at(key).at("jacobian"), columns);
    const auto count = static_cast<Eigen::Index>(branches.of.size());
    const bool known = std::all_of(branches.of.begin(), branches.of.end(), [&](int i) { return i >= 0 && i < functions; });
    if (branches.values.size() != count || branches.jacobian.rows() != count || !known)
        throw std::runtime_error("sizes do not match the header");
    return branches;
}

Json named(const std::vector<std::pair<std::string, double>>& values) {
    Json json = Json::object();
    for (const auto& [name, value] : values) json[name] = value;
    return json;
}

std::vector<std::pair<std::string, double>> named_values(const Json& json) {
    std::vector<std::pair<std::string, double>> values;
    for (const auto& [name, value] : json.items()) values.emplace_back(name, value.get<double>());
    return values;
}

std::string header_line(const HistoryHeader& header) {
    Json json;
    json["fettle_history"] = 1;
    json["design"] = header.design_hash;
    json["program"] = core::base::version();
    json["parameters"] = header.parameters;
    json["constraints"] = header.constraints;
    return core::files::dumped(json);
}

std::string entry_line(const HistoryEntry& entry, const HistoryHeader& header, int number) {
    const optimisers::Evaluation& e = entry.evaluation;
    Json json;
    json["evaluation"] = number;
    json["usable"] = e.usable;
    if (!entry.model.empty()) json["model"] = entry.model;
    if (!e.usable) json["reason"] = e.reason;
    Json parameters = Json::object();
    for (size_t k = 0; k < header.parameters.size(); ++k) parameters[header.parameters[k]] = entry.point[k];
    json["parameters"] = parameters;
    if (e.usable) {
        json["objective"] = e.objective;
        json["constraints"] = to_json(e.constraints);
        if (e.measured.size() > 0) json["measured"] = to_json(e.measured);
        if (e.has_derivatives) {
            json["gradient"] = to_json(e.gradient);
            json["jacobian"] = rows_json(e.jacobian);
        }
        if (e.residuals.size() > 0) {
            json["residuals"] = to_json(e.residuals);
            json["residual_jacobian"] = rows_json(e.residual_jacobian);
        }
        if (!e.constraint_branches.of.empty()) json["constraint_branches"] = branches_json(e.constraint_branches);
        if (!e.objective_branches.of.empty()) json["objective_branches"] = branches_json(e.objective_branches);
        json["violation"] = e.violation;
        json["terms"] = named(entry.terms);
        json["certified"] = named(entry.certified);
    }
    json["forward_seconds"] = entry.forward_seconds;
    json["backward_seconds"] = entry.backward_seconds;
    return core::files::dumped(json);
}

HistoryEntry parsed_entry(const std::string& line, const HistoryHeader& header) {
    if (!core::files::is_safe_json_text(line)) throw std::runtime_error("is not JSON of a history");
    const Json json = Json::parse(line);
    HistoryEntry entry;
    entry.model = json.value("model", std::string());
    const auto n = static_cast<Eigen::Index>(header.parameters.size());
    entry.point.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) entry.point[k] = json.at("parameters").at(header.parameters[k]).get<double>();
    optimisers::Evaluation& e = entry.evaluation;
    e.usable = json.at("usable").get<bool>();
    entry.forward_seconds = json.at("forward_seconds").get<double>();
    entry.backward_seconds = json.at("backward_seconds").get<double>();
    if (!e.usable) {
        e.reason = json.at("reason").get<std::string>();
        return entry;
    }
    e.objective = json.at("objective").get<double>();
    e.has_derivatives = json.contains("gradient");
    e.constraints = to_vector(json.at("constraints"));
    if (json.contains("measured")) e.measured = to_vector(json.at("measured"));
    if (e.has_derivatives) {
        e.gradient = to_vector(json.at("gradient"));
        e.jacobian = to_matrix(json.at("jacobian"), n);
    }
    if (json.contains("residuals")) {
        e.residuals = to_vector(json.at("residuals"));
        e.residual_jacobian = to_matrix(json.at("residual_jacobian"), n);
    }
    e.constraint_branches = to_branches(json, "constraint_branches", n, count_of(header.constraints));
    e.objective_branches = to_branches(json, "objective_branches", n, std::numeric_limits<int>::max());
    e.violation = json.at("violation").get<double>();
    entry.terms = named_values(json.at("terms"));
    entry.certified = named_values(json.at("certified"));
    const auto m = static_cast<Eigen::Index>(header.constraints.size());
    if (e.constraints.size() != m || (e.measured.size() > 0 && e.measured.size() != m) ||
        (e.has_derivatives && (e.gradient.size() != n || e.jacobian.rows() != m)))
        throw std::runtime_error("sizes do not match the header");
    return entry;
}

Errors header_errors(const std::string& line, const HistoryHeader& header, const std::string& path) {
    const Json json = core::files::is_safe_json_text(line) ? Json::parse(line, nullptr, false) : Json();
    const auto has = [&](const char* key, const Json& value) { return json.contains(key) && json[key] == value; };
    if (json.is_discarded() || !json.is_object() || !has("fettle_history", 1)) {
        return {{ErrorCode::parse, path + ": line 1", "this is not a history of fettle; give --out another folder"}};
    }
    if (!has("design", header.design_hash) || !has("parameters", header.parameters) || !has("constraints", header.constraints)) {
        const std::string hash = json.contains("design") && json["design"].is_string() ? json["design"].get<std::string>() : "none";
        return {{ErrorCode::inconsistent, path,
                 "this is the history of another design, scene or version (hash " + hash + ", now " + header.design_hash +
                     "); run without --resume to start anew (this file is kept), or give --out another folder"}};
    }
    return {};
}

std::string bits_of(const VectorX& x) {
    std::string key(static_cast<size_t>(x.size()) * sizeof(double), '\0');
    std::memcpy(key.data(), x.data(), key.size());
    return key;
}

}  // namespace

Errors history_faults(const std::string& text, const std::string& path) {
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line)) return {};
    HistoryHeader header;
    int number = 1;
    const auto fault = [&](const std::string& what) {
        return Errors{{ErrorCode::parse, path + ": line " + std::to_string(number), "damaged: " + what}};
    };
    try {
        const Json json = core::files::is_safe_json_text(line) ? Json::parse(line) : Json();
        if (!json.is_object() || json.at("fettle_history") != 1) return fault("this is not a history of fettle");
        header.parameters = json.at("parameters").get<std::vector<std::string>>();
        header.constraints = json.at("constraints").get<std::vector<std::string>>();
        for (number = 2; std::getline(lines, line); ++number) static_cast<void>(parsed_entry(line, header));
    } catch (const std::exception& e) {
        return fault(e.what());
    }
    return {};
}

Result<History> History::open(const std::string& directory, const HistoryHeader& header, LineFileMode mode) {
    const std::string path = (fs::path(directory) / "history.jsonl").string();
    Result<LineFile> file = LineFile::open(path, mode, "history");
    if (!file) return file.errors();
    History history(std::move(file).value(), header);
    Errors errors = history.read_existing(path);
    if (!errors.empty()) return errors;
    return history;
}

Errors History::read_existing(const std::string& path) {
    const std::vector<std::string>& lines = file_.found();
    if (!lines.empty()) {
        Errors errors = header_errors(lines.front(), header_, path);
        if (!errors.empty()) return errors;
    }
    for (std::size_t k = 1; k < lines.size(); ++k) {
        try {
            replayed_.push_back(parsed_entry(lines[k], header_));
        } catch (const std::exception& e) {
            // A last line can be whole and yet damaged, when a machine lost power; earlier ones cannot.
            if (k + 1 == lines.size()) break;
            return {{ErrorCode::parse, path + ": line " + std::to_string(k + 1), std::string("damaged: ") + e.what()}};
        }
    }
    entries_ = count_of(replayed_);
    if (!lines.empty()) return file_.keep(1 + replayed_.size());
    Errors errors = file_.keep(0);
    if (!errors.empty()) return errors;
    file_.append(header_line(header_));
    return unwritten();
}

void History::append(const HistoryEntry& entry) { file_.append(entry_line(entry, header_, ++entries_)); }

std::function<optimisers::Evaluation(const VectorX&)> recorded(History& history, std::function<HistoryEntry(const VectorX&)> evaluate,
                                                               const std::string& model, Recorded wanted) {
    const bool derivatives = wanted == Recorded::with_derivatives;
    std::map<std::string, optimisers::Evaluation> known;
    for (const HistoryEntry& entry : history.replayed()) {
        const optimisers::Evaluation& e = entry.evaluation;
        if (entry.model == model && (!e.usable || e.has_derivatives == derivatives)) known[bits_of(entry.point)] = e;
    }
    return [&history, model, known = std::move(known), evaluate = std::move(evaluate)](const VectorX& point) {
        const auto found = known.find(bits_of(point));
        if (found != known.end()) return found->second;
        HistoryEntry entry = evaluate(point);
        entry.model = model;
        history.append(entry);
        return entry.evaluation;
    };
}

}  // namespace fettle::design::studies
