// SPDX-License-Identifier: MIT
#include "design/cli/certificate_domain.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::certificate::Certificate;
using core::certificate::Deviation;
using core::certificate::LinkageCoordinate;

struct JointSpan {
    std::string joint;
    bool is_angle = false, is_whole_turn = false;
    double low = 0, high = 0;  // [rad or m]
};

// The spans of the coordinates that have a range; one that follows from others, by loops, has none of its own.
std::vector<JointSpan> joint_spans(const Certificate& certificate) {
    std::vector<JointSpan> out;
    const auto add = [&](const LinkageCoordinate& c) {
        for (const auto& joint : c.joints) {
            const auto [low, high] = std::minmax({joint.scale * c.low + joint.offset, joint.scale * c.high + joint.offset});
            out.push_back({joint.joint, joint.is_angle, c.is_whole_turn, low, high});
        }
    };
    if (certificate.linkage) std::for_each(certificate.linkage->coordinates.begin(), certificate.linkage->coordinates.end(), add);
    if (!certificate.toleranced) return out;
    const auto& coordinates = certificate.toleranced->coordinates;
    for (int k = 0; k < count_of(coordinates); ++k) {
        const auto follows_in = [&](const auto& loop) { return std::count(loop.unknowns.begin(), loop.unknowns.end(), k) > 0; };
        const auto& loops = certificate.toleranced->loops;
        if (coordinates[k].low < coordinates[k].high && std::none_of(loops.begin(), loops.end(), follows_in)) add(coordinates[k]);
    }
    return out;
}

double length_of(const core::stepper::Trajectory& trajectory) {
    return time_at(trajectory, count_of(trajectory.steps)) - time_at(trajectory, 0);
}

std::string deviation_text(const Deviation& d) {
    const auto unit = core::base::find_unit(d.unit);
    const auto shown = [&](double si) { return formatted("%+.4g", unit ? description::from_si(si, *unit) : si); };
    return d.of + " " + shown(d.lower) + " to " + shown(d.upper) + (unit ? " " + d.unit : "");
}

std::string span_text(const JointSpan& span, const core::base::RoundedLengths& lengths) {
    if (span.is_whole_turn) return span.joint + " the whole turn";
    const double unit = span.is_angle ? M_PI / 180 : lengths.metres();
    const auto told = [&](double x) { return std::abs(x / unit) < 1e-12 ? 0 : x / unit; };  // rounding of 0
    return span.joint + formatted(" %.6g to %.6g ", told(span.low), told(span.high)) + (span.is_angle ? "deg" : lengths.unit());
}

template <class List, class Text>
std::string line_of(const char* what, const List& list, const Text& text) {
    std::vector<std::string> parts;
    for (const auto& each : list) parts.push_back(text(each));
    return parts.empty() ? "" : what + core::base::joined(parts) + "\n";
}

}  // namespace

const char* domain_name(const Certificate& certificate) {
    if (certificate.toleranced && certificate.toleranced->duration > 0) return "over the prescribed motion, within tolerances";
    if (certificate.toleranced && certificate.toleranced->deviations.empty()) return "over all positions of the joints";
    if (certificate.toleranced)
        return is_over_ranges(*certificate.toleranced) ? "over all positions of the joints, within tolerances"
                                                       : "as assembled, within tolerances";
    if (certificate.linkage) return "over all positions of the joints";
    if (!certificate.motion) return "as assembled";
    if (certificate.joints) return "over the motion, for joints met at all times";
    return certificate.is_of_path ? "over the motion, for the path as stored" : "over the motion";
}

Json domain_json(const Certificate& certificate, const core::stepper::Trajectory& trajectory) {
    Json json{{"over", domain_name(certificate)}};
    if (certificate.linkage || certificate.toleranced) json["joints"] = Json::array();
    for (const JointSpan& span : joint_spans(certificate))
        json["joints"].push_back({{"joint", span.joint},
                                  {"low", span.low},
                                  {"high", span.high},
                                  {"unit", span.is_angle ? "rad" : "m"},
                                  {"whole_turn", span.is_whole_turn}});
    if (certificate.toleranced && !certificate.toleranced->deviations.empty()) {
        json["tolerances"] = Json::array();
        for (const Deviation& d : certificate.toleranced->deviations)
            json["tolerances"].push_back({{"of", d.of}, {"lower", d.lower}, {"upper", d.upper}});
        if (certificate.toleranced->duration > 0) json["duration"] = certificate.toleranced->duration;
    }
    if (!certificate.motion) return json;
    json["duration"] = length_of(trajectory);
    json["steps"] = trajectory.steps.size();
    return json;
}

std::string domain_text(const Certificate& certificate, const core::stepper::Trajectory& trajectory,
                        const core::base::RoundedLengths& lengths) {
    std::string text;
    if (certificate.toleranced) {
        text += line_of("tolerances: ", certificate.toleranced->deviations, deviation_text);
        if (certificate.toleranced->duration > 0)
            text += formatted("prescribed motion: %.6g s from the start\n", certificate.toleranced->duration);
    }
    text += line_of("joints: ", joint_spans(certificate), [&](const JointSpan& span) { return span_text(span, lengths); });
    if (certificate.motion)
        text += "motion: " + core::base::counted(trajectory.steps.size(), "step") + formatted(", %.6g s\n", length_of(trajectory));
    return text;
}

}  // namespace fettle::design::cli
