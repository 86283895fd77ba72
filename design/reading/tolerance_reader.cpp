// SPDX-License-Identifier: MIT
#include "fettle/design/reading/tolerance_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fettle/core/base/text.hpp"
#include "fettle/core/expression/parse_formula.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/scene/place.hpp"
#include "fettle/design/reading/parameter_reader.hpp"
#include "fettle/design/reading/tolerance_cost_reader.hpp"
#include "fettle/design/tolerances/iso2768.hpp"
#include "fettle/design/tolerances/iso286.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Parameter;
using description::Tolerance;
using tolerances::Distribution;

/// What a tolerance is of.
struct Nominal {
    double value = 0;  ///< SI
    Unit unit;
};

class EntryReader {
public:
    EntryReader(const JsonNode& node, const Nominal& nominal) : node_(node), nominal_(nominal) {}

    void read(Tolerance& tolerance) const {
        if (node_.is_string()) {
            read_text(*node_.string(), tolerance);
            return;
        }
        node_.allow_keys(
            {"lower", "upper", "class", "of", "general", "distribution", "sigma_level", "shift", "group", "correlation", "cost", "fixed"});
        if (!node_.is_object()) return;
        const int ways = (node_["lower"].exists() || node_["upper"].exists()) + node_["class"].exists() + node_["general"].exists();
        if (ways != 1)
            node_.fail(ErrorCode::inconsistent,
                       "a tolerance has `lower` and `upper`, or a `class` (\"H7\"), or `general` (\"m\"): one of these");
        if (node_["of"].exists() && !node_["class"].exists()) node_["of"].fail(ErrorCode::inconsistent, "`of` goes with `class`");
        if (node_["class"].exists()) read_class(tolerance);
        if (node_["general"].exists()) read_general(tolerance);
        if (node_["lower"].exists() || node_["upper"].exists()) read_limits(tolerance);
        read_distribution(tolerance.deviation);
        read_group(tolerance);
        read_cost(node_, nominal_.value, nominal_.unit, tolerance);
    }

private:
    std::optional<double> amount(const JsonNode& node) const { return node.quantity(nominal_.unit.dimension, to_si(1, nominal_.unit)); }
    std::string in_unit(double si) const {
        return core::base::formatted("%.6g", description::from_si(si, nominal_.unit)) +
               (nominal_.unit.dimension == Dimension::number ? "" : " " + std::string(nominal_.unit.name));
    }

    // "+-0.05 mm", "H7".
    void read_text(const std::string& text, Tolerance& tolerance) const {
        if (!text.starts_with("+-")) {
            take_class(node_, text, 1, tolerance);
            return;
        }
        core::expression::Scope scope;
        const auto formula = core::expression::parse_formula_of(text.substr(2), scope, nominal_.unit.dimension, to_si(1, nominal_.unit));
        for (const Error& error : formula.errors()) node_.fail(error.code, error.message + "; a tolerance is \"+-0.05 mm\", or \"H7\"");
        if (!formula) return;
        const double size = core::expression::value_of<double>(*formula, {});
        if (!(size >= 0 && std::isfinite(size))) node_.fail(ErrorCode::out_of_range, "a tolerance is a number of at least 0");
        set_limits(size > 0 ? -size : 0, size, text, tolerance);
    }

    static void set_limits(double lower, double upper, const std::string& stated, Tolerance& tolerance) {
        tolerance.deviation.lower = lower;
        tolerance.deviation.upper = upper;
        tolerance.stated = stated;
    }

    void read_limits(Tolerance& tolerance) const {
        const auto lower = amount(node_["lower"]), upper = amount(node_["upper"]);
        for (const char* key : {"lower", "upper"})
            if (!node_[key].exists())
                node_.fail(ErrorCode::missing_key, "the other limit, `" + std::string(key) + "`, is missing (0 is one)");
        if (lower && upper && *lower > *upper)
            node_["lower"].fail(ErrorCode::inconsistent,
                                "the lower limit is above the upper one; both are deviations from the nominal value");
        set_limits(lower.value_or(0), upper.value_or(0), in_unit(lower.value_or(0)) + " to " + in_unit(upper.value_or(0)), tolerance);
    }

    void read_class(Tolerance& tolerance) const {
        const auto name = node_["class"].string();
        const double times = node_["of"].choice({"diameter", "radius"}).value_or("diameter") == "radius" ? 2 : 1;
        if (name) take_class(node_["class"], *name, times, tolerance);
    }

    // @param times  The diameter over the number.
    void take_class(const JsonNode& at, const std::string& name, double times, Tolerance& tolerance) const {
        if (nominal_.unit.dimension != Dimension::length) {
            at.fail(ErrorCode::wrong_type, "`" + name + "`: a class of ISO 286 is of a length; other tolerances are \"+-0.5 deg\"");
            return;
        }
        const auto limits = tolerances::iso286_limits(name, times * nominal_.value, at.where());
        for (const Error& error : limits.errors()) at.fail(error.code, error.message);
        if (limits) set_limits(limits->lower / times, limits->upper / times, name, tolerance);
    }

    void read_general(Tolerance& tolerance) const {
        const JsonNode at = node_["general"];
        const auto name = at.choice({"f", "m", "c", "v"});
        if (!name) return;
        if (nominal_.unit.dimension != Dimension::length) {
            at.fail(ErrorCode::wrong_type, "a general tolerance is of a length here; of an angle say \"+-0.5 deg\"");
            return;
        }
        const auto limits = tolerances::iso2768_linear(*name, nominal_.value, at.where());
        for (const Error& error : limits.errors()) at.fail(error.code, error.message);
        if (limits) set_limits(limits->lower, limits->upper, "ISO 2768-" + std::string(*name), tolerance);
    }

    void read_distribution(Distribution& deviation) const {
        using Kind = tolerances::DistributionKind;
        const auto kind = node_["distribution"].choice({"normal", "truncated", "uniform", "triangular"});
        if (kind)
            deviation.kind = *kind == "normal"      ? Kind::normal
                             : *kind == "truncated" ? Kind::truncated
                             : *kind == "uniform"   ? Kind::uniform
                                                    : Kind::triangular;
        deviation.sigma_level = node_["sigma_level"].number(core::files::positive).value_or(deviation.sigma_level);
        deviation.shift = amount(node_["shift"]).value_or(0);
        if (const std::string fault = fault_of(deviation); !fault.empty()) node_.fail(ErrorCode::out_of_range, fault);
    }

    void read_group(Tolerance& tolerance) const {
        tolerance.group = node_["group"].string().value_or("");
        tolerance.correlation = node_["correlation"].number({-1, 1}).value_or(tolerance.correlation);
        if (node_["group"].is_string() && tolerance.group.empty()) node_["group"].fail(ErrorCode::out_of_range, "a group has a name");
        if (node_["correlation"].exists() && !node_["group"].exists())
            node_["correlation"].fail(ErrorCode::inconsistent, "`correlation` goes with `group`");
        if (!tolerance.group.empty() && tolerance.deviation.kind != tolerances::DistributionKind::normal)
            node_["group"].fail(ErrorCode::unsupported,
                                "what varies with a group is normal; this one is " + std::string(to_string(tolerance.deviation.kind)));
    }

    const JsonNode& node_;
    const Nominal& nominal_;
};

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

}  // namespace

std::vector<ToleranceEntry> read_tolerances(const JsonNode& node, const std::vector<core::scene::Variable>& variables,
                                            const Unit& length_unit, std::vector<Parameter>& parameters) {
    std::vector<ToleranceEntry> entries;
    for (const auto& [name, entry] : node.members()) {
        Tolerance tolerance;
        tolerance.of = name;
        if (name.starts_with("/")) {
            entries.push_back({std::move(tolerance), entry, true});
            continue;
        }
        const std::optional<int> parameter = parameter_of(entry, name, variables, length_unit, parameters);
        if (!parameter) continue;
        tolerance.parameter = *parameter;
        EntryReader(entry, {parameters[*parameter].value, parameters[*parameter].unit}).read(tolerance);
        entries.push_back({std::move(tolerance), entry, false});
    }
    return entries;
}

void read_place_tolerances(std::vector<ToleranceEntry>& entries, const Unit& length_unit, description::Design& design) {
    for (ToleranceEntry& entry : entries) {
        if (!entry.is_place) continue;
        const core::scene::Scene scene = description::described_scene(design);
        const auto place = core::scene::find_place(scene, entry.tolerance.of);
        for (const Error& error : place.errors()) entry.node.fail(error.code, error.message);
        if (!place) continue;
        const Nominal nominal{core::scene::value_at(scene, *place), usual_unit(core::scene::dimension_at(scene, *place), length_unit)};
        const Result<int> parameter = description::add_deviation(design, entry.tolerance.of, nominal.unit);
        for (const Error& error : parameter.errors()) entry.node.fail(error.code, error.message);
        if (!parameter) continue;
        entry.tolerance.parameter = *parameter;
        EntryReader(entry.node, nominal).read(entry.tolerance);
    }
}

}  // namespace fettle::design::reading
