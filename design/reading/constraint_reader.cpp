// SPDX-License-Identifier: MIT
#include "design/reading/constraint_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/expression/parse_formula.hpp"
#include "design/quantities/expression.hpp"
#include "design/reading/over_tolerances_reader.hpp"
#include "design/reading/quantity_reader.hpp"
#include "design/reading/relation_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Bounds;
using description::Constraint;

class ConstraintReader {
public:
    ConstraintReader(const ReadContext& context, double clearance_margin) : context_(context), clearance_margin_(clearance_margin) {}

    void read(const JsonNode& node, std::vector<Constraint>& out) {
        if (is_relation(node)) return;
        std::vector<std::string_view> types = quantity_names();
        types.push_back(relation_type);
        const auto type = node.require("type").choice(types);
        if (!type) return;
        std::vector<Constraint> read;
        if (*type == "clearance") {
            read_clearance(node, read);
        } else {
            read_bounded(node, *find_quantity_type(*type), read);
        }
        for (Constraint& constraint : read) {
            constraint.bounds.over_tolerances =
                read_over_tolerances_of(node, constraint.bounds, context_.over_tolerances, *type == "clearance");
            check_proven(node, constraint);
        }
        for (const Constraint& constraint : read)
            for (ScenarioQuantity& one : in_scenarios(node, constraint.quantity, context_.scenarios))
                out.push_back({unique_name(constraint.name + one.suffix, names_), constraint.bounds, std::move(one.quantity)});
    }

private:
    void check_proven(const JsonNode& node, const Constraint& constraint) const {
        const auto& over = constraint.bounds.over_tolerances;
        if (!over || over->kind != description::OverTolerances::Kind::proven) return;
        const quantities::ClearanceRange* range = constraint.quantity->facts().clearance;
        const bool can_be =
            range != nullptr && !range->motion && range->faces_a.empty() && range->faces_b.empty() && context_.scenarios.names.size() < 2;
        if (!can_be)
            node["over_tolerances"].fail(
                ErrorCode::unsupported,
                "\"proven\" is for a clearance of whole bodies, as assembled or over the ranges of the joints, with a "
                "number as its minimum, in a design without scenarios; a motion in contact cannot be proven for "
                "all parts: say {\"sigma\": 3} or \"worst_case\"");
    }

    // Among the constraints of the same choice of scenarios.
    std::string name_of(const JsonNode& node, const std::string& otherwise) {
        return unique_name(node["name"].string().value_or(otherwise), names_of_choice_[node["scenario"].shown()]);
    }

    /// A bound that parameters change.
    struct MovingBound {
        core::expression::Formula formula;
        std::string text;  ///< as written, without the `=`
    };

    std::optional<MovingBound> moving(const JsonNode& node, Dimension dimension) const {
        auto formula = context_.formulas.followed(node, dimension, context_.unit(dimension));
        if (!formula) return std::nullopt;
        const std::string text = *node.string();
        return MovingBound{std::move(*formula), text.substr(text.find_first_not_of(" \t\n", text.find('=') + 1))};
    }

    // quantity - bound, whose own bound is 0.
    static std::shared_ptr<const description::Quantity> beyond(std::shared_ptr<const description::Quantity> quantity,
                                                               const MovingBound& bound, const std::string& name) {
        std::set<std::string> taken(bound.formula.inputs.begin(), bound.formula.inputs.end());
        const std::string measured = unique_name(name, taken), limit = unique_name("limit", taken);
        core::expression::Scope scope;
        scope.names = {{measured, core::expression::powers_of(quantity->dimension())}, {limit, bound.formula.dimension, bound.formula}};
        auto difference = core::expression::parse_formula(
            core::expression::quoted_if_needed(measured) + " - " + core::expression::quoted_if_needed(limit), scope);
        core::expression::Formula formula = std::move(difference).value();
        formula.text = less(core::expression::quoted_if_needed(measured), bound);
        return quantities::Expression::create(std::move(formula), {{measured, std::move(quantity)}}).value();
    }

    static std::string less(const std::string& name, const MovingBound& bound) {
        const bool is_plain = bound.text.find_first_of(" +-*/^") == std::string::npos;
        return name + " - " + (is_plain ? bound.text : "(" + bound.text + ")");
    }

    // `minimum` instead of bounds, and several constraints where the motion is divided.
    void read_clearance(const JsonNode& node, std::vector<Constraint>& out) {
        node.allow_keys({"type", "name", "scenario", "a", "b", "faces_a", "faces_b", "minimum", "margin", "motion", "from", "to", "windows",
                         "ranges", "over_tolerances"});
        std::optional<quantities::ClearanceRange> range = read_clearance_range(node, context_);
        Bounds bounds;
        bounds.unit = context_.unit_of({node["minimum"]}, Dimension::length);
        const auto minimum = moving(node["minimum"], Dimension::length);
        if (minimum && !(context_.formulas.value_of(minimum->formula) > 0))
            node["minimum"].fail(ErrorCode::out_of_range, "at the parameters' values this is not greater than 0");
        bounds.lower = minimum ? 0 : node.require("minimum").length(context_.length_unit, core::files::positive).value_or(0);
        bounds.margin = node["margin"].length(context_.length_unit, core::files::not_negative).value_or(clearance_margin_);
        const int windows = node["windows"].integer(1, 1000).value_or(1);
        if (!range) return;
        if (windows > 1 && !range->motion)
            node["windows"].fail(ErrorCode::inconsistent, "`windows` divide the motion; set `motion` to true");
        range->windows = windows;
        const std::string measured = find_quantity_type("clearance")->default_name(node);
        const std::string name = name_of(node, minimum ? less(measured, *minimum) : measured);
        for (int w = 0; w < windows; ++w) {
            const std::string part = windows > 1 ? name + " window " + std::to_string(w + 1) : name;
            range->window = w;
            std::shared_ptr<const description::Quantity> quantity = std::make_shared<quantities::Clearance>(*range, bounds.lower);
            if (minimum) quantity = beyond(std::move(quantity), *minimum, measured);
            out.push_back({part, bounds, std::move(quantity)});
        }
    }

    void read_bounded(const JsonNode& node, const QuantityType& type, std::vector<Constraint>& out) {
        std::vector<std::string_view> keys{"type", "name", "scenario", "lower", "upper", "margin", "over_tolerances"};
        for (const std::string_view key : type.keys) {
            if (key != "target") keys.push_back(key);  // a constraint bounds the stroke itself
        }
        node.allow_keys(keys);
        std::shared_ptr<const description::Quantity> quantity = read_quantity(type, node, context_);
        if (!node["lower"].exists() && !node["upper"].exists()) {
            node.fail(ErrorCode::missing_key, "a constraint has `lower`, `upper` or both");
        }
        if (!quantity) return;
        if (const auto facts = quantity->facts(); facts.kind == description::QuantityFacts::Kind::formula && facts.parts.empty())
            node["expression"].fail(ErrorCode::inconsistent,
                                    "this names none of the design's `quantities`; a condition between parameters alone is a `relation`");
        const auto lower = moving(node["lower"], quantity->dimension()), upper = moving(node["upper"], quantity->dimension());
        const Bounds bounds = read_bounds(node, quantity->dimension(), lower, upper);
        const std::string measured = type.default_name(node);
        if (!lower && !upper) {
            out.push_back({name_of(node, measured), bounds, std::move(quantity)});
            return;
        }
        if (lower && upper && lower->text == upper->text) {
            Bounds exactly = bounds;
            exactly.lower = exactly.upper = 0;
            out.push_back({name_of(node, less(measured, *lower)), exactly, beyond(quantity, *lower, measured)});
            return;
        }
        // One constraint for each side: they are about different numbers.
        const auto add = [&](const char* key, const std::optional<MovingBound>& bound, double Bounds::*side) {
            if (!node[key].exists()) return;
            Bounds one = bounds;
            one.lower = Bounds().lower;
            one.upper = Bounds().upper;
            one.*side = bound ? 0 : bounds.*side;
            out.push_back(
                {name_of(node, bound ? less(measured, *bound) : measured), one, bound ? beyond(quantity, *bound, measured) : quantity});
        };
        add("lower", lower, &Bounds::lower);
        add("upper", upper, &Bounds::upper);
    }

    // Reads bounds; those that parameters change have the values at the parameters' values.
    Bounds read_bounds(const JsonNode& node, Dimension dimension, const std::optional<MovingBound>& lower,
                       const std::optional<MovingBound>& upper) const {
        Bounds bounds;
        bounds.unit = context_.unit_of({node["upper"], node["lower"]}, dimension);
        const auto amount = [&](const std::string& key) -> std::optional<double> {
            if (key == "lower" && lower) return context_.formulas.value_of(lower->formula);
            if (key == "upper" && upper) return context_.formulas.value_of(upper->formula);
            return node[key].quantity(dimension, context_.unit(dimension));
        };
        bounds.lower = amount("lower").value_or(bounds.lower);
        bounds.upper = amount("upper").value_or(bounds.upper);
        if (bounds.lower > bounds.upper) {
            node["lower"].fail(ErrorCode::inconsistent,
                               "the lower bound " + node["lower"].shown() + " is above the upper bound " + node["upper"].shown());
        }
        const double largest =
            std::max(std::isfinite(bounds.lower) ? std::abs(bounds.lower) : 0, std::isfinite(bounds.upper) ? std::abs(bounds.upper) : 0);
        constexpr double usual_share = 1e-4;
        const double usual = dimension == Dimension::length ? clearance_margin_ : usual_share * (largest > 0 ? largest : bounds.unit);
        bounds.margin = amount("margin").value_or(usual);
        if (bounds.margin < 0) node["margin"].fail(ErrorCode::out_of_range, "a margin is not negative");
        bounds.margin = std::clamp(bounds.margin, 0.0, std::max(0.0, (bounds.upper - bounds.lower) / 4));
        return bounds;
    }

    const ReadContext& context_;
    double clearance_margin_;
    std::map<std::string, std::set<std::string>> names_of_choice_;
    std::set<std::string> names_;
};

}  // namespace

std::vector<Constraint> read_constraints(const JsonNode& node, const ReadContext& context, double clearance_margin) {
    std::vector<Constraint> result;
    ConstraintReader reader(context, clearance_margin);
    for (const JsonNode& entry : node.elements()) reader.read(entry, result);
    return result;
}

}  // namespace fettle::design::reading
