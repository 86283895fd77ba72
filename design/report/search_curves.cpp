// SPDX-License-Identifier: MIT
#include "design/report/search_curves.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "design/report/answer_values.hpp"
#include "design/report/design_rows.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;

Json at_key(const Json& entry, const char* key) { return entry.contains(key) && entry[key].is_number() ? entry[key] : Json(); }

double spare(const description::Constraint& constraint, double value) {
    const description::Bounds& bounds = constraint.bounds;
    return std::min(value - bounds.lower, bounds.upper - value) / shown_unit(constraint.quantity->dimension(), bounds.unit);
}

}  // namespace

Json search_curves(const std::string& text, const description::Design& design) {
    Json curves{{"objective", Json::array()}, {"violation", Json::array()}, {"own", Json::array()}, {"model", Json::array()}};
    std::vector<Json> shares(design.parameters.size(), Json::array()), spares(design.constraints.size(), Json::array());
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);  // the header
    while (std::getline(lines, line)) {
        const Json entry = parsed_json(line);
        if (!entry.is_object() || !entry.contains("parameters")) continue;
        curves["objective"].push_back(at_key(entry, "objective"));
        curves["violation"].push_back(at_key(entry, "violation"));
        curves["own"].push_back(!entry.contains("model"));
        const Json model = member(entry, "model");
        curves["model"].push_back(model.is_string() ? model : Json("as written"));
        for (std::size_t k = 0; k < shares.size(); ++k) {
            const description::Parameter& p = design.parameters[k];
            const Json value = at_key(entry["parameters"], p.name.c_str());
            shares[k].push_back(value.is_null() ? Json() : finite((value.get<double>() - p.lower) / (p.upper - p.lower)));
        }
        const Json values = member(entry, entry.contains("measured") ? "measured" : "constraints");
        for (std::size_t i = 0; i < spares.size(); ++i)
            spares[i].push_back(values.is_array() && i < values.size() && values[i].is_number()
                                    ? finite(spare(design.constraints[i], values[i].get<double>()))
                                    : Json());
    }
    curves["parameters"] = shares;
    curves["constraints"] = Json::array();
    for (std::size_t i = 0; i < spares.size(); ++i)
        curves["constraints"].push_back({{"name", design.constraints[i].name}, {"spare", std::move(spares[i])}});
    return curves;
}

}  // namespace fettle::design::report
