// SPDX-License-Identifier: MIT
#include "design/session/posing.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/free_ranges.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::session {

namespace {

using core::certificate::Linkage;
using core::clearance::JointRanges;
using core::clearance::PairClearance;

constexpr long most_box_pairs = 200'000;  // a pair that takes more is told with the bounds that it has by then

// The bodies that a coordinate carries: those with a screw of it, and their descendants.
std::vector<std::string> carried_by(const core::model::Model& model, const Linkage& linkage, int coordinate) {
    std::vector<std::string> names;
    for (std::size_t body = 0; body < linkage.bodies.size(); ++body) {
        bool is_carried = false;
        for (int k = static_cast<int>(body); k >= 0 && !is_carried; k = linkage.bodies[k].parent)
            for (const core::certificate::Screw& screw : linkage.bodies[k].screws)
                is_carried = is_carried || screw.coordinate == coordinate;
        if (is_carried) names.push_back(model.bodies[body].name);
    }
    return names;
}

}  // namespace

Result<Posing> Posing::of(std::shared_ptr<const core::model::Model> model) {
    Result<JointRanges> ranges = core::clearance::joint_ranges(*model, model->diagonal);
    if (!ranges) return ranges.errors();
    return Posing(std::move(model), std::move(ranges).value());
}

Posing::Posing(std::shared_ptr<const core::model::Model> model, JointRanges ranges)
    : model_(std::move(model)), ranges_(std::move(ranges)), pairs_(core::clearance::searched_pairs(*model_)) {
    for (std::size_t k = 0; k < ranges_.linkage.coordinates.size(); ++k) {
        const core::certificate::LinkageCoordinate& coordinate = ranges_.linkage.coordinates[k];
        JointHandle handle;
        handle.name = coordinate.joints.front().joint;
        handle.is_angle = coordinate.joints.front().is_angle;
        handle.start = coordinate.start;
        handle.low = coordinate.low;
        handle.high = coordinate.high;
        handle.has_limits = ranges_.has_limits[k];
        handle.moves = carried_by(*model_, ranges_.linkage, static_cast<int>(k));
        handles_.push_back(std::move(handle));
    }
}

Result<Posed> Posing::at(const std::map<std::string, double>& joints, bool depths) const {
    std::vector<double> at;
    std::vector<std::string_view> names;
    for (const JointHandle& handle : handles_) {
        at.push_back(handle.start);
        names.emplace_back(handle.name);
    }
    Errors errors;
    for (const auto& [name, value] : joints) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            errors.push_back(
                {ErrorCode::unknown_key, name, "there is no joint to be moved of this name; " + core::files::did_you_mean(name, names)});
            continue;
        }
        const auto k = static_cast<std::size_t>(found - names.begin());
        const double slack = 1e-9 * (handles_[k].high - handles_[k].low);
        if (!(value >= handles_[k].low - slack && value <= handles_[k].high + slack))
            errors.push_back({ErrorCode::out_of_range, name, "this is beyond the joint's ends"});
        else
            at[k] = std::clamp(value, handles_[k].low, handles_[k].high);
    }
    if (!errors.empty()) return errors;
    Posed posed;
    posed.poses = core::clearance::poses_at(*model_, ranges_, at);
    core::stepper::Trajectory there = core::clearance::as_assembled(*model_);
    there.poses.front() = posed.poses;
    std::vector<core::clearance::PairRequest> requests;
    for (const auto& [a, b] : pairs_) requests.push_back({.a = a, .b = b});
    core::clearance::ClearanceOptions options = core::clearance::usual_options(requests);
    options.max_evaluations = most_box_pairs;
    options.sample_nodes = false;
    options.measure_overlap = depths;
    posed.pairs = core::clearance::certify(*model_, there, requests, options);
    std::stable_sort(posed.pairs.begin(), posed.pairs.end(), [](const PairClearance& x, const PairClearance& y) {
        const auto depth = [](const PairClearance& pair) { return pair.overlap ? pair.overlap->depth_upper : 0; };
        return x.upper != y.upper ? x.upper < y.upper : depth(x) > depth(y);
    });
    return posed;
}

}  // namespace fettle::design::session
