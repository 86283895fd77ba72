// SPDX-License-Identifier: MIT
#include "design/reading/tolerance_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/contract.hpp"
#include "core/files/nearest_word.hpp"
#include "core/scene/place.hpp"
#include "design/reading/followed_number.hpp"
#include "design/reading/parameter_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Parameter;
using description::Tolerance;

constexpr std::string_view deviation_of = "deviation of ";
constexpr const char* default_name = "*";

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string_view> all_names(const std::vector<Parameter>& parameters, const VariableNames& variables) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    names.insert(names.end(), variables.design.begin(), variables.design.end());
    names.insert(names.end(), variables.scene.begin(), variables.scene.end());
    return names;
}

int add_deviation(const std::string& variable, std::vector<Parameter>& parameters) {
    Parameter deviation;
    deviation.name = std::string(deviation_of) + variable;
    parameters.push_back(deviation);
    return count_of(parameters) - 1;
}

// At the parameters' values; what else it follows from are variables of the scene.
double value_of(const core::expression::Formula& formula, const description::Design& design) {
    std::vector<double> inputs;
    for (const std::string& name : formula.inputs) {
        const auto is_named = [&](const auto& each) { return each.name == name; };
        const auto parameter = std::find_if(design.parameters.begin(), design.parameters.end(), is_named);
        const auto variable = std::find_if(design.scene.variables.begin(), design.scene.variables.end(), is_named);
        const bool is_parameter = parameter != design.parameters.end();
        FETTLE_ASSERT(is_parameter || variable != design.scene.variables.end(), "a variable's formula names what there is");
        inputs.push_back(is_parameter ? parameter->value : variable->value);
    }
    return core::expression::value_of<double>(formula, inputs);
}

// The variable as the design and its scene have it, with what the design sets; nothing: it has a fault, which is told.
std::optional<Nominal> nominal_of(const std::string& name, const DesignFormulas& formulas, const Unit& length_unit,
                                  const description::Design& design) {
    const auto& variables = design.scene.variables;
    const auto of_scene = std::find_if(variables.begin(), variables.end(), [&](const auto& each) { return each.name == name; });
    const core::expression::Scope::Name* of_design = formulas.scope().find(name);
    const bool is_of_scene = of_scene != variables.end();
    if (!is_of_scene && (of_design == nullptr || !of_design->meaning)) return std::nullopt;
    const core::expression::Formula& formula = is_of_scene ? of_scene->formula : *of_design->meaning;
    const Dimension dimension = named_dimension(formula.dimension).value_or(Dimension::number);
    return Nominal{value_of(formula, design), usual_unit(dimension, length_unit)};
}

// A place of the scene gets its parameter. Nothing: it has a fault, which is told.
std::optional<Nominal> add_place(ToleranceEntry& entry, const JsonNode& file, const Unit& length_unit, description::Design& design) {
    const core::scene::Scene scene = description::described_scene(design);
    const auto place = core::scene::find_place(scene, entry.tolerance.of);
    for (const Error& error : place.errors()) entry.node.fail(error.code, error.message);
    if (!place) return std::nullopt;
    if (const std::string follows = what_follows(file, scene, *place); !follows.empty()) {
        entry.node.fail(ErrorCode::unsupported, follows);
        return std::nullopt;
    }
    const Nominal nominal{core::scene::value_at(scene, *place), usual_unit(core::scene::dimension_at(scene, *place), length_unit)};
    const Result<int> parameter = description::add_deviation(design, entry.tolerance.of, nominal.unit);
    for (const Error& error : parameter.errors()) entry.node.fail(error.code, error.message);
    if (!parameter) return std::nullopt;
    entry.tolerance.parameter = *parameter;
    return nominal;
}

}  // namespace

std::vector<ToleranceEntry> find_tolerances(const JsonNode& node, const VariableNames& variables, std::vector<Parameter>& parameters) {
    using Kind = ToleranceEntry::Kind;
    std::vector<ToleranceEntry> entries;
    const std::vector<Parameter> own = parameters;
    for (const auto& [name, entry] : node.members()) {
        if (name == default_name) continue;
        Tolerance tolerance;
        tolerance.of = name;
        const auto parameter =
            std::find_if(own.begin(), own.end(), [&, &wanted = name](const Parameter& each) { return each.name == wanted; });
        if (name.starts_with("/")) {
            entries.push_back({std::move(tolerance), entry, Kind::place});
        } else if (parameter != own.end()) {
            tolerance.parameter = static_cast<int>(parameter - own.begin());
            entries.push_back({std::move(tolerance), entry, Kind::parameter});
        } else if (has(variables.scene, name) || has(variables.design, name)) {
            tolerance.parameter = add_deviation(name, parameters);
            entries.push_back({std::move(tolerance), entry, Kind::variable});
        } else {
            entry.fail(ErrorCode::out_of_range, "there is no parameter and no variable `" + name + "`; " +
                                                    core::files::did_you_mean(name, all_names(own, variables), '`') +
                                                    "; a place of the scene begins with \"/\"");
        }
    }
    return entries;
}

std::vector<Untoleranced> add_default_tolerances(const JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                                 const ToleranceUnits& units,
                                                 const std::function<std::string(const std::string&)>& why_fixed,
                                                 std::vector<Parameter>& parameters, std::vector<ToleranceEntry>& entries) {
    using Kind = ToleranceEntry::Kind;
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
    std::vector<Untoleranced> left_out;
    const auto is_free = [&](const std::string& name, const Nominal& nominal, const std::string& fixed) {
        const auto has_entry = [&](const ToleranceEntry& each) { return each.tolerance.of == name; };
        if (std::any_of(entries.begin(), entries.end(), has_entry)) return false;
        std::string why = why_no_tolerance(entry, nominal, units);
        if (why.empty()) why = fixed;
        if (!why.empty()) left_out.push_back({name, why});
        return why.empty();
    };
    const auto add = [&](const std::string& name, int parameter, Kind kind) {
        Tolerance tolerance;
        tolerance.of = name;
        tolerance.parameter = parameter;
        entries.push_back({std::move(tolerance), entry, kind, true});
    };
    const std::vector<Parameter> own = parameters;
    const auto is_parameter = [&](const std::string& name) {
        return std::any_of(own.begin(), own.end(), [&](const Parameter& parameter) { return parameter.name == name; });
    };
    for (int k = 0; k < count_of(own); ++k) {
        const bool is_deviation = own[k].name.starts_with(deviation_of);
        if (!is_deviation && is_free(own[k].name, {std::abs(own[k].value), own[k].unit}, "")) add(own[k].name, k, Kind::parameter);
    }
    for (const core::scene::Variable& variable : variables) {
        if (!variable.formula.is_constant() || is_parameter(variable.name)) continue;
        const Unit unit = usual_unit(named_dimension(variable.formula.dimension).value_or(Dimension::number), units.length);
        if (is_free(variable.name, {std::abs(variable.value), unit}, why_fixed(variable.name)))
            add(variable.name, add_deviation(variable.name, parameters), Kind::variable);
    }
    return left_out;
}

std::map<std::string, std::string> deviations_of(const std::vector<ToleranceEntry>& entries, const std::vector<Parameter>& parameters) {
    std::map<std::string, std::string> out;
    for (const ToleranceEntry& entry : entries)
        if (entry.kind == ToleranceEntry::Kind::variable) out[entry.tolerance.of] = parameters[entry.tolerance.parameter].name;
    return out;
}

void read_tolerances(std::vector<ToleranceEntry>& entries, const JsonNode& file, const DesignFormulas& formulas,
                     const ToleranceUnits& units, description::Design& design, std::vector<Untoleranced>& left_out) {
    using Kind = ToleranceEntry::Kind;
    std::vector<ToleranceEntry> kept;
    for (ToleranceEntry& entry : entries) {
        Tolerance& tolerance = entry.tolerance;
        std::optional<Nominal> nominal;
        if (entry.kind == Kind::parameter) {
            nominal = {design.parameters[tolerance.parameter].value, design.parameters[tolerance.parameter].unit};
        } else if (entry.kind == Kind::variable) {
            nominal = nominal_of(tolerance.of, formulas, units.length, design);
            if (nominal) design.parameters[tolerance.parameter].unit = nominal->unit;
        } else {
            nominal = add_place(entry, file, units.length, design);
        }
        if (!nominal) continue;
        if (entry.is_default) {
            nominal->value = std::abs(nominal->value);
            const std::string why = why_no_tolerance(entry.node, *nominal, units);
            if (!why.empty()) {
                left_out.push_back({tolerance.of, why});
                continue;
            }
        }
        read_entry(entry.node, *nominal, units, tolerance);
        kept.push_back(std::move(entry));
    }
    entries = std::move(kept);
}

}  // namespace fettle::design::reading
