// SPDX-License-Identifier: MIT
#include "design/reading/tolerance_entry.hpp"

#include <cmath>

#include "core/base/text.hpp"
#include "core/expression/parse_formula.hpp"
#include "design/reading/process_file.hpp"
#include "design/reading/tolerance_cost_reader.hpp"
#include "design/tolerances/iso2768.hpp"
#include "design/tolerances/iso286.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Tolerance;
using tolerances::Distribution;
using tolerances::FeatureKind;
using tolerances::Process;

class EntryReader {
public:
    EntryReader(const JsonNode& node, const Nominal& nominal, const ToleranceUnits& units)
        : node_(node), nominal_(nominal), units_(units) {}

    void read(Tolerance& tolerance) const {
        if (node_.is_string()) {
            read_text(*node_.string(), tolerance);
            return;
        }
        node_.allow_keys({"lower", "upper", "class", "of", "general", "process", "feature", "leg", "distribution", "sigma_level", "shift",
                          "group", "correlation", "cost", "fixed"});
        if (!node_.is_object()) return;
        const bool is_made = node_["feature"].exists() || node_["process"].exists();
        const int ways =
            (node_["lower"].exists() || node_["upper"].exists()) + node_["class"].exists() + node_["general"].exists() + is_made;
        if (ways != 1)
            node_.fail(ErrorCode::inconsistent,
                       "a tolerance has `lower` and `upper`, or a `class` (\"H7\"), or `general` (\"m\"), or the `feature` that a process "
                       "makes (\"hole\"): one of these");
        if (node_["of"].exists() && !node_["class"].exists() && !is_made)
            node_["of"].fail(ErrorCode::inconsistent, "`of` goes with `class` or `feature`");
        if (node_["leg"].exists() && nominal_.unit.dimension != Dimension::angle && !is_default())
            node_["leg"].fail(ErrorCode::inconsistent, "`leg` is of an angle");
        else if (node_["leg"].exists() && !node_["general"].exists() && !is_made)
            node_["leg"].fail(ErrorCode::inconsistent, "`leg` goes with `general` or `feature`");
        if (node_["class"].exists()) read_class(tolerance);
        if (node_["general"].exists()) read_general(tolerance);
        if (node_["lower"].exists() || node_["upper"].exists()) read_limits(tolerance);
        if (is_made) read_feature(tolerance);
        read_distribution(tolerance.deviation);
        read_group(tolerance);
        read_cost(node_, nominal_.value, nominal_.unit, tolerance);
    }

    /// Why this number has no tolerance of "*"; empty: it has. Contract: the entry is without faults.
    std::string why_not() const {
        const bool is_angle = nominal_.unit.dimension == Dimension::angle;
        if (!is_angle && nominal_.unit.dimension != Dimension::length) return "no length or angle";
        if (nominal_.value == 0) return "of size 0";
        if (is_angle && (!node_.is_object() || !node_["leg"].exists()))
            return "an angle, whose tolerance goes by its shorter leg: say `leg` here, or give it one";
        if (node_.is_object() && node_["general"].exists()) return first_message(general_limits(*node_["general"].string(), ""));
        const auto feature = feature_named(node_.is_string() ? node_ : node_["feature"]);
        const auto process = node_.is_string() ? usual_process() : process_of_entry();
        return first_message(process_deviation(*process, is_angle ? FeatureKind::angle : *feature, size_of(*feature), ""));
    }

private:
    std::optional<double> amount(const JsonNode& node) const { return node.quantity(nominal_.unit.dimension, to_si(1, nominal_.unit)); }
    std::string in_unit(double si) const {
        return core::base::formatted("%.6g", description::from_si(si, nominal_.unit)) +
               (nominal_.unit.dimension == Dimension::number ? "" : " " + std::string(nominal_.unit.name));
    }

    template <class T>
    static std::string first_message(const Result<T>& result) {
        return result ? "" : result.errors().front().message;
    }

    // "+-0.05 mm", "H7", "hole".
    void read_text(const std::string& text, Tolerance& tolerance) const {
        if (tolerances::feature_kind(text)) {
            take_feature(*tolerances::feature_kind(text), usual_process(), node_, 1, tolerance);
            return;
        }
        if (!text.starts_with("+-")) {
            take_class(node_, text, 1, tolerance);
            return;
        }
        core::expression::Scope scope;
        const auto formula = core::expression::parse_formula_of(text.substr(2), scope, nominal_.unit.dimension, to_si(1, nominal_.unit));
        for (const Error& error : formula.errors())
            node_.fail(error.code, error.message + "; a tolerance is \"+-0.05 mm\", \"H7\" or \"hole\"");
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

    // An entry for all numbers without one, of lengths and angles alike.
    bool is_default() const { return node_.pointer().ends_with("/*"); }

    double leg() const { return node_["leg"].length(to_si(1, units_.length), core::files::positive).value_or(0); }

    Result<tolerances::DeviationLimits> general_limits(const std::string& name, const std::string& where) const {
        return nominal_.unit.dimension == Dimension::angle ? tolerances::iso2768_angle(name, leg(), where)
                                                           : tolerances::iso2768_linear(name, nominal_.value, where);
    }

    void read_general(Tolerance& tolerance) const {
        const JsonNode at = node_["general"];
        const auto name = at.choice({"f", "m", "c", "v"});
        if (!name) return;
        const bool is_angle = nominal_.unit.dimension == Dimension::angle;
        if (!is_angle && nominal_.unit.dimension != Dimension::length) {
            at.fail(ErrorCode::wrong_type, "a general tolerance is of a length or an angle; other tolerances are \"+-0.5 N\"");
            return;
        }
        if (is_angle && !node_["leg"].exists()) {
            at.fail(ErrorCode::missing_key,
                    "a general tolerance of an angle goes by its shorter leg: say \"leg\": \"20 mm\" beside it, or \"+-0.5 deg\"");
            return;
        }
        const auto limits = general_limits(*name, at.where());
        for (const Error& error : limits.errors()) at.fail(error.code, error.message);
        if (limits) set_limits(limits->lower, limits->upper, "ISO 2768-" + std::string(*name), tolerance);
    }

    // The kind that stands there; nothing, and told: there is none.
    std::optional<FeatureKind> feature_named(const JsonNode& at) const {
        const auto name = at.choice(tolerances::feature_kind_names());
        return name ? tolerances::feature_kind(*name) : std::nullopt;
    }

    std::optional<Process> usual_process() const {
        if (!units_.processes.usual)
            node_.fail(ErrorCode::missing_key,
                       "which process makes it? Say \"process\": \"fdm\" beside `tolerances` for the whole design, or in the entry, or "
                       "--process fdm");
        return units_.processes.usual;
    }

    // The process that an entry names, if it is an object.
    std::optional<Process> process_of_entry() const {
        const JsonNode at = node_["process"];
        if (!at.exists()) return usual_process();
        const auto name = at.string();
        if (!name) return std::nullopt;
        const Result<Process> process = find_process(*name, units_.processes.folder, at.where());
        for (const Error& error : process.errors()) at.fail(error.code, error.message);
        return process ? std::optional<Process>(*process) : std::nullopt;
    }

    void read_feature(Tolerance& tolerance) const {
        const double times = node_["of"].choice({"diameter", "radius"}).value_or("diameter") == "radius" ? 2 : 1;
        if (node_["of"].exists() && is_default())
            node_["of"].fail(ErrorCode::inconsistent, "`of` is of one number; \"*\" is of all others");
        const auto feature = feature_named(node_.require("feature"));
        if (feature) take_feature(*feature, process_of_entry(), node_["feature"], times, tolerance);
    }

    double size_of(FeatureKind feature) const {
        return nominal_.unit.dimension == Dimension::angle || feature == FeatureKind::angle ? leg() : nominal_.value;
    }

    // @param times  The diameter over the number.
    void take_feature(FeatureKind feature, const std::optional<Process>& process, const JsonNode& at, double times,
                      Tolerance& tolerance) const {
        const bool is_angle = nominal_.unit.dimension == Dimension::angle;
        if (is_angle && is_default()) feature = FeatureKind::angle;
        if (!is_angle && nominal_.unit.dimension != Dimension::length) {
            at.fail(ErrorCode::wrong_type, "a process makes lengths and angles; other tolerances are \"+-0.5 N\"");
            return;
        }
        if (is_angle != (feature == FeatureKind::angle)) {
            at.fail(ErrorCode::wrong_type, is_angle
                                               ? "this number is an angle: the feature is \"angle\", with its shorter \"leg\": \"20 mm\""
                                               : "this number is a length; \"angle\" is of angles");
            return;
        }
        if (is_angle && (!node_.is_object() || !node_["leg"].exists())) {
            at.fail(ErrorCode::missing_key,
                    "what a process makes of an angle goes by its shorter leg: {\"feature\": \"angle\", \"leg\": \"20 mm\"}");
            return;
        }
        if (!process) return;
        const auto made = tolerances::process_deviation(*process, feature, times * size_of(feature), at.where());
        for (const Error& error : made.errors()) at.fail(error.code, error.message);
        if (!made) return;
        if (!made->is_sure_size) warn_of_size(*process, feature, times, at);
        set_limits(made->limits.lower / times, made->limits.upper / times, process->name + " " + to_string(feature), tolerance);
        const tolerances::SharedPart shared = shared_part(*process, feature);
        tolerance.group = shared.group;
        tolerance.correlation = shared.correlation;
    }

    void warn_of_size(const Process& process, FeatureKind kind, double times, const JsonNode& at) const {
        const tolerances::FeatureSpread& known = *find_feature(process, kind);
        const auto shown = [&](double size) { return in_length(size); };
        at.warn(shown(times * size_of(kind)) + " is beyond the sizes at which \"" + process.name + "\" was measured for this kind, " +
                shown(known.from) + " to " + shown(known.up_to) + ": the bias of the nearest of them is taken");
    }
    std::string in_length(double metres) const { return core::base::format_length(metres, units_.length.name, 4); }
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

    // What a process makes has the group of its print; this one, or none, where the entry says so.
    void read_group(Tolerance& tolerance) const {
        const bool is_normal = tolerance.deviation.kind == tolerances::DistributionKind::normal;
        if (node_["group"].exists()) {
            tolerance.group = node_["group"].string().value_or("");
            tolerance.correlation = 1;
        } else if (!is_normal) {
            tolerance.group.clear();
        }
        tolerance.correlation = node_["correlation"].number({-1, 1}).value_or(tolerance.correlation);
        if (node_["group"].is_string() && tolerance.group.empty()) node_["group"].fail(ErrorCode::out_of_range, "a group has a name");
        if (node_["correlation"].exists() && tolerance.group.empty())
            node_["correlation"].fail(ErrorCode::inconsistent, "`correlation` goes with `group`");
        if (!tolerance.group.empty() && !is_normal)
            node_["group"].fail(ErrorCode::unsupported,
                                "what varies with a group is normal; this one is " + std::string(to_string(tolerance.deviation.kind)));
    }

    const JsonNode& node_;
    const Nominal& nominal_;
    const ToleranceUnits& units_;
};

}  // namespace

void read_entry(const JsonNode& node, const Nominal& nominal, const ToleranceUnits& units, Tolerance& tolerance) {
    EntryReader(node, nominal, units).read(tolerance);
    constexpr double smallest = 1e-30;  // powers of it are still numbers
    const double width = tolerance.deviation.upper - tolerance.deviation.lower;
    if (width > 0 && width < smallest)
        node.fail(ErrorCode::out_of_range,
                  "limits that are less than 1e-30 apart (in SI) cannot be told from none; say 0, or leave the tolerance out");
}

std::string why_no_tolerance(const JsonNode& node, const Nominal& nominal, const ToleranceUnits& units) {
    return EntryReader(node, nominal, units).why_not();
}

}  // namespace fettle::design::reading
