// SPDX-License-Identifier: MIT
#include "core/scene_files/scene_formulas.hpp"

#include <algorithm>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/units.hpp"
#include "core/scene/place.hpp"

namespace fettle::core::scene_files {
namespace {

using base::Dimension;
using base::ErrorCode;
using expression::Formula;
using expression::Number;
using files::JsonNode;

// The pointer of a file's body to the body that it became. One that was split became several.
std::vector<std::string> pointers_in_scene(const std::string& pointer, const std::vector<JsonNode>& file_bodies,
                                           const scene::Scene& scene) {
    constexpr std::string_view bodies = "/bodies/";
    if (!pointer.starts_with(bodies)) return {pointer};
    const std::size_t end = std::min(pointer.find('/', bodies.size()), pointer.size());
    const std::string where = file_bodies.at(std::stoul(pointer.substr(bodies.size(), end - bodies.size()))).where();
    std::vector<std::string> out;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].where == where) out.push_back(std::string(bodies) + std::to_string(i) + pointer.substr(end));
    return out;
}

}  // namespace

std::array<Number3, 3> rotation_of_angles(const Number3& angles) {
    const Number sa = sin(angles[0]), ca = cos(angles[0]), sb = sin(angles[1]), cb = cos(angles[1]), sc = sin(angles[2]),
                 cc = cos(angles[2]);
    return {Number3{cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa},
            Number3{sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa}, Number3{-sb, cb * sa, cb * ca}};
}

// R = I + sin|x|/|x| [x] + (1 - cos|x|)/|x|^2 [x]^2; about 0, where the quotients are 1 and 1/2, by their series.
std::array<Number3, 3> rotation_of_vector(const Number3& x) {
    const Number square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    constexpr double small = 1e-4;  // of the angle squared: the next terms are below rounding
    const Number angle = sqrt(square);
    const bool series = square.value < small;
    const Number s = series ? 1 - square * (1.0 / 6 - square * (1.0 / 120 - square / 5040)) : sin(angle) / angle;
    const Number c = series ? 0.5 - square * (1.0 / 24 - square * (1.0 / 720 - square / 40320)) : (1 - cos(angle)) / square;
    const auto entry = [&](std::size_t i, std::size_t k) { return c * x[i] * x[k]; };
    return {Number3{1 - c * (x[1] * x[1] + x[2] * x[2]), entry(0, 1) - s * x[2], entry(0, 2) + s * x[1]},
            Number3{entry(0, 1) + s * x[2], 1 - c * (x[0] * x[0] + x[2] * x[2]), entry(1, 2) - s * x[0]},
            Number3{entry(0, 2) - s * x[1], entry(1, 2) + s * x[0], 1 - c * (x[0] * x[0] + x[1] * x[1])}};
}

SceneFormulas::SceneFormulas(files::JsonDocument& document, const std::vector<scene::FormulaInput>& inputs) : document_(document) {
    for (const scene::FormulaInput& input : inputs) {
        taken_.insert(input.name);
        scope_.names.push_back({input.name, input.dimension, input.meaning});
        if (!input.added_to.empty()) added_[input.added_to] = input;
        if (input.meaning) continue;
        input_names_.push_back(input.name);
        inputs_[input.name] = tape_.input(input.value);
    }
    document_.read_formulas([this](const JsonNode& node, const std::string& text, Dimension dimension, double si_per_number) {
        return read(node, text, dimension, si_per_number);
    });
}

SceneFormulas::~SceneFormulas() { document_.read_formulas({}); }

void SceneFormulas::set_length_unit(double unit) { scope_.plain_unit = expression::plain_units(unit); }

void SceneFormulas::read_variables(const JsonNode& node) {
    std::map<std::string, std::string> texts;
    for (const auto& [name, value] : node.members()) {
        if (name.starts_with('#') || taken_.count(name) != 0) continue;  // an input replaces the variable of its name
        if (!expression::is_possible_name(name)) {
            value.fail(ErrorCode::out_of_range, "a variable's name must not be empty or contain a single quote");
        } else if (value.is_string()) {
            texts[name] = *value.string();
        } else if (value.number()) {
            texts[name] = value.shown();
        }
    }
    const base::Errors errors = expression::define_variables(texts, scope_, [&](const std::string& name, Formula formula) {
        if (const auto added = added_.find(name); added != added_.end()) {
            const scene::FormulaInput& input = added->second;
            if (same(formula.dimension, input.dimension))
                formula = expression::sum_of(formula, expression::input_formula(input.name, input.dimension));
            else
                node[name].fail(ErrorCode::inconsistent, "`" + input.name + "` is added to it, and it is another quantity");
        }
        const double value = value_of(formula).value;
        if (!base::is_usable_number(value)) node[name].fail(ErrorCode::not_finite, "this is not a finite number");
        expression::Scope::Name out{name, formula.dimension};
        if (formula.is_constant()) {
            input_names_.push_back(name);
            inputs_[name] = tape_.input(value);
        } else {
            out.meaning = formula;
        }
        variables_.push_back({name, std::move(formula), value});
        return out;
    });
    for (const base::Error& error : errors) node[error.where].fail(error.code, error.message);
}

Number SceneFormulas::value_of(const Formula& formula) const {
    std::vector<Number> inputs;
    for (const std::string& input : formula.inputs) inputs.push_back(inputs_.at(input));
    return expression::value_of<Number>(formula, inputs);
}

std::optional<double> SceneFormulas::read(const JsonNode& node, const std::string& text, Dimension dimension, double si_per_number) {
    const base::Result<Formula> formula = expression::parse_formula_of(text, scope_, dimension, si_per_number);
    if (!formula) {
        for (const base::Error& error : formula.errors()) node.fail(error.code, error.message);
        return std::nullopt;
    }
    const Number number = value_of(*formula);
    found_.insert_or_assign(node.pointer(), Found{node, number});
    return number.value;
}

Number SceneFormulas::number(const JsonNode& node, double value) const {
    const auto found = found_.find(node.pointer());
    return found == found_.end() ? Number(value) : found->second.number;
}

Number3 SceneFormulas::vector(const JsonNode& node, const Vector3& value) const {
    Number3 out;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = found_.find(node.pointer() + "/" + std::to_string(k));
        out[k] = found == found_.end() ? Number(value[k]) : found->second.number;
    }
    return out;
}

std::optional<SceneFormulas::Named> SceneFormulas::named(const std::string& name) const {
    const expression::Scope::Name* found = scope_.find(name);
    if (found == nullptr) return std::nullopt;
    const Number number = value_of(found->meaning.value_or(expression::input_formula(name, found->dimension)));
    return Named{number, found->dimension, !moved_by(number).empty()};
}

void SceneFormulas::bind(const std::string& pointer, const Number& number) {
    if (!number.is_constant()) bound_.insert_or_assign(pointer, number);
}

void SceneFormulas::use(const JsonNode& node) {
    for (auto& [pointer, found] : found_)
        if (pointer == node.pointer() || pointer.starts_with(node.pointer() + "/")) found.is_used = true;
}

std::string SceneFormulas::moved_by(const Number& number) const {
    const Formula formula = expression::recorded_formula(number, input_names_, {});
    const auto found =
        std::find_if(formula.inputs.begin(), formula.inputs.end(), [&](const auto& name) { return taken_.count(name) != 0; });
    return found == formula.inputs.end() ? std::string() : *found;
}

void SceneFormulas::finish(scene::Scene& scene) {
    scene.variables = std::move(variables_);
    const std::vector<JsonNode> file_bodies = document_.root()["bodies"].elements();
    const auto add = [&](const std::string& pointer, const Number& number) -> std::string {
        const std::vector<std::string> pointers = pointers_in_scene(pointer, file_bodies, scene);
        for (const std::string& each : pointers) {
            const base::Result<scene::Place> place = scene::find_place(scene, each);
            if (!place) return place.errors().front().message;
            const auto dimension = expression::powers_of(scene::dimension_at(scene, *place));
            scene.numbers.push_back({scene::pointer_to(scene, *place), expression::recorded_formula(number, input_names_, dimension)});
        }
        return {};
    };
    for (const auto& [pointer, found] : found_) {
        if (found.number.is_constant() || found.is_used) continue;
        const std::string fault = add(pointer, found.number);
        const std::string moving = fault.empty() ? "" : moved_by(found.number);
        if (!moving.empty())
            found.node.fail(ErrorCode::unsupported, "no design can move this number, so its formula cannot follow from `" + moving +
                                                        "`, which is a parameter of the design: " + fault);
    }
    for (const auto& [pointer, number] : bound_) {
        const std::string fault = add(pointer, number);
        FETTLE_ASSERT(fault.empty(), "what the reader computes has a place: " + fault);
    }
}

}  // namespace fettle::core::scene_files
