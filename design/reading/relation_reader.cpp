// SPDX-License-Identifier: MIT
#include "design/reading/relation_reader.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "core/expression/parse_formula.hpp"
#include "design/reading/over_tolerances_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::expression::DimensionPowers;
using core::expression::Formula;
using core::files::JsonNode;
using description::Bounds;
using description::Relation;
using description::RelationValue;

constexpr double usual_slack = 1e-5;  // share of a relation's change over the parameters' ranges: above what optimisers leave open

// In which a number without a unit is understood; none: it has to have one.
bool may_be_plain(const DimensionPowers& dimension) {
    for (const Dimension plain : {Dimension::number, Dimension::length, Dimension::area, Dimension::mass}) {
        if (same(dimension, core::expression::powers_of(plain))) return true;
    }
    return false;
}

class RelationReader {
public:
    RelationReader(const ReadContext& context, const std::vector<description::Parameter>& parameters,
                   const core::expression::Scope* choices, bool has_tolerances, std::set<std::string> names)
        : context_(context),
          parameters_(parameters),
          choices_(choices),
          scope_(context.formulas.scope()),
          has_tolerances_(has_tolerances),
          names_(std::move(names)) {}

    std::optional<Relation> read(const JsonNode& node) {
        node.allow_keys({"type", "name", "expression", "lower", "upper", "margin", "tolerance", "over_tolerances"});
        const auto text = node.require("expression").string();
        const auto name = node["name"].string();
        if (!node["lower"].exists() && !node["upper"].exists())
            node.fail(ErrorCode::missing_key, "a relation has `lower`, `upper` or both");
        if (!text) return std::nullopt;
        Relation relation;
        const auto formula = read_formula(node["expression"], *text, relation);
        if (!formula) return std::nullopt;
        relation.name = unique_name(name.value_or(*text), names_);
        relation.at = description::function_of(*formula, parameters_);
        relation.formula = formula;
        const RelationValue start = value_at_start(node["expression"], relation);
        read_bounds(node, formula->dimension, change(start), relation);
        relation.bounds.over_tolerances = read_over_tolerances_of(node, relation.bounds, context_.over_tolerances);
        return relation;
    }

private:
    std::optional<Formula> read_formula(const JsonNode& node, const std::string& text, Relation& relation) const {
        Result<Formula> formula = core::expression::parse_formula(text, scope_);
        if (!formula) {
            for (const Error& error : formula.errors()) node.fail(error.code, error.message);
            return std::nullopt;
        }
        if (const std::string refused = context_.formulas.refusal(text); !refused.empty()) {
            node.fail(ErrorCode::inconsistent, refused);
            return std::nullopt;
        }
        if (!formula->is_constant()) return std::move(formula).value();
        relation.by_choices = by_choices(text);
        if (relation.by_choices) return std::move(formula).value();
        if (has_tolerances_ && !core::expression::names_in(text).empty())
            node.warn("no parameter changes this: `fettle tolerance` alone looks at it");
        else
            node.fail(ErrorCode::inconsistent,
                      "this names no parameter, and no variable that follows from one, so no design could change it");
        return std::nullopt;
    }

    // The text names no parameter. Nothing: no name in it follows from a choice, either.
    std::optional<description::ChoiceFormula> by_choices(const std::string& text) const {
        if (choices_ == nullptr) return std::nullopt;
        description::ChoiceFormula out{text, *choices_};
        const std::vector<std::string> names = core::expression::names_in(text);
        std::erase_if(out.scope.names, [&](const auto& name) { return std::find(names.begin(), names.end(), name.name) == names.end(); });
        const bool is_moved = std::any_of(out.scope.names.begin(), out.scope.names.end(),
                                          [](const auto& name) { return !name.meaning || !name.meaning->is_constant(); });
        if (!is_moved) return std::nullopt;
        // What a meaning follows from is looked up by name, too.
        for (const core::expression::Scope::Name& name : choices_->names)
            if (!name.meaning && out.scope.find(name.name) == nullptr) out.scope.names.push_back(name);
        return out;
    }

    RelationValue value_at_start(const JsonNode& node, const Relation& relation) const {
        RelationValue start = relation.at(description::values_of(parameters_));
        if (!std::isfinite(start.value) || !start.gradient.allFinite())
            node.fail(ErrorCode::not_finite, "its value or its derivative is not a finite number at the parameters' values");
        return start;
    }

    // What it changes by, to first order, when every parameter goes from one bound to the other.
    double change(const RelationValue& start) const {
        double sum = 0;
        for (size_t k = 0; k < parameters_.size(); ++k) sum += std::abs(start.gradient[k]) * (parameters_[k].upper - parameters_[k].lower);
        return sum;
    }

    std::optional<double> amount(const JsonNode& node, const DimensionPowers& dimension) const {
        if (!node.exists()) return std::nullopt;
        if (!node.is_string()) {
            const auto number = node.number();
            if (!number) return std::nullopt;
            if (may_be_plain(dimension)) {
                const Dimension plain = *named_dimension(dimension);
                return node.quantity(plain, context_.unit(plain));
            }
            node.fail(ErrorCode::wrong_type, "the expression is " + described(dimension) + "; write " + node.shown() + " with its unit");
            return std::nullopt;
        }
        const Result<Formula> constant = core::expression::parse_formula(*node.string(), {.what = "parameter"});
        if (!constant && core::expression::parse_formula(*node.string(), scope_)) {
            node.fail(ErrorCode::unsupported,
                      "a relation's bound follows from no parameter: subtract it from the expression, and bound the difference by 0");
            return std::nullopt;
        }
        if (!constant) {
            for (const Error& error : constant.errors()) node.fail(error.code, error.message);
            return std::nullopt;
        }
        const double value = core::expression::value_of<double>(*constant, {});
        if (!same(constant->dimension, dimension)) {
            node.fail(ErrorCode::wrong_type,
                      node.shown() + " is " + described(constant->dimension) + "; the expression is " + described(dimension));
        } else if (!std::isfinite(value)) {
            node.fail(ErrorCode::not_finite, node.shown() + " is not a finite number");
        }
        return value;
    }

    std::optional<double> not_negative(const JsonNode& node, const DimensionPowers& dimension) const {
        const auto value = amount(node, dimension);
        if (value && *value < 0) node.fail(ErrorCode::out_of_range, "this is not negative");
        return value;
    }

    void read_bounds(const JsonNode& node, const DimensionPowers& dimension, double change, Relation& relation) const {
        Bounds& bounds = relation.bounds;
        if (const auto named = named_dimension(dimension)) bounds.unit = context_.unit_of({node["upper"], node["lower"]}, *named);
        bounds.lower = amount(node["lower"], dimension).value_or(bounds.lower);
        bounds.upper = amount(node["upper"], dimension).value_or(bounds.upper);
        if (bounds.lower > bounds.upper) {
            node["lower"].fail(ErrorCode::inconsistent,
                               "the lower bound " + node["lower"].shown() + " is above the upper bound " + node["upper"].shown());
        }
        const bool equation = bounds.lower == bounds.upper;
        const double usual = std::max(usual_slack * change, equation ? 1e-12 * std::abs(bounds.lower) : 0.0);
        bounds.margin = not_negative(node["margin"], dimension).value_or(equation ? 0 : usual);
        bounds.margin = std::clamp(bounds.margin, 0.0, std::max(0.0, (bounds.upper - bounds.lower) / 4));
        relation.tolerance = not_negative(node["tolerance"], dimension).value_or(equation ? usual : 0);
    }

    const ReadContext& context_;
    const std::vector<description::Parameter>& parameters_;
    const core::expression::Scope* choices_;
    core::expression::Scope scope_;
    bool has_tolerances_;
    std::set<std::string> names_;
};

}  // namespace

bool is_relation(const JsonNode& node) { return node.is_object() && node["type"].is_string() && *node["type"].string() == relation_type; }

std::vector<Relation> read_relations(const JsonNode& node, const ReadContext& context,
                                     const std::vector<description::Parameter>& parameters,
                                     const std::vector<description::Constraint>& others, const core::expression::Scope* choices,
                                     bool has_tolerances) {
    std::vector<Relation> result;
    if (!node.is_array()) return result;  // told where the other constraints are read
    std::set<std::string> names;
    for (const description::Constraint& other : others) names.insert(other.name);
    RelationReader reader(context, parameters, choices, has_tolerances, std::move(names));
    for (const JsonNode& entry : node.elements()) {
        if (!is_relation(entry)) continue;
        if (auto relation = reader.read(entry)) result.push_back(std::move(*relation));
    }
    return result;
}

}  // namespace fettle::design::reading
