// SPDX-License-Identifier: MIT
#include "fettle/design/reading/constraint_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fettle/design/quantities/clearance.hpp"
#include "fettle/design/reading/quantity_reader.hpp"
#include "fettle/design/reading/relation_reader.hpp"

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
        if (*type == "clearance") {
            read_clearance(node, out);
        } else {
            read_bounded(node, *find_quantity_type(*type), out);
        }
    }

private:
    std::string name_of(const JsonNode& node, const std::string& otherwise) {
        return unique_name(node["name"].string().value_or(otherwise), names_);
    }

    // `minimum` instead of bounds, and several constraints where the motion is divided.
    void read_clearance(const JsonNode& node, std::vector<Constraint>& out) {
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
        const std::string name = name_of(node, find_quantity_type("clearance")->default_name(node));
        for (int w = 0; w < windows; ++w) {
            const std::string part = windows > 1 ? name + " window " + std::to_string(w + 1) : name;
            const quantities::ClearanceRange range{*a, *b, motion, w, windows};
            out.push_back({part, bounds, std::make_shared<quantities::Clearance>(range, bounds.lower)});
        }
    }

    void read_bounded(const JsonNode& node, const QuantityType& type, std::vector<Constraint>& out) {
        std::vector<std::string_view> keys{"type", "name", "lower", "upper", "margin"};
        for (const std::string_view key : type.keys) {
            if (key != "target") keys.push_back(key);  // a constraint bounds the stroke itself
        }
        node.allow_keys(keys);
        std::shared_ptr<const description::Quantity> quantity = type.read(node, context_);
        if (!node["lower"].exists() && !node["upper"].exists()) {
            node.fail(ErrorCode::missing_key, "a constraint has `lower`, `upper` or both");
        }
        if (!quantity) return;
        const Bounds bounds = read_bounds(node, quantity->dimension());
        out.push_back({name_of(node, type.default_name(node)), bounds, std::move(quantity)});
    }

    Bounds read_bounds(const JsonNode& node, Dimension dimension) const {
        Bounds bounds;
        bounds.unit = context_.unit(dimension);
        const auto amount = [&](const char* key) { return node[key].quantity(dimension, bounds.unit); };
        bounds.lower = amount("lower").value_or(bounds.lower);
        bounds.upper = amount("upper").value_or(bounds.upper);
        if (bounds.lower > bounds.upper) {
            node["lower"].fail(ErrorCode::inconsistent,
                               "the lower bound " + node["lower"].shown() + " is above the upper bound " + node["upper"].shown());
        }
        const double largest =
            std::max(std::isfinite(bounds.lower) ? std::abs(bounds.lower) : 0, std::isfinite(bounds.upper) ? std::abs(bounds.upper) : 0);
        const double usual = dimension == Dimension::length ? clearance_margin_ : 1e-4 * largest;
        bounds.margin = amount("margin").value_or(usual);
        if (bounds.margin < 0) node["margin"].fail(ErrorCode::out_of_range, "a margin is not negative");
        bounds.margin = std::clamp(bounds.margin, 0.0, std::max(0.0, (bounds.upper - bounds.lower) / 4));
        return bounds;
    }

    const ReadContext& context_;
    double clearance_margin_;
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
