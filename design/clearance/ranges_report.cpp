// SPDX-License-Identifier: MIT
#include "design/clearance/ranges_report.hpp"

#include <algorithm>

namespace fettle::design::clearance {

namespace {

using core::clearance::JointRanges;

Result<std::vector<int>> coordinates_of(const JointRanges& ranges, const std::vector<std::string>& names) {
    std::vector<int> out;
    if (names.empty())
        for (int k = 0; k < count_of(ranges.linkage.coordinates); ++k)
            if (!is_direction(ranges, k)) out.push_back(k);
    for (const std::string& name : names) {
        const Result<int> found = core::clearance::coordinate_of(ranges, name);
        if (!found) return Error{found.errors().front().code, "--joint", found.errors().front().message};
        out.push_back(*found);
    }
    return out;
}

std::vector<std::pair<int, int>> pairs_of(const PairSelection& selection) {
    std::vector<std::pair<int, int>> out = selection.joined;
    for (const PairSpec& pair : selection.pairs) out.insert(out.end(), pair.body_pairs.begin(), pair.body_pairs.end());
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> not_looked_at(const core::model::Model& model, const PairSelection& selection) {
    std::vector<std::string> out;
    for (const std::string& each : selection.ignored) out.push_back(each + " (--ignore)");
    for (const std::string& each : pair_names(model, selection.ignored_by_scene)) out.push_back(each + " (the scene's `ignore`)");
    for (const std::string& each : pair_names(model, selection.one_group)) out.push_back(each + " (of one group)");
    return out;
}

}  // namespace

Result<RangesReport> ask_ranges(const core::model::Model& model, const RangesQuestion& question) {
    const double reach = question.reach.value_or(model.diagonal);
    Result<JointRanges> ranges =
        core::clearance::joint_ranges(model, question.options.others_anywhere ? std::nullopt : std::optional(reach));
    if (!ranges) return ranges.errors();
    const Result<std::vector<int>> coordinates = coordinates_of(*ranges, question.joints);
    if (!coordinates) return coordinates.errors();
    PairOptions pairs;
    pairs.ignore = question.ignore;
    const Result<PairSelection> selection = select_pairs(model, pairs, false);
    if (!selection) return selection.errors();
    RangesReport report{model, *std::move(ranges), {}, question.options, reach, not_looked_at(model, *selection)};
    const auto stopped = [&] { return question.options.should_stop && question.options.should_stop(); };
    int done = 0;
    for (const int coordinate : *coordinates) {
        if (stopped()) break;
        if (question.on_joint) question.on_joint(done++, count_of(*coordinates));
        const auto found = core::clearance::free_ranges(model, report.ranges, {coordinate}, pairs_of(*selection), reach, question.options);
        report.found.insert(report.found.end(), found.begin(), found.end());
    }
    report.interrupted = stopped();
    return report;
}

}  // namespace fettle::design::clearance
