// SPDX-License-Identifier: MIT
#include "fettle/design/reading/tolerance_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/scene/place.hpp"
#include "fettle/design/reading/parameter_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Parameter;
using description::Tolerance;

std::vector<std::string_view> names_of(const std::vector<Parameter>& parameters, const std::vector<core::scene::Variable>& variables) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    for (const core::scene::Variable& variable : variables) names.push_back(variable.name);
    return names;
}

// The parameter of this name; a variable becomes one. Nothing: there is none, which is told.
std::optional<int> parameter_of(const JsonNode& node, const std::string& name, const std::vector<core::scene::Variable>& variables,
                                const Unit& length_unit, std::vector<Parameter>& parameters) {
    const auto is_named = [&](const auto& each) { return each.name == name; };
    const auto known = std::find_if(parameters.begin(), parameters.end(), is_named);
    if (known != parameters.end()) return static_cast<int>(known - parameters.begin());
    const auto variable = std::find_if(variables.begin(), variables.end(), is_named);
    if (variable == variables.end()) {
        node.fail(ErrorCode::out_of_range, "there is no parameter and no variable of the scene `" + name + "`; " +
                                               core::files::did_you_mean(name, names_of(parameters, variables), '`') +
                                               "; a place of the scene begins with \"/\"");
        return std::nullopt;
    }
    if (!variable->formula.is_constant()) {
        node.fail(ErrorCode::unsupported,
                  "variable `" + name +
                      "` follows from others, so that it has no size of its own: give the tolerance to these, or to "
                      "the place that it is used at");
        return std::nullopt;
    }
    Parameter parameter;
    parameter.name = name;
    parameter.value = parameter.lower = parameter.upper = variable->value;
    parameter.unit = usual_unit(named_dimension(variable->formula.dimension).value_or(Dimension::number), length_unit);
    parameters.push_back(parameter);
    return count_of(parameters) - 1;
}

constexpr const char* default_name = "*";

}  // namespace

std::vector<ToleranceEntry> read_tolerances(const JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                            const ToleranceUnits& units, std::vector<Parameter>& parameters) {
    std::vector<ToleranceEntry> entries;
    for (const auto& [name, entry] : node.members()) {
        if (name == default_name) continue;
        Tolerance tolerance;
        tolerance.of = name;
        if (name.starts_with("/")) {
            entries.push_back({std::move(tolerance), entry, true});
            continue;
        }
        const std::optional<int> parameter = parameter_of(entry, name, variables, units.length, parameters);
        if (!parameter) continue;
        tolerance.parameter = *parameter;
        read_entry(entry, {parameters[*parameter].value, parameters[*parameter].unit}, units, tolerance);
        entries.push_back({std::move(tolerance), entry, false});
    }
    return entries;
}

std::vector<Untoleranced> add_default_tolerances(const JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                 const ToleranceUnits& units,
                                                 const std::function<std::string(const std::string&)>& why_fixed,
                                                 std::vector<Parameter>& parameters, std::vector<ToleranceEntry>& entries) {
    if (!node.is_object() || !node[default_name].exists()) return {};
    const JsonNode entry = node[default_name];
    const bool is_feature = entry.is_string() && tolerances::feature_kind(*entry.string());
    const bool is_known = entry.is_object() && (entry["general"].exists() || entry["feature"].exists() || entry["process"].exists());
    if (!is_feature && !is_known) {
        entry.fail(
            ErrorCode::inconsistent,
            "what holds for every other length is {\"general\": \"m\"} (ISO 2768), or what a process makes: \"length\", {\"feature\": "
            "\"length\", \"process\": \"fdm\"}");
        return {};
    }
    // Faults of the entry itself, once.
    const std::size_t before = entry.error_count();
    Tolerance checked;
    read_entry(entry, {10e-3, units.length}, units, checked);
    if (entry.error_count() > before) return {};
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    for (const core::scene::Variable& variable : variables)
        if (variable.formula.is_constant() && std::find(names.begin(), names.end(), variable.name) == names.end())
            names.push_back(variable.name);
    std::vector<Untoleranced> left_out;
    for (const std::string& name : names) {
        const auto has_entry = [&](const ToleranceEntry& each) { return each.tolerance.of == name; };
        if (std::any_of(entries.begin(), entries.end(), has_entry)) continue;
        std::vector<Parameter> tried = parameters;
        const std::optional<int> parameter = parameter_of(entry, name, variables, units.length, tried);
        if (!parameter) continue;
        const bool is_variable = count_of(tried) > count_of(parameters);
        const Nominal nominal{std::abs(tried[*parameter].value), tried[*parameter].unit};
        std::string why = why_no_tolerance(entry, nominal, units);
        if (why.empty() && is_variable) why = why_fixed(name);
        if (!why.empty()) {
            left_out.push_back({name, why});
            continue;
        }
        Tolerance tolerance;
        tolerance.of = name;
        tolerance.parameter = *parameter;
        read_entry(entry, nominal, units, tolerance);
        parameters = std::move(tried);
        entries.push_back({std::move(tolerance), entry, false});
    }
    return left_out;
}

void read_place_tolerances(std::vector<ToleranceEntry>& entries, const ToleranceUnits& units, description::Design& design) {
    for (ToleranceEntry& entry : entries) {
        if (!entry.is_place) continue;
        const core::scene::Scene scene = description::described_scene(design);
        const auto place = core::scene::find_place(scene, entry.tolerance.of);
        for (const Error& error : place.errors()) entry.node.fail(error.code, error.message);
        if (!place) continue;
        const Nominal nominal{core::scene::value_at(scene, *place), usual_unit(core::scene::dimension_at(scene, *place), units.length)};
        const Result<int> parameter = description::add_deviation(design, entry.tolerance.of, nominal.unit);
        for (const Error& error : parameter.errors()) entry.node.fail(error.code, error.message);
        if (!parameter) continue;
        entry.tolerance.parameter = *parameter;
        read_entry(entry.node, nominal, units, entry.tolerance);
    }
}

}  // namespace fettle::design::reading
