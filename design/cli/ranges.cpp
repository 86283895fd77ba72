// SPDX-License-Identifier: MIT
/// fettle ranges FILE: from where to where each joint is proven free, and what stops it.
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/nearest_word.hpp"
#include "design/answers/ranges_answer.hpp"
#include "design/clearance/pairs.hpp"
#include "design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using answers::RangesAnswer;
using answers::RangesStatus;
using core::clearance::FreeRange;
using core::clearance::JointRanges;

struct RangesArguments {
    std::string path, minimum, tolerance, reach;
    std::vector<std::string> joints;
    clearance::PairOptions pairs;
    bool anywhere = false;
};

// Coordinates by the names of their joints; all, where none is named.
Result<std::vector<int>> coordinates_of(const JointRanges& ranges, const std::vector<std::string>& names) {
    std::vector<int> out;
    if (names.empty())
        for (int k = 0; k < count_of(ranges.linkage.coordinates); ++k) out.push_back(k);
    for (const std::string& name : names) {
        const std::optional<int> found = core::clearance::coordinate_of(ranges, name);
        std::vector<std::string_view> known;
        for (const auto& coordinate : ranges.linkage.coordinates)
            for (const auto& joint : coordinate.joints) known.emplace_back(joint.joint);
        if (!found)
            return Error{ErrorCode::out_of_range, "--joint",
                         "no joint that moves is called \"" + name + "\"; " + core::files::did_you_mean(name, known)};
        out.push_back(*found);
    }
    return out;
}

struct Asked {
    core::clearance::FreeRangeOptions options;
    std::optional<double> reach;
};

Result<Asked> read_numbers(const RangesArguments& options) {
    Asked asked;
    Errors errors;
    const auto read = [&](const std::string& text, const char* option, bool may_be_zero, double& out) {
        const Result<double> value = core::base::parse_length(text, option);
        errors.insert(errors.end(), value.errors().begin(), value.errors().end());
        if (!value) return;
        if (*value < 0 || (*value == 0 && !may_be_zero))
            errors.push_back({ErrorCode::out_of_range, option, may_be_zero ? "this is not negative" : "this is greater than 0"});
        out = *value;
    };
    if (!options.minimum.empty()) read(options.minimum, "--minimum", true, asked.options.minimum);
    if (!options.reach.empty()) read(options.reach, "--reach", false, asked.reach.emplace());
    if (const Result<double> angle = core::base::parse_quantity(options.tolerance, core::base::Dimension::angle, "--tolerance");
        !options.tolerance.empty() && angle) {
        if (!(*angle > 0)) errors.push_back({ErrorCode::out_of_range, "--tolerance", "this is greater than 0"});
        asked.options.angle = *angle;
    } else if (!options.tolerance.empty()) {
        read(options.tolerance, "--tolerance", false, asked.options.length);
    }
    if (!errors.empty()) return errors;
    asked.options.others_anywhere = options.anywhere;
    return asked;
}

std::vector<std::pair<int, int>> pairs_of(const clearance::PairSelection& selection) {
    std::vector<std::pair<int, int>> out = selection.joined;
    for (const clearance::PairSpec& pair : selection.pairs) out.insert(out.end(), pair.body_pairs.begin(), pair.body_pairs.end());
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> not_looked_at(const core::model::Model& model, const clearance::PairSelection& selection) {
    std::vector<std::string> out;
    for (const std::string& each : selection.ignored) out.push_back(each + " (--ignore)");
    for (const std::string& each : clearance::pair_names(model, selection.ignored_by_scene))
        out.push_back(each + " (the scene's `ignore`)");
    for (const std::string& each : clearance::pair_names(model, selection.one_group)) out.push_back(each + " (of one group)");
    return out;
}

void tell_checks(const RangesAnswer& answer, const std::string& file, Console& console) {
    for (const FreeRange& range : answer.found) {
        const RangesAnswer one{answer.model, answer.ranges, {range}, answer.asked, answer.reach, {}};
        const RangesStatus status = answers::status_of(one);
        console.found({answer.ranges.linkage.coordinates[range.coordinate].joints.front().joint,
                       status == RangesStatus::ok      ? CheckOutcome::passed
                       : status == RangesStatus::clash ? CheckOutcome::failed
                                                       : CheckOutcome::undecided,
                       status == RangesStatus::clash ? "clash" : answers::to_string(status), answers::range_sentence(answer, range), file});
    }
}

int run_ranges(const RangesArguments& options, const CommonOptions& common, Console& console) {
    const Result<Asked> asked = read_numbers(options);
    if (!asked) return console.input_errors(asked.errors());
    const Result<LoadedModel> loaded = load_model(options.path, common, false);
    if (!loaded) return console.input_errors(loaded.errors());
    tell_warnings(console, loaded->warnings, options.path);
    const core::model::Model& model = loaded->model;
    const double reach = asked->reach.value_or(model.diagonal);
    const std::optional<double> without_limits = options.anywhere ? std::nullopt : std::optional(reach);
    const auto with_file = [&](Errors errors) {
        for (Error& error : errors) error.where = options.path + ": " + error.where;
        return errors;
    };
    const Result<JointRanges> ranges = core::clearance::joint_ranges(model, without_limits);
    if (!ranges) return console.input_errors(with_file(ranges.errors()));
    const Result<std::vector<int>> coordinates = coordinates_of(*ranges, options.joints);
    if (!coordinates) return console.input_errors(coordinates.errors());
    const Result<clearance::PairSelection> selection = clearance::select_pairs(model, options.pairs, false);
    if (!selection) return console.input_errors(selection.errors());
    RangesAnswer answer{model, *ranges, {}, asked->options, reach, not_looked_at(model, *selection)};
    answer.asked.should_stop = interrupted;
    int done = 0;
    for (const int coordinate : *coordinates) {
        if (interrupted()) break;
        console.progress("looking along the joints", done++, count_of(*coordinates));
        const auto found = core::clearance::free_ranges(model, *ranges, {coordinate}, pairs_of(*selection), reach, answer.asked);
        answer.found.insert(answer.found.end(), found.begin(), found.end());
    }
    console.end_progress();
    answer.interrupted = interrupted();
    tell_checks(answer, options.path, console);
    console.result(answers::ranges_json(answer), answers::ranges_text(answer));
    const RangesStatus status = answers::status_of(answer);
    return status == RangesStatus::ok ? exit_done : status == RangesStatus::clash ? exit_violated : exit_undecided;
}

}  // namespace

Command add_ranges(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("ranges", "Finds from where to where each joint is proven free, and what stops it");
    auto options = std::make_shared<RangesArguments>();
    app.option("FILE", options->path, "Scene or design (at its values); limits of the joint that is looked at have no effect").required();
    app.option("--joint", options->joints, "Joint to look at (can be given several times; default: each that moves)").one_value_each();
    app.option("--minimum", options->minimum, "Clearance that is kept, per side, with its unit: 0.3mm (default: the bodies do not meet)");
    app.option("--ignore", options->pairs.ignore, "Pairs A:B,... that are not looked at");
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
