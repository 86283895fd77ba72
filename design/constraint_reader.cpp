// SPDX-License-Identifier: MIT
#include "fettle/design/constraint_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fettle/design/constraints/bounded_objective.hpp"
#include "fettle/design/constraints/clearance_constraint.hpp"
#include "fettle/design/parameter_reader.hpp"

namespace fettle::design {

namespace {

using constraints::Bounds;
using constraints::Constraint;
using core::files::JsonNode;

class ConstraintReader {
public:
    ConstraintReader(const objectives::ReadContext& context, double clearance_margin)
        : context_(context), clearance_margin_(clearance_margin) {}

    void read(const JsonNode& node, std::vector<std::unique_ptr<Constraint>>& out) {
        std::vector<std::string_view> types{"clearance"};
        for (const auto& type : objectives::objective_table()) types.push_back(type.name);
        const auto type = node.require("type").choice(types);
        if (!type) return;
        if (*type == "clearance") {
            read_clearance(node, out);
        } else {
            read_bounded(node, *objectives::find_objective_type(*type), out);
        }
    }

private:
    std::string name_of(const JsonNode& node, const std::string& otherwise) {
        return unique_name(node["name"].string().value_or(otherwise), names_);
    }

    void read_clearance(const JsonNode& node, std::vector<std::unique_ptr<Constraint>>& out) {
        node.allow_keys({"type", "name", "a", "b", "minimum", "margin", "motion", "windows"});
        const auto a = context_.body(node.require("a")), b = context_.body(node.require("b"));
        Bounds bounds;
        bounds.unit = context_.length_unit;
        bounds.lower = node.require("minimum").length(context_.length_unit, core::files::positive).value_or(0);
        bounds.margin = node["margin"].length(context_.length_unit, core::files::not_negative).value_or(clearance_margin_);
        const bool motion = node["motion"].boolean().value_or(false);
        const int windows = node["windows"].integer(1, 1000).value_or(1);
        if (windows > 1 && !motion) node["windows"].fail(ErrorCode::inconsistent, "`windows` divide the motion; set `motion` to true");
        if (!a || !b) return;
        if (*a == *b) node.fail(ErrorCode::inconsistent, "a clearance is between two bodies; `a` and `b` are the same");
        const core::scene::Body &body_a = context_.scene.bodies[static_cast<size_t>(*a)],
                                &body_b = context_.scene.bodies[static_cast<size_t>(*b)];
        const std::string name = name_of(node, "clearance " + body_a.name + ":" + body_b.name + (motion ? " over the motion" : ""));
        for (int w = 0; w < windows; ++w) {
            const std::string part = windows > 1 ? name + " window " + std::to_string(w + 1) : name;
            out.push_back(std::make_unique<constraints::ClearanceConstraint>(
                part, bounds, constraints::ClearanceRequirement{*a, *b, motion, w, windows}));
        }
    }

    void read_bounded(const JsonNode& node, const objectives::ObjectiveType& type, std::vector<std::unique_ptr<Constraint>>& out) {
        std::vector<std::string_view> keys{"type", "name", "lower", "upper", "margin"};
        for (const std::string_view key : type.keys) {
            if (key != "target") keys.push_back(key);  // a constraint bounds the stroke itself
        }
        node.allow_keys(keys);
        std::unique_ptr<objectives::Objective> objective = type.read(node, context_);
        if (!node["lower"].exists() && !node["upper"].exists()) {
            node.fail(ErrorCode::missing_key, "a constraint has `lower`, `upper` or both");
        }
        if (!objective) return;
        const double unit = objective->unit(context_.length_unit);
        const Bounds bounds = read_bounds(node, unit);
        out.push_back(
            std::make_unique<constraints::BoundedObjective>(name_of(node, type.default_name(node)), bounds, std::move(objective)));
    }

    // Lengths may carry a unit of their own; squared lengths and masses are plain numbers in the file's units and grams.
    std::optional<double> read_amount(const JsonNode& node, double unit) const {
        if (unit == context_.length_unit) return node.length(unit);
        const auto number = node.number();
        return number ? std::optional<double>(*number * unit) : std::nullopt;
    }

    Bounds read_bounds(const JsonNode& node, double unit) const {
        Bounds bounds;
        bounds.unit = unit;
        if (const auto lower = read_amount(node["lower"], unit)) bounds.lower = *lower;
        if (const auto upper = read_amount(node["upper"], unit)) bounds.upper = *upper;
        if (bounds.lower > bounds.upper) {
            node["lower"].fail(ErrorCode::inconsistent,
                               "the lower bound " + node["lower"].shown() + " is above the upper bound " + node["upper"].shown());
        }
        const double largest =
            std::max(std::isfinite(bounds.lower) ? std::abs(bounds.lower) : 0, std::isfinite(bounds.upper) ? std::abs(bounds.upper) : 0);
        const double usual = unit == context_.length_unit ? clearance_margin_ : 1e-4 * largest;
        bounds.margin = read_amount(node["margin"], unit).value_or(usual);
        if (bounds.margin < 0) node["margin"].fail(ErrorCode::out_of_range, "a margin is not negative");
        bounds.margin = std::clamp(bounds.margin, 0.0, std::max(0.0, (bounds.upper - bounds.lower) / 4));
        return bounds;
    }

    const objectives::ReadContext& context_;
    double clearance_margin_;
    std::set<std::string> names_;
};

}  // namespace

std::vector<std::unique_ptr<Constraint>> read_constraints(const JsonNode& node, const objectives::ReadContext& context,
                                                          double clearance_margin) {
    std::vector<std::unique_ptr<Constraint>> result;
    ConstraintReader reader(context, clearance_margin);
    for (const JsonNode& entry : node.elements()) reader.read(entry, result);
    return result;
}

}  // namespace fettle::design
