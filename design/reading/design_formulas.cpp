// SPDX-License-Identifier: MIT
#include "design/reading/design_formulas.hpp"

#include <algorithm>

#include "core/base/limits.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/reading/same_formula.hpp"

namespace fettle::design::reading {

using core::expression::Formula;
using core::expression::Scope;
using core::files::JsonNode;

DesignFormulas::DesignFormulas(core::files::JsonDocument& document, double length_unit, std::vector<core::scene::Variable> scene_variables)
    : document_(document), scene_variables_(std::move(scene_variables)) {
    scope_.what = "parameter or variable";
    scope_.plain_unit = core::expression::plain_units(length_unit, grams);
    take_scene_variables();
    document_.read_formulas([this](const JsonNode& node, const std::string& text, Dimension dimension, double si_per_number) {
        return read(node, text, dimension, si_per_number);
    });
}

DesignFormulas::~DesignFormulas() { document_.read_formulas({}); }

// The scene's variables as they are; those that follow from a variable which a parameter replaces follow from the parameter.
void DesignFormulas::take_scene_variables() {
    for (Scope::Name& name : meanings(scene_variables_))
        if (scope_.find(name.name) == nullptr) scope_.names.push_back(std::move(name));
}

std::vector<Scope::Name> DesignFormulas::meanings(const std::vector<core::scene::Variable>& variables) const {
    std::map<std::string, Formula> plain;
    for (const core::scene::Variable& variable : variables)
        if (variable.formula.is_constant() && values_.count(variable.name) == 0)
            plain[variable.name] = core::expression::constant_formula(variable.value, variable.formula.dimension);
    std::vector<Scope::Name> out;
    for (const core::scene::Variable& variable : variables)
        out.push_back({variable.name, variable.formula.dimension, core::expression::substituted(variable.formula, plain)});
    return out;
}

// Variables of the scope that mean something else here.
std::vector<std::string> DesignFormulas::changed(const std::vector<core::scene::Variable>& variables) const {
    std::vector<std::string> out;
    for (const Scope::Name& name : meanings(variables)) {
        const Scope::Name* known = scope_.find(name.name);
        const bool is_own = std::any_of(own_.begin(), own_.end(), [&](const auto& own) { return own.name == name.name; });
        if (known == nullptr || !known->meaning || is_own) continue;
        if (!is_same_formula(*known->meaning, *name.meaning)) out.push_back(name.name);
    }
    return out;
}

void DesignFormulas::take_scene(const std::vector<core::scene::Variable>& variables, const JsonNode& node) {
    const std::vector<std::string> set = changed(variables);
    for (const auto& [name, value] : node.members()) {
        if (name.starts_with('#') || !value.is_string()) continue;
        for (const std::string& used : core::expression::names_in(*value.string()))
            if (std::find(set.begin(), set.end(), used) != set.end())
                value.fail(ErrorCode::inconsistent,
                           "`" + used + "` is a variable that this design's `set` changes: name here what it is set to");
    }
    scene_variables_ = variables;
    std::erase_if(scope_.names, [&](const Scope::Name& name) { return std::find(set.begin(), set.end(), name.name) != set.end(); });
    take_scene_variables();
}

void DesignFormulas::take_scenario(const std::string& scenario, const std::vector<core::scene::Variable>& variables) {
    for (const std::string& name : changed(variables)) refused_.emplace(name, scenario);
}

std::string DesignFormulas::refusal(std::string_view text) const {
    if (refused_.empty()) return "";
    for (const std::string& name : core::expression::names_in(text))
        if (const auto found = refused_.find(name); found != refused_.end())
            return "`" + name + "` is another number in the scenario `" + found->second + "`: write the number that is meant";
    return "";
}

void DesignFormulas::add_parameters(const JsonNode& node, const std::vector<description::Parameter>& parameters) {
    const std::vector<JsonNode> nodes = node.elements();
    scope_.names.clear();
    for (size_t k = 0; k < parameters.size(); ++k) {
        const description::Parameter& parameter = parameters[k];
        if (!core::expression::is_possible_name(parameter.name) && !parameter.name.empty())
            nodes[k]["name"].fail(ErrorCode::out_of_range, "a parameter's name must not contain a single quote, because formulas quote it");
        scope_.names.push_back({parameter.name, core::expression::powers_of(parameter.unit.dimension)});
        values_[parameter.name] = parameter.reference.value_or(parameter.value);
    }
    take_scene_variables();
}

void DesignFormulas::add_deviations(const std::map<std::string, std::string>& names, core::files::JsonDocument& scene) {
    own_deviations_ = names;
    for (const core::scene::Variable& variable : scene_variables_) {
        const auto found = own_deviations_.find(variable.name);
        if (found == own_deviations_.end()) continue;
        take_deviation(found->second, variable.formula.dimension, variable.name);
        own_deviations_.erase(found);
    }
    scene_variables_ = core::scene_files::variables_of(scene, deviations_);
    std::erase_if(scope_.names, [&](const Scope::Name& name) {
        return values_.count(name.name) == 0;  // the scene's, as they were
    });
    take_scene_variables();
}

void DesignFormulas::take_deviation(const std::string& name, const core::expression::DimensionPowers& dimension,
                                    const std::string& variable) {
    deviations_.push_back({name, dimension, 0, {}, variable});
    scope_.names.push_back({name, dimension});
    values_[name] = 0;
}

void DesignFormulas::read_variables(const JsonNode& node) {
    std::map<std::string, std::string> texts;
    for (const auto& [name, value] : node.members()) {
        if (name.starts_with('#')) continue;
        if (!core::expression::is_possible_name(name)) {
            value.fail(ErrorCode::out_of_range, "a variable's name must not be empty or contain a single quote");
        } else if (values_.count(name) != 0) {
            value.fail(ErrorCode::inconsistent, "a parameter is called `" + name + "` already");
        } else if (value.is_string()) {
            texts[name] = *value.string();
        } else if (value.number()) {
            texts[name] = value.shown();
        }
    }
    std::erase_if(scope_.names, [&](const Scope::Name& name) { return texts.count(name.name) != 0; });  // its own are meant
    const Errors errors = core::expression::define_variables(texts, scope_, [&](const std::string& name, Formula formula) {
        if (const auto deviation = own_deviations_.find(name); deviation != own_deviations_.end()) {
            take_deviation(deviation->second, formula.dimension, {});
            formula = core::expression::sum_of(formula, core::expression::input_formula(deviation->second, formula.dimension));
        }
        own_.push_back({name, formula.dimension, 0, formula});
        return Scope::Name{name, formula.dimension, std::move(formula)};
    });
    for (const Error& error : errors) node[error.where].fail(error.code, error.message);
}

std::vector<core::scene::FormulaInput> DesignFormulas::inputs_of_scene() const {
    std::vector<core::scene::FormulaInput> out;
    for (const auto& name : scope_.names)
        if (!name.meaning && !is_deviation(name.name)) out.push_back({name.name, name.dimension, values_.at(name.name)});
    out.insert(out.end(), deviations_.begin(), deviations_.end());
    out.insert(out.end(), own_.begin(), own_.end());
    return out;
}

std::optional<Formula> DesignFormulas::followed(const JsonNode& node, Dimension dimension, double si_per_number) const {
    if (!node.is_string()) return std::nullopt;
    const std::string text = *node.string();
    const std::size_t begin = text.find_first_not_of(" \t\n");
    if (begin == std::string::npos || text[begin] != '=' || !refusal(text).empty()) return std::nullopt;
    Result<Formula> formula = core::expression::parse_formula_of(text, scope_, dimension, si_per_number);
    if (!formula || formula->is_constant()) return std::nullopt;
    return std::move(formula).value();
}

bool DesignFormulas::is_deviation(const std::string& name) const {
    return std::any_of(deviations_.begin(), deviations_.end(), [&](const core::scene::FormulaInput& input) { return input.name == name; });
}

double DesignFormulas::value_of(const Formula& formula) const {
    std::vector<double> inputs;
    for (const std::string& name : formula.inputs) inputs.push_back(values_.at(name));
    return core::expression::value_of<double>(formula, inputs);
}

std::optional<double> DesignFormulas::read(const JsonNode& node, const std::string& text, Dimension dimension, double si_per_number) {
    const Result<Formula> formula = core::expression::parse_formula_of(text, scope_, dimension, si_per_number);
    for (const Error& error : formula.errors()) node.fail(error.code, error.message);
    if (!formula) return std::nullopt;
    if (const std::string refused = refusal(text); !refused.empty()) {
        node.fail(ErrorCode::inconsistent, refused);
        return std::nullopt;
    }
    if (std::all_of(formula->inputs.begin(), formula->inputs.end(), [&](const std::string& name) { return is_deviation(name); })) {
        if (measuring_ == 0 || formula->is_constant()) return value_of(*formula);
        node.fail(ErrorCode::unsupported, "this number cannot follow from the " + formula->inputs.front() +
                                              ", which has a tolerance: write a number, or use variables without tolerance");
        return std::nullopt;
    }
    node.fail(ErrorCode::unsupported, "this number cannot follow from parameters; use only variables that no parameter changes");
    return std::nullopt;
}

}  // namespace fettle::design::reading
