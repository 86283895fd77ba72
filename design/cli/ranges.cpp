// SPDX-License-Identifier: MIT
/// fettle ranges FILE: from where to where each joint is proven free, and what stops it.
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "design/clearance/ranges_report.hpp"
#include "design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using clearance::RangesReport;
using clearance::RangesStatus;
using core::clearance::FreeRange;

struct RangesArguments {
    std::string path, minimum, tolerance, reach, ignore;
    std::vector<std::string> joints;
    bool anywhere = false;
};

Result<clearance::RangesQuestion> question_of(const RangesArguments& options) {
    clearance::RangesQuestion question;
    question.joints = options.joints;
    question.ignore = options.ignore;
    question.options.others_anywhere = options.anywhere;
    question.options.should_stop = interrupted;
    Errors errors;
    const auto read = [&](const std::string& text, const char* option, bool may_be_zero, double& out) {
        const Result<double> value = core::base::parse_length(text, option);
        errors.insert(errors.end(), value.errors().begin(), value.errors().end());
        if (!value) return;
        if (*value < 0 || (*value == 0 && !may_be_zero))
            errors.push_back({ErrorCode::out_of_range, option, may_be_zero ? "this is not negative" : "this is greater than 0"});
        out = *value;
    };
    if (!options.minimum.empty()) read(options.minimum, "--minimum", true, question.options.minimum);
    if (!options.reach.empty()) read(options.reach, "--reach", false, question.reach.emplace());
    if (const Result<double> angle = core::base::parse_quantity(options.tolerance, core::base::Dimension::angle, "--tolerance");
        !options.tolerance.empty() && angle) {
        if (!(*angle > 0)) errors.push_back({ErrorCode::out_of_range, "--tolerance", "this is greater than 0"});
        question.options.angle = *angle;
    } else if (!options.tolerance.empty()) {
        read(options.tolerance, "--tolerance", false, question.options.length);
    }
    if (!errors.empty()) return errors;
    return question;
}

void tell_checks(const RangesReport& report, const std::string& file, Console& console) {
    for (const FreeRange& range : report.found) {
        const RangesStatus status = clearance::status_of(range);
        console.found({report.ranges.linkage.coordinates[range.coordinate].joints.front().joint,
                       status == RangesStatus::ok      ? CheckOutcome::passed
                       : status == RangesStatus::clash ? CheckOutcome::failed
                                                       : CheckOutcome::undecided,
                       to_string(status), clearance::range_sentence(report, range), file});
    }
}

int run_ranges(const RangesArguments& options, const CommonOptions& common, Console& console) {
    Result<clearance::RangesQuestion> question = question_of(options);
    if (!question) return console.input_errors(question.errors());
    const Result<LoadedModel> loaded = load_model(options.path, common, false);
    if (!loaded) return console.input_errors(loaded.errors());
    tell_warnings(console, loaded->warnings, options.path);
    question->on_joint = [&](int done, int of) { console.progress("looking along the joints", done, of); };
    const Result<RangesReport> report = clearance::ask_ranges(loaded->model, *question);
    console.end_progress();
    if (!report) {
        Errors errors = report.errors();
        for (Error& error : errors)
            if (!error.where.starts_with("--")) error.where = options.path + ": " + error.where;
        return console.input_errors(errors);
    }
    tell_checks(*report, options.path, console);
    console.result(clearance::ranges_json(*report), clearance::ranges_text(*report));
    const RangesStatus status = clearance::status_of(*report);
    return status == RangesStatus::ok ? exit_done : status == RangesStatus::clash ? exit_violated : exit_undecided;
}

}  // namespace

Command add_ranges(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("ranges", "Finds from where to where each joint is proven free, and what stops it");
    auto options = std::make_shared<RangesArguments>();
    app.option("FILE", options->path, "Scene or design (at its values); limits of the joint that is looked at have no effect").required();
    app.option("--joint", options->joints, "Joint to look at (can be given several times; default: each that moves)").one_value_each();
    app.option("--minimum", options->minimum, "Clearance that is kept, per side, with its unit: 0.3mm (default: the bodies do not meet)");
    app.option("--ignore", options->ignore, "Pairs A:B,... that are not looked at");
    app.option("--tolerance", options->tolerance,
               "How near an end is found: 0.1deg for turns, or 0.1mm for slides (default: 0.01deg, 0.01mm)");
    app.option("--reach", options->reach, "How far a slide is looked at, either way (default: the size of the scene)");
    app.flag("--anywhere", options->anywhere,
             "The other joints anywhere within their limits, up to four coordinates between two bodies (default: where they start)");
    app.closing_words(
        "Example:  fettle ranges examples/detent_hinge/detent_hinge.scene.json\n"
        "Each joint goes from its start on either way, until two bodies come closer than the minimum. What lies between the two ends is\n"
        "proven free; beyond an end nothing is said.");
    return {app, [options, &common](Console& console) { return run_ranges(*options, common, console); }};
}

}  // namespace fettle::design::cli
