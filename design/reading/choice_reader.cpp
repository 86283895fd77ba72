// SPDX-License-Identifier: MIT
#include "design/reading/choice_reader.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/expression/parse_formula.hpp"
#include "core/files/json_dump.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/reading/design_formulas.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonDocument;
using core::files::JsonNode;
using description::Choice;

constexpr int most_options = 1000;
constexpr std::string_view variables_place = "/variables/";

std::string written(double number) {
    if (number == std::floor(number) && std::abs(number) < 1e15) return std::to_string(static_cast<long long>(number));
    return core::files::dumped(nlohmann::json(number));
}

}  // namespace

ChoiceReader::ChoiceReader(const JsonNode& node, JsonDocument& scene) : scene_(scene) {
    if (!node.exists()) return;
    if (node.is_object() && node.members().empty()) node.fail(ErrorCode::out_of_range, "a design with `choices` has one");
    for (const auto& [name, entry] : node.members())
        if (!name.starts_with('#')) read(name, entry);
    nlohmann::json chosen;
    for (const std::string& name : numbers_) {
        const auto choice = std::find_if(choices_.begin(), choices_.end(), [&](const Choice& each) { return each.name == name; });
        const double number = choice->variables.at(name)[static_cast<std::size_t>(choice->value)];
        chosen[name]["value"] = number == std::floor(number) ? nlohmann::json(static_cast<long long>(number)) : nlohmann::json(number);
    }
    if (numbers_.empty()) return;
    chosen_ = JsonDocument::parse(core::files::dumped(nlohmann::json{{"choices", chosen}}), node.where().substr(0, node.where().find('#')))
                  .value();
}

void ChoiceReader::read(const std::string& name, const JsonNode& node) {
    node.allow_keys({"description", "from", "to", "step", "values", "options", "value"});
    node["description"].string();
    Choice choice;
    choice.name = name;
    const std::string fault = name.empty() ? "is not empty" : core::base::name_fault(name);
    if (!fault.empty()) node.fail(ErrorCode::out_of_range, "a choice's name " + fault);
    const int kinds = node["from"].exists() + node["values"].exists() + node["options"].exists();
    if (kinds != 1) {
        node.fail(kinds == 0 ? ErrorCode::missing_key : ErrorCode::inconsistent,
                  "a choice is one of these: whole numbers `from` ... `to`, numbers in a list `values`, or `options` by name");
        return;
    }
    if (node["options"].exists())
        read_options(node, choice);
    else if (const auto numbers = numbers_of(node))
        read_numbers(node, *numbers, choice);
    if (!choice.options.empty()) choices_.push_back(std::move(choice));
}

// They grow.
std::optional<std::vector<double>> ChoiceReader::numbers_of(const JsonNode& node) const {
    const auto too_many = [&] {
        node.fail(ErrorCode::out_of_range, "these are more than " + std::to_string(most_options) + " options");
        return std::nullopt;
    };
    if (node["values"].exists()) {
        for (const char* key : {"to", "step"})
            if (node[key].exists()) node[key].fail(ErrorCode::inconsistent, "`" + std::string(key) + "` goes with `from`");
        const auto numbers = node["values"].numbers();
        if (!numbers) return std::nullopt;
        if (numbers->empty()) {
            node["values"].fail(ErrorCode::out_of_range, "there is nothing to choose");
            return std::nullopt;
        }
        if (count_of(*numbers) > most_options) return too_many();
        if (std::adjacent_find(numbers->begin(), numbers->end(), std::greater_equal<>()) == numbers->end()) return numbers;
        node["values"].fail(ErrorCode::out_of_range, "the values of a choice grow, each once");
        return std::nullopt;
    }
    const auto from = node["from"].integer(0), to = node.require("to").integer(0);
    const int step = node["step"].integer(1).value_or(1);
    if (!from || !to) return std::nullopt;
    if (*to < *from) {
        node["to"].fail(ErrorCode::inconsistent, "`to` is below `from`");
        return std::nullopt;
    }
    const int last = (*to - *from) / step;
    if (last >= most_options) return too_many();
    std::vector<double> numbers;
    for (int k = 0; k <= last; ++k) numbers.push_back(*from + static_cast<double>(k) * step);
    return numbers;
}

// The one that the scene has, if it can be chosen.
std::optional<double> ChoiceReader::number_in_scene(const std::string& name) const {
    for (const core::scene::Variable& variable : core::scene_files::variables_of(scene_))
        if (variable.name == name && variable.formula.dimension.is_number()) return variable.value;
    return std::nullopt;
}

void ChoiceReader::read_numbers(const JsonNode& node, const std::vector<double>& numbers, Choice& choice) {
    const std::optional<double> in_scene = number_in_scene(choice.name);
    if (!in_scene) {
        node.fail(ErrorCode::missing_key, "the scene has no variable `" + choice.name +
                                              "` that is a plain number: add it there, and let formulas name it, such as \"counts\": "
                                              "{\"teeth\": \"= " +
                                              core::expression::quoted_if_needed(choice.name) + "\"}");
        return;
    }
    const auto wanted = node["value"].number();
    if (node["value"].exists() && !wanted) return;
    const auto found = std::find(numbers.begin(), numbers.end(), wanted.value_or(*in_scene));
    if (wanted && found == numbers.end()) {
        node["value"].fail(ErrorCode::out_of_range, node["value"].shown() + " is none of the numbers that can be chosen");
        return;
    }
    choice.value = found == numbers.end() ? 0 : static_cast<int>(found - numbers.begin());
    choice.is_ordered = true;
    for (const double number : numbers) choice.options.push_back(written(number));
    numbers_.push_back(choice.name);
    take_variable(choice, choice.name, {numbers, core::expression::powers_of(Dimension::number)});
}

void ChoiceReader::read_options(const JsonNode& node, Choice& choice) {
    for (const char* key : {"to", "step"})
        if (node[key].exists()) node[key].fail(ErrorCode::inconsistent, "`" + std::string(key) + "` goes with `from`");
    std::vector<JsonNode> options;
    for (const auto& [label, option] : node["options"].members()) {
        if (label.starts_with('#')) continue;
        option.allow_keys({"description", "set", "process"});
        option["description"].string();
        choice.options.push_back(label);
        options.push_back(option);
    }
    if (options.empty()) {
        if (node["options"].is_object()) node["options"].fail(ErrorCode::out_of_range, "there is nothing to choose");
        return;
    }
    if (count_of(options) > most_options)
        node["options"].fail(ErrorCode::out_of_range, "these are more than " + std::to_string(most_options) + " options");
    const std::vector<std::string_view> labels(choice.options.begin(), choice.options.end());
    const auto wanted = node["value"].choice(labels);
    if (wanted) choice.value = static_cast<int>(std::find(labels.begin(), labels.end(), *wanted) - labels.begin());
    const JsonNode& chosen = options[static_cast<std::size_t>(choice.value)];
    for (const auto& [pointer, value] : chosen["set"].members()) sets_.push_back({pointer, value});
    if (chosen["process"].string()) process_ = chosen["process"];
    std::map<std::string, Variable> variables;
    for (const JsonNode& option : options) {
        for (const auto& [pointer, value] : option["set"].members()) {
            if (!pointer.starts_with(variables_place) || !(value.is_number() || value.is_string())) continue;
            const std::string text = value.is_string() ? *value.string() : value.shown();
            const auto number = core::expression::parse_formula(text, {.what = "variable"});
            if (!number || !number->is_constant()) continue;
            Variable& variable = variables[pointer.substr(variables_place.size())];
            if (!variable.values.empty() && !same(variable.dimension, number->dimension)) continue;
            variable.dimension = number->dimension;
            variable.values.push_back(core::expression::value_of<double>(*number, {}));
        }
    }
    for (auto& [name, variable] : variables)
        if (variable.values.size() == options.size()) take_variable(choice, name, std::move(variable));
}

// A variable of two choices is what the later sets: no relation can be judged by it.
void ChoiceReader::take_variable(Choice& choice, const std::string& name, Variable variable) {
    const bool is_known = std::any_of(choices_.begin(), choices_.end(), [&](Choice& other) { return other.variables.erase(name) > 0; });
    if (is_known) {
        dimensions_.erase(name);
        return;
    }
    dimensions_[name] = variable.dimension;
    choice.variables[name] = std::move(variable.values);
}

void ChoiceReader::apply(JsonDocument& scene) {
    for (const std::string& name : numbers_) {
        const std::string place = (nlohmann::json::json_pointer("/variables") / name).to_string();
        scene.replace(place, chosen_->root()["choices"][name]["value"]);
    }
    for (const Set& set : sets_)
        if (const std::string fault = scene.replace(set.pointer, set.value); !fault.empty()) set.value.fail(ErrorCode::unknown_key, fault);
}

core::expression::Scope ChoiceReader::scope(JsonDocument& design, JsonDocument& scene, double length_unit,
                                            const std::vector<description::Parameter>& parameters) const {
    std::vector<core::scene::FormulaInput> inputs;
    std::vector<description::Parameter> names = parameters;
    for (const Choice& choice : choices_) {
        for (const auto& [name, values] : choice.variables) {
            const core::expression::DimensionPowers& dimension = dimensions_.at(name);
            inputs.push_back({name, dimension, values[static_cast<std::size_t>(choice.value)]});
            description::Parameter stand_in;
            stand_in.name = name;
            stand_in.unit.dimension = named_dimension(dimension).value_or(Dimension::number);
            names.push_back(std::move(stand_in));
        }
    }
    DesignFormulas formulas(design, length_unit, core::scene_files::variables_of(scene, inputs));
    formulas.add_parameters(design.root()["parameters"], names);
    formulas.read_variables(design.root()["variables"]);
    return formulas.scope();
}

}  // namespace fettle::design::reading
