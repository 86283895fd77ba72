// SPDX-License-Identifier: MIT
#include "design/quantities/free_range_end.hpp"

#include <algorithm>
#include <cmath>

#include "adjoint/clearance/range_adjoint.hpp"
#include "core/base/limits.hpp"

namespace fettle::design::quantities {

namespace {

using core::clearance::FreeRange;
using core::clearance::FreeRangeOptions;
using core::clearance::JointRanges;
using core::clearance::NotSearched;
using core::clearance::PairClearance;
using core::model::Model;
using description::Measurement;
using description::Simulated;
using End = core::clearance::RangeEnd;

// Bodies that a joint joins keep no more than this [m]: they are always near each other.
constexpr double joined_clearance = 1e-6;

// Ends that are so near to the first place that is too close are still apart there.
FreeRangeOptions options_of(const FreeRangeEnd::Of& of, const Model& model) {
    FreeRangeOptions options;
    options.minimum = of.clearance;
    options.joined_minimum = joined_clearance;
    options.length = std::min(options.length, 0.25 * std::min(of.clearance, joined_clearance));
    options.angle = std::min(options.angle, options.length / model.diagonal);
    options.above = of.is_above;
    options.below = !of.is_above;
    options.others_anywhere = of.others_anywhere;
    return options;
}

// Moves the pair's coordinate to where its witness has the distance. @return its value there, between the two
double settle(const Model& model, const JointRanges& ranges, int coordinate, double distance, double low, double high,
              PairClearance& pair) {
    constexpr int steps = 4;
    const auto place = std::find(pair.coordinates.begin(), pair.coordinates.end(), coordinate) - pair.coordinates.begin();
    double& at = pair.at[static_cast<std::size_t>(place)];
    for (int k = 0; k < steps; ++k) {
        const auto here = adjoint::clearance::witness_slope(model, ranges, pair, coordinate);
        if (!(here.distance > 0) || here.slope == 0) break;
        at = std::clamp(at + (distance - here.distance) / here.slope, low, high);
    }
    return at;
}

std::string names_of(const Model& model, int a, int b) { return "`" + model.bodies[a].name + "` and `" + model.bodies[b].name + "`"; }

}  // namespace

Result<JointRanges> FreeRangeEnd::ranges_of(const Model& model) const {
    return core::clearance::joint_ranges(model, of_.others_anywhere ? std::nullopt : std::optional(of_.reach));
}

Result<int> FreeRangeEnd::coordinate_in(const Result<JointRanges>& ranges) const {
    if (ranges) return core::clearance::coordinate_of(*ranges, of_.joint);
    Errors errors = ranges.errors();
    for (Error& error : errors) error = {error.code, "", error.where + ": " + error.message};
    return errors;
}

Measurement FreeRangeEnd::value(const Simulated& s) const {
    const Result<JointRanges> ranges = ranges_of(s.model);
    const Result<int> coordinate = coordinate_in(ranges);
    if (!coordinate) {  // the scene as written has it: check()
        Measurement none = description::computed(0);
        none.fault = coordinate.errors().front().message;
        return none;
    }
    const FreeRange found = core::clearance::free_ranges(s.model, *ranges, {*coordinate}, core::clearance::searched_pairs(s.model),
                                                         of_.reach, options_of(of_, s.model))
                                .front();
    const End& end = of_.is_above ? found.above : found.below;
    Measurement out{end.free, end.free, end.free, true, std::nullopt, {}, {}};
    for (const NotSearched& each : found.not_searched) {
        if (each.is_joined) continue;
        out.fault = names_of(s.model, each.a, each.b) + (each.undecided.empty() ? " are closer as assembled" : ": " + each.undecided);
        return out;
    }
    if (end.kind == End::Kind::undecided)
        (of_.is_above ? out.upper : out.lower) = of_.is_above ? core::base::infinity : -core::base::infinity;
    if (end.kind != End::Kind::blocked) return out;
    (of_.is_above ? out.upper : out.lower) = end.at;
    const JointRanges moved = of_.others_anywhere ? *ranges : core::clearance::alone(*ranges, *coordinate);
    PairClearance pair = *end.pair;
    out.value = settle(s.model, moved, *coordinate, pair.minimum, out.lower, out.upper, pair);
    out.parts.push_back({out.value, out.lower, out.upper, true, std::move(pair), {}, {}});  // for add_seeds
    return out;
}

void FreeRangeEnd::add_seeds(const Simulated& s, const Measurement& measured, double scale, description::Seeds& seeds) const {
    if (measured.parts.empty()) return;
    const Result<JointRanges> ranges = ranges_of(s.model);
    const Result<int> coordinate = coordinate_in(ranges);
    if (!coordinate) return;
    const JointRanges moved = of_.others_anywhere ? *ranges : core::clearance::alone(*ranges, *coordinate);
    const std::string refusal =
        adjoint::clearance::range_end_adjoint(s.model, moved, *measured.parts.front().clearance, *coordinate, scale, seeds.model_bar);
    if (seeds.refusal.empty()) seeds.refusal = refusal;
}

Errors FreeRangeEnd::check(const Model& model, int) const { return coordinate_in(ranges_of(model)).errors(); }

}  // namespace fettle::design::quantities
