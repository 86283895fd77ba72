// SPDX-License-Identifier: MIT
/// fettle process FORM --name NAME: a process from what was measured of a coupon (tolerances/process_fit.hpp).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "design/cli/command.hpp"
#include "design/cli/inputs.hpp"
#include "design/coupons/coupon_form.hpp"
#include "design/reading/process_file.hpp"
#include "design/tolerances/known_processes.hpp"
#include "design/tolerances/process_clearance.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using core::base::formatted;
using Json = nlohmann::ordered_json;
using tolerances::KindFit;
using tolerances::Process;
using tolerances::ProcessFit;

struct ProcessArguments {
    std::vector<std::string> forms;
    std::string name, base = "fdm", folder = ".";
    bool replace = false;
};

Json interval_json(const tolerances::Interval& interval) {
    return {{"value", interval.value}, {"least", interval.least}, {"most", interval.most}};
}

Json kind_json(const KindFit& kind) {
    Json outliers = Json::array();
    for (const auto& outlier : kind.outliers)
        outliers.push_back({{"feature", outlier.name}, {"residual", outlier.residual}, {"studentised", outlier.studentised}});
    return {{"kind", to_string(kind.kind)},
            {"features", kind.features},
            {"measurements", kind.measurements},
            {"from", kind.from},
            {"up_to", kind.up_to},
            {"mean_size", kind.mean_size},
            {"bias", interval_json(kind.bias)},
            {"bias_per_size", kind.has_slope ? interval_json(kind.bias_per_size) : Json()},
            {"spread", interval_json(kind.spread)},
            {"spread_without_measuring", kind.process_spread},
            {"spread_bound", kind.spread_bound},
            {"prints", kind.prints},
            {"between_prints", kind.components ? interval_json(kind.components->between) : Json()},
            {"shared", kind.components ? interval_json(kind.components->share) : Json()},
            {"taken", taken_spread(kind)},
            {"degrees_of_freedom", kind.degrees_of_freedom},
            {"outliers", std::move(outliers)}};
}

Json fit_json(const ProcessFit& fit, const std::string& file, const std::string& base) {
    Json kinds = Json::array(), too_few = Json::array();
    for (const KindFit& kind : fit.kinds) kinds.push_back(kind_json(kind));
    for (const auto& few : fit.too_few) too_few.push_back({{"kind", to_string(few.kind)}, {"features", few.features}});
    return {{"status", "ok"},
            {"file", file},
            {"based_on", base},
            {"confidence", 0.95},
            {"repeatability", fit.repeats > 0 ? Json(fit.repeatability) : Json()},
            {"repeats", fit.repeats},
            {"prints", fit.prints},
            {"kinds", std::move(kinds)},
            {"too_few", std::move(too_few)}};
}

std::string in_mm(double metres) { return formatted("%.3f", metres * 1e3); }

// How prints differ, where there are several.
std::string between_text(const KindFit& kind) {
    if (!kind.components) return {};
    const tolerances::Interval &between = kind.components->between, &share = kind.components->share;
    return " within a print, " + in_mm(between.value) + " mm (" + in_mm(between.least) + " to " + in_mm(between.most) + ") between " +
           std::to_string(kind.prints) + " prints, which share " +
           formatted("%.0f%% (%.0f%% to %.0f%%)", 100 * share.value, 100 * share.least, 100 * share.most) + " of the variance";
}

std::string kind_text(const KindFit& kind, const std::string& base) {
    std::string text = formatted("%-7s %2d, %.3g to %.3g mm: ", to_string(kind.kind), kind.features, kind.from * 1e3, kind.up_to * 1e3);
    text += formatted("bias %+.3f mm (%+.3f to %+.3f)", kind.bias.value * 1e3, kind.bias.least * 1e3, kind.bias.most * 1e3);
    if (kind.has_slope)
        text += formatted(" at %.3g mm, %+.2f%% of the size (%+.2f to %+.2f)", kind.mean_size * 1e3, kind.bias_per_size.value * 100,
                          kind.bias_per_size.least * 100, kind.bias_per_size.most * 100);
    if (has_spread(kind))
        text += "; spread " + in_mm(kind.spread.value) + " mm (" + in_mm(kind.spread.least) + " to " + in_mm(kind.spread.most) + ")" +
                between_text(kind) + ", taken as " + in_mm(taken_spread(kind)) + "\n";
    else
        text += "; no spread is seen, since all are off by the same: limits about the bias as " + base + "; measure in finer steps\n";
    for (const auto& outlier : kind.outliers)
        text += "        " + outlier.name + " lies " + formatted("%+.3f", outlier.residual * 1e3) + " mm off the others' line (" +
                (std::abs(outlier.studentised) < 100 ? formatted("%.1f", std::abs(outlier.studentised)) : std::string("more than 100")) +
                " of their spreads): measure it again; it is in the fit as it is\n";
    return text;
}

std::string of_prints(const ProcessFit& fit, const Process& base) {
    const std::string taken =
        formatted("%.0f%%", base.correlation * 100) + " of their variance (`correlation`) is taken from " + base.name + "\n";
    if (fit.prints == 1) return "one print does not show how prints differ: that its features share " + taken;
    std::string text = "how prints differ is what the features of one print share (`correlation` of each kind)";
    if (fit.prints < tolerances::least_bounded_prints)
        text += formatted("; of %d prints it is taken as it was found, and may be far more: of %d on it is bounded", fit.prints,
                          tolerances::least_bounded_prints);
    return text + "\nthat features of kinds that were measured in one print, or none, share " + taken;
}

std::string fit_text(const ProcessFit& fit, const Process& base, const std::string& file) {
    std::string text =
        file + "\nhow much larger than drawn it comes out, and one standard deviation; in brackets where 95 of 100 such coupons have it:\n";
    for (const KindFit& kind : fit.kinds) text += kind_text(kind, base.name);
    for (const auto& few : fit.too_few)
        text += std::string(to_string(few.kind)) + ": " + std::to_string(few.features) + " measured, which takes at least " +
                std::to_string(tolerances::least_features) + "; as " + base.name + "\n";
    text += fit.repeats > 0 ? "measuring itself spreads by " + in_mm(fit.repeatability) + " mm, which is in the spreads above\n"
                            : std::string("no feature was measured twice: how much of the spread is the caliper's is not known\n");
    return text + "tolerances take the larger spread, which the true one is below with 95% confidence: more features bring it down\n" +
           of_prints(fit, base);
}

// What `clearance --process` asks for, which no coupon shows.
std::string clearance_text(const Process& fitted) {
    const std::string borrowed = tolerances::borrowed_clearance(fitted);
    return borrowed.empty() ? "" : "of the clearance between two parts " + borrowed + "\n";
}

Errors name_errors(const ProcessArguments& arguments, const fs::path& file) {
    if (tolerances::find_known_process(arguments.name) != nullptr)
        return {{ErrorCode::inconsistent, "--name",
                 "\"" + arguments.name + "\" is a known process; give yours another name: my_" + arguments.name}};
    if (arguments.name.empty() || arguments.name.find('/') != std::string::npos || !core::base::name_fault(arguments.name).empty())
        return {{ErrorCode::out_of_range, "--name", "a process has a name that a file can have, without folders (--in FOLDER)"}};
    std::error_code code;
    if (!arguments.replace && fs::exists(file, code))
        return {{ErrorCode::inconsistent, file.string(), "is there already, and is left as it is; --replace replaces it"}};
    return {};
}

// A print each.
Result<std::vector<tolerances::MeasuredFeature>> read_forms(const std::vector<std::string>& forms) {
    std::vector<tolerances::MeasuredFeature> all;
    Errors errors;
    for (std::size_t k = 0; k < forms.size(); ++k) {
        std::error_code code;
        for (std::size_t j = 0; j < k; ++j)
            if (fs::equivalent(forms[j], forms[k], code))
                errors.push_back({ErrorCode::inconsistent, forms[k], "is given twice: each form is of a print of its own"});
        const auto features = coupons::read_form(forms[k]);
        errors.insert(errors.end(), features.errors().begin(), features.errors().end());
        if (!features) continue;
        const bool is_empty = std::all_of(features->begin(), features->end(), [](const auto& each) { return each.measured.empty(); });
        if (is_empty && forms.size() > 1) errors.push_back({ErrorCode::out_of_range, forms[k], "nothing is measured in it"});
        for (tolerances::MeasuredFeature feature : *features) {
            feature.print = static_cast<int>(k);
            all.push_back(std::move(feature));
        }
    }
    if (!errors.empty()) return errors;
    return all;
}

int run_process(const ProcessArguments& arguments, Console& console) {
    const fs::path file = (fs::path(arguments.folder) / (arguments.name + reading::process_ending)).lexically_normal();
    if (const Errors errors = name_errors(arguments, file); !errors.empty()) return console.input_errors(errors);
    const Result<std::vector<tolerances::MeasuredFeature>> features = read_forms(arguments.forms);
    if (!features) return console.input_errors(features.errors());
    const Result<ProcessFit> fit = tolerances::fit_process(*features, core::base::joined(arguments.forms));
    if (!fit) return console.input_errors(fit.errors());
    const Process& base = *tolerances::find_known_process(arguments.base);
    const Process fitted = fitted_process(*fit, arguments.name, base);
    if (const Errors errors = core::files::write_file_atomically(file, reading::process_text(*fit, fitted, base.name)); !errors.empty())
        return console.input_errors(errors);
    console.result(fit_json(*fit, file.string(), base.name), fit_text(*fit, base, file.string()) + clearance_text(fitted) +
                                                                 "next: fettle tolerance DESIGN --process " + arguments.name + "\n");
    return exit_done;
}

std::vector<std::string> known_names() {
    const auto names = tolerances::known_process_names();
    return {names.begin(), names.end()};
}

}  // namespace

Command add_process(CommandLine& program) {
    CommandLine app = program.command("process", "Makes a process of what you measured of a coupon: bias and spread by kind of feature");
    auto options = std::make_shared<ProcessArguments>();
    app.option("FORMS", options->forms, "The coupon's form with what you measured, X.csv; of several prints, each with its own").required();
    app.option("--name", options->name, "What it is called: NAME.process.json is written").required();
    app.option("--based-on", options->base, "What holds for kinds that are not measured (default fdm)").one_of(known_names());
    app.option("--in", options->folder, "Folder to write into (default: this one)");
    app.flag("--replace", options->replace, "Replace a process of this name");
    app.closing_words(
        "Example:  fettle process coupon.csv --name mine && fettle tolerance made.design.json --process mine\n"
        "Fits, for each kind of feature, how much larger than drawn it comes out (by size, from five features of three sizes on) and how\n"
        "much it spreads, with 95% intervals. Rows that are empty are left out; rows may be added. Tolerances take the upper bound of\n"
        "the spread, not the estimate, which from few features is often too small. Of several prints, a form each, how they differ is\n"
        "fitted too: what the parts of one print share.");
    return {app, [options](Console& console) { return run_process(*options, console); }};
}

}  // namespace fettle::design::cli
