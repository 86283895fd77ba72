// SPDX-License-Identifier: MIT
#include "core/model/limits.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"

namespace fettle::core::model {
namespace {

std::string value_text(const Model& model, int measure, double value) {
    const measure::MeasureKind kind = model.mechanism.set.measures[measure].kind;
    if (kind == measure::MeasureKind::product) return base::format_quantity(std::acos(std::clamp(value, -1.0, 1.0)), "deg");
    const bool turns = kind == measure::MeasureKind::angle;
    return turns ? base::format_quantity(value, "deg") : base::length_text(value, model.length_unit, 6);
}

}  // namespace

bool is_swing(const Mechanism& mechanism, const MeasureTerm& stop) {
    return mechanism.set.measures[stop.measure].kind == measure::MeasureKind::product;
}

double room_within(const MeasureTerm& stop, double value) { return stop.sign * stop.length * (value - stop.reference); }

std::optional<std::array<double, 2>> limits_of(const Mechanism& mechanism, int measure) {
    std::array<double, 2> out{-base::infinity, base::infinity};
    bool is_limited = false;
    for (const MeasureTerm& term : mechanism.terms) {
        if (term.kind != LawKind::stop || term.measure != measure) continue;
        is_limited = true;
        if (term.sign > 0)
            out[0] = std::max(out[0], term.reference);
        else
            out[1] = std::min(out[1], term.reference);
    }
    return is_limited ? std::optional(out) : std::nullopt;
}

std::vector<std::string> beyond_limits(const Model& model, const std::vector<kinematics::Pose>& poses, const std::vector<double>& angles) {
    const Mechanism& mechanism = model.mechanism;
    std::vector<std::string> out;
    std::vector<measure::PlacedFrame> frames;
    for (const MeasureTerm& term : mechanism.terms) {
        if (term.kind != LawKind::stop) continue;
        if (frames.empty()) frames = placed(mechanism.set.frames, poses);
        const double value = constraint::value_at(mechanism.set, term.measure, frames, angles);
        if (room_within(term, value) >= -at_limit * model.dhat) continue;
        const std::array<double, 2> limits = *limits_of(mechanism, term.measure);
        if (is_swing(mechanism, term)) {
            out.push_back("`" + term.name + "` has its axes " + value_text(model, term.measure, value) + " apart, beyond its `swing`, " +
                          value_text(model, term.measure, term.reference));
            continue;
        }
        out.push_back("`" + term.name + "` is at " + value_text(model, term.measure, value) + ", beyond its limits, " +
                      range_text(model, term.measure, limits[0], limits[1]));
    }
    return out;
}

std::string range_text(const Model& model, int measure, double low, double high) {
    const double rounding = 1e-12 * std::max(std::abs(low), std::abs(high));
    const auto shown = [&](double value) { return value_text(model, measure, std::abs(value) <= rounding ? 0 : value); };
    const std::string first = shown(low), last = shown(high);
    return first.substr(0, first.rfind(' ')) + " to " + last;
}

}  // namespace fettle::core::model
