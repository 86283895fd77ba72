// SPDX-License-Identifier: MIT
#include "design/report/exploration_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/json_dump.hpp"
#include "design/exports/assembly.hpp"
#include "design/problem/design_problem.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/design_rows.hpp"
#include "design/report/moving_parts.hpp"
#include "design/report/packed_numbers.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_bytes = 12'000'000;  // of meshes in a page

struct Column {
    std::string name, group, key, unit;  // key: of the result's member that has it
    int better = 0;
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower, scale = 1;  // SI, SI, SI of the unit
};

double value_in(const Column& column, const Json& result) {
    const Json value = column.key.empty() ? member(result, column.name) : member(member(result, column.key), column.name);
    return value.is_number() ? value.get<double>() / column.scale : std::numeric_limits<double>::quiet_NaN();
}

Json column_json(const Column& column, const std::vector<Json>& results) {
    std::vector<double> values;
    for (const Json& result : results) values.push_back(value_in(column, result));
    return {{"name", column.name},
            {"group", column.group},
            {"unit", column.unit},
            {"better", column.better},
            {"lower", finite(column.lower / column.scale)},
            {"upper", finite(column.upper / column.scale)},
            {"values", packed(values)}};
}

// The text at a key; null where it is no text: the page takes a value for what it is to be.
Json text_of(const Json& result, const char* key) {
    const Json value = member(result, key);
    return value.is_string() ? value : Json();
}

int better_side(const description::Bounds& bounds) {
    if (std::isfinite(bounds.lower) == std::isfinite(bounds.upper)) return 0;
    return std::isfinite(bounds.lower) ? 1 : -1;
}

std::vector<Column> columns_of(const description::Design& design) {
    std::vector<Column> columns;
    for (const description::Parameter& p : design.parameters) {
        const std::string unit = p.unit.dimension == Dimension::number ? std::string() : std::string(p.unit.name);
        columns.push_back({p.name, "parameter", "parameters", unit, 0, p.lower, p.upper, core::base::to_si(1, p.unit)});
    }
    columns.push_back({"objective", "objective", "", "", -1});
    columns.push_back({"violation", "violation", "", "", -1});
    for (const description::ObjectiveTerm& term : design.objective) {
        const Dimension dimension = term.quantity->dimension();
        columns.push_back(
            {term.name, "term", "terms", core::base::unit_name(dimension, shown_unit(dimension, term.unit)), term.weight < 0 ? 1 : -1});
        columns.back().scale = shown_unit(dimension, term.unit);
    }
    for (const description::Constraint& constraint : design.constraints) {
        const Dimension dimension = constraint.quantity->dimension();
        const double unit = shown_unit(dimension, constraint.bounds.unit);
        columns.push_back({constraint.name, "constraint", "constraints", core::base::unit_name(dimension, unit),
                           better_side(constraint.bounds), constraint.bounds.lower, constraint.bounds.upper, unit});
    }
    return columns;
}

// As the file alone has them, SI.
std::vector<Column> columns_of(const std::vector<Json>& results) {
    std::vector<Column> columns;
    const auto add = [&](const char* group, const char* key, int better) {
        for (const Json& result : results) {
            const Json members = member(result, key);
            if (!members.is_object() || members.empty()) continue;
            for (const auto& [name, value] : members.items()) columns.push_back({name, group, key, "", better});
            return;
        }
    };
    add("parameter", "parameters", 0);
    columns.push_back({"objective", "objective", "", "", -1});
    columns.push_back({"violation", "violation", "", "", -1});
    add("term", "terms", -1);
    add("constraint", "constraints", 0);
    return columns;
}

bool meets_all(const Json& result) {
    const Json violation = member(result, "violation");
    return violation.is_number() && violation.get<double>() <= 0;
}

// Those that meet everything by their objectives, then the others by how far they are from it; what has no numbers is left out.
std::vector<std::size_t> best_first(const std::vector<Json>& results) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < results.size(); ++i)
        if (member(results[i], "objective").is_number() && member(results[i], "violation").is_number()) order.push_back(i);
    const auto rank = [&](std::size_t i) {
        const Json& result = results[i];
        return std::pair(std::max(0.0, result["violation"].get<double>()), result["objective"].get<double>());
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return rank(i) < rank(j); });
    return order;
}

// Nothing if they are not all there, or far outside the bounds, where parts can be too large to be made.
std::optional<VectorX> values_of(const description::Design& design, const Json& result) {
    VectorX p(design.parameters.size());
    for (std::size_t k = 0; k < design.parameters.size(); ++k) {
        const Json value = member(member(result, "parameters"), design.parameters[k].name);
        if (!value.is_number()) return std::nullopt;
        p[k] = value.get<double>();
    }
    if (!description::check_values(design.parameters, p).empty()) return std::nullopt;
    return p;
}

core::stepper::Trajectory at_start(const core::model::Model& model) {
    core::stepper::Trajectory trajectory;
    trajectory.poses.emplace_back();
    for (const core::model::Body& body : model.bodies) {
        trajectory.body_names.push_back(body.name);
        trajectory.poses.back().push_back(body.pose_start);
    }
    return trajectory;
}

// Meshes of several designs, each once: most parts of most designs are the same.
class SharedMeshes {
public:
    /// Takes back those of the last view's meshes that are there already.
    void share(Json& data, std::size_t first) {
        Json added = Json::array();
        std::vector<std::size_t> place;
        for (std::size_t i = first; i < data["meshes"].size(); ++i) {
            const auto [at, is_new] = known_.try_emplace(core::files::dumped(data["meshes"][i]), first + added.size());
            if (is_new) added.push_back(data["meshes"][i]);
            if (is_new) bytes_ += at->first.size();
            place.push_back(at->second);
        }
        data["meshes"].erase(data["meshes"].begin() + static_cast<std::ptrdiff_t>(first), data["meshes"].end());
        for (Json& mesh : added) data["meshes"].push_back(std::move(mesh));
        for (Json& body : data["views"].back()["bodies"]) body["mesh"] = place.at(body["mesh"].get<std::size_t>() - first);
    }
    std::size_t bytes() const { return bytes_; }

private:
    std::map<std::string, std::size_t> known_;
    std::size_t bytes_ = 0;
};

void add_parts(Json& data, const ExplorationSource& source, const std::function<bool()>& should_stop) {
    const Result<problem::DesignProblem> problem = problem::DesignProblem::create(*source.design);
    if (!problem) {
        data["notices"].push_back("No parts are shown: " + problem.errors().front().message);
        return;
    }
    SharedMeshes shared;
    for (const std::size_t i : best_first(source.results)) {
        if (should_stop() || data["views"].size() == most_shown_designs || shared.bytes() > most_bytes) break;
        const std::optional<VectorX> p = values_of(*source.design, source.results[i]);
        const Result<core::model::Model> model =
            p ? problem->model_at(*p) : Result<core::model::Model>(Error{ErrorCode::missing_key, "", ""});
        if (!model) continue;
        const std::size_t first = data["meshes"].size();
        data["designs"][i]["view"] = data["views"].size();
        add_view(data, std::to_string(i), *model, at_start(*model));
        shared.share(data, first);
    }
}

}  // namespace

Json exploration_data(const ExplorationSource& source, const std::function<bool()>& should_stop) {
    const std::string own = core::base::version();
    const Json program = text_of(source.header, "program");
    Json data{{"format", 1}, {"program", program.is_null() ? Json(own) : program}};
    if (data["program"] != own) data["made_by_other"] = own;
    data["kind"] = "explore";
    data["name"] = source.name;
    data["folder"] = source.folder;
    data["description"] = source.description.empty() ? Json() : Json(source.description);
    data["design"] = source.design_path.empty() ? Json() : Json(source.design_path);
    const Vector3 up = exports::up_of(source.design ? source.design->scene.gravity : Vector3(Vector3::Zero()));
    data["up"] = {up.x(), up.y(), up.z()};
    data["notices"] = source.notices;
    data["columns"] = data["designs"] = data["meshes"] = data["views"] = data["files"] = Json::array();
    for (const Column& column : source.design ? columns_of(*source.design) : columns_of(source.results))
        data["columns"].push_back(column_json(column, source.results));
    for (const Json& result : source.results)
        data["designs"].push_back({{"status", member(result, "status")},
                                   {"kind", text_of(result, "kind")},
                                   {"seed", member(result, "seed").is_number() ? member(result, "seed") : Json()},
                                   {"met", meets_all(result)},
                                   {"reason", text_of(result, "reason")},
                                   {"view", Json()}});
    if (source.design) add_parts(data, source, should_stop);
    return data;
}

}  // namespace fettle::design::report
