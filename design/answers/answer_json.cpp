// SPDX-License-Identifier: MIT
#include "design/answers/answer_json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/model/model.hpp"
#include "design/description/made_design.hpp"

namespace fettle::design::answers {

using core::clearance::PairClearance;
using core::clearance::PairStatus;
using Json = nlohmann::ordered_json;

std::string shell_word(const std::string& word) {
    if (!word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]{}()<>|&;#~!") == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

Json vector_json(const Vector3& v) { return Json(Json::array_t(v.begin(), v.end())); }

Json finite_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json pair_json(const PairClearance& pair, const std::vector<std::string>& names) {
    Json json;
    json["a"] = names[pair.a];
    json["b"] = names[pair.b];
    json["minimum"] = pair.minimum;
    json["lower"] = pair.lower;
    json["upper"] = pair.upper;
    json["status"] = core::clearance::to_string(pair.status);
    json["clash"] = pair.is_clash();
    json["time"] = pair.witness.time;
    json["point_a"] = vector_json(pair.witness.point_a);
    json["point_b"] = vector_json(pair.witness.point_b);
    return json;
}

PairStatus overall_status(const std::vector<PairClearance>& pairs) {
    PairStatus status = PairStatus::clear;
    for (const PairClearance& pair : pairs) {
        if (pair.status == PairStatus::violated) return PairStatus::violated;
        if (pair.status == PairStatus::undecided) status = PairStatus::undecided;
    }
    return status;
}

Json clearance_json(const std::vector<PairClearance>& pairs, const std::vector<std::string>& names) {
    Json json;
    double minimum = std::numeric_limits<double>::infinity(), least = minimum;
    json["status"] = core::clearance::to_string(overall_status(pairs));
    Json list = Json::array();
    for (const PairClearance& pair : pairs) {
        minimum = std::min(minimum, pair.minimum);
        least = std::min(least, pair.lower);
        list.push_back(pair_json(pair, names));
    }
    json["minimum"] = pairs.empty() ? Json() : Json(minimum);
    json["least"] = pairs.empty() ? Json() : Json(least);
    json["pairs"] = list;
    return json;
}

Json parameters_json(const description::Design& design, const VectorX& values) {
    Json json = Json::object();
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        json[design.parameters[k].name] = description::from_si(values[k], design.parameters[k].unit);
    }
    return json;
}

Json units_json(const description::Design& design) {
    Json json = Json::object();
    for (const description::Parameter& parameter : design.parameters) json[parameter.name] = parameter.unit.name;
    return json;
}

Json gradient_json(const description::Design& design, const VectorX& gradient) {
    Json json = Json::object();
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        json[design.parameters[k].name] = gradient[k] * to_si(1, design.parameters[k].unit);
    }
    return json;
}

Json relations_json(const description::Design& design, const optimisers::Rows& relations) {
    Json list = Json::array();
    for (Eigen::Index i = 0; i < relations.values.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        list.push_back({{"name", relation.name},
                        {"value", relations.values[i]},
                        {"lower", relation.bounds.lower},
                        {"upper", relation.bounds.upper},
                        {"met", description::violation(relation, relations.values[i]) <= 0},
                        {"gradient", gradient_json(design, relations.jacobian.row(i).transpose())}});
    }
    return list;
}

Json continued_json(const problem::DesignEvaluation& evaluation, std::size_t constraint) {
    for (const problem::ContinuedRow& row : evaluation.continued)
        if (row.constraint == static_cast<int>(constraint)) return {{"value", row.value}, {"reason", row.reason}};
    return {};
}

nlohmann::ordered_json over_tolerances_json(const description::Design& design, const problem::DesignEvaluation& evaluation,
                                            bool of_objective, std::size_t index) {
    const problem::RobustRow* row = problem::robust_row(evaluation, of_objective, index);
    if (row == nullptr) return {};
    const description::OverTolerances over =
        of_objective ? *design.objective[index].over_tolerances : *design.constraints[index].bounds.over_tolerances;
    const bool is_sigma = over.kind == description::OverTolerances::Kind::sigma;
    nlohmann::ordered_json json{{"kind", is_sigma                                                 ? "sigma"
                                         : over.kind == description::OverTolerances::Kind::proven ? "proven"
                                                                                                  : "worst_case"}};
    if (is_sigma) json["sigma"] = over.sigmas;
    json["tolerances"] = design.as_made->tolerances.size();
    json["drawn"] = row->drawn.value;
    if (is_sigma) {
        json["mean"] = row->drawn.value + row->mean;
        json["standard_deviation"] = row->standard_deviation;
    }
    json["reserve"] = row->reserve;
    json["at_kink"] = row->is_at_kink;
    if (row->deviations.size() > 0) {
        json["worst_deviations"] = nlohmann::ordered_json::array();
        for (int k = 0; k < count_of(design.as_made->tolerances); ++k)
            json["worst_deviations"].push_back({{"of", design.as_made->tolerances[k].of}, {"value", row->deviations[k]}});
    }
    return json;
}

std::vector<std::string> body_names(const core::model::Model& model) {
    std::vector<std::string> names;
    for (const core::model::Body& body : model.bodies) names.push_back(body.name);
    return names;
}

std::string unit_name(double length_unit) {
    const std::string name = core::base::unit_name(core::base::Dimension::length, length_unit);
    return name.empty() ? "m" : name;
}

}  // namespace fettle::design::answers
