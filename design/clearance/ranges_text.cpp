// SPDX-License-Identifier: MIT
#include "design/clearance/ranges_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/bound_text.hpp"
#include "core/base/text.hpp"

namespace fettle::design::clearance {

namespace {

using Json = nlohmann::ordered_json;
using core::base::formatted;
using core::base::Towards;
using core::certificate::LinkageCoordinate;
using core::clearance::FreeRange;
using core::clearance::NotSearched;
using core::clearance::RangeEnd;
using Kind = RangeEnd::Kind;

constexpr double degree = std::numbers::pi / 180, millimetre = 1e-3;

const LinkageCoordinate& coordinate_of(const RangesReport& report, const FreeRange& range) {
    return report.ranges.linkage.coordinates[range.coordinate];
}

// Numbers of a coordinate, in degrees or millimetres, as fine as its ends were looked for.
class Numbers {
public:
    Numbers(const RangesReport& report, const FreeRange& range)
        : is_angle_(coordinate_of(report, range).joints.front().is_angle),
          decimals_(static_cast<int>(std::clamp(std::ceil(-std::log10(near(report) / unit())), 0.0, 9.0))) {}

    double unit() const { return is_angle_ ? degree : millimetre; }
    const char* name() const { return is_angle_ ? "deg" : "mm"; }
    std::string rounded(double value, Towards towards) const {
        return core::base::bound_text(value, unit(), unit(), towards, [&](double x) { return text(x); });
    }
    std::string nearest(double value) const { return text(value / unit()); }

private:
    double near(const RangesReport& report) const { return is_angle_ ? report.asked.angle : report.asked.length; }
    std::string text(double x) const {
        std::string out = formatted("%.*f", decimals_, x);
        if (out.find('.') == std::string::npos) return out;
        out.erase(out.find_last_not_of('0') + 1);
        if (out.back() == '.') out.pop_back();
        return out == "-0" ? "0" : out;
    }

    bool is_angle_;
    int decimals_;
};

// A ball joint's, which goes from 0 on, in every direction.
bool is_swing(const RangesReport& report, const FreeRange& range) { return report.ranges.direction_of[range.coordinate] >= 0; }

bool starts_in_a_clash(const FreeRange& range) { return range.clash_at_start() != nullptr; }

std::string length_text(double metres) { return formatted("%.3g mm", metres / millimetre); }

std::string names_of(const RangesReport& report, int a, int b) { return report.model.bodies[a].name + ":" + report.model.bodies[b].name; }

std::string joint_names(const LinkageCoordinate& coordinate) {
    std::string out = coordinate.joints.front().joint;
    std::vector<std::string> others;
    for (std::size_t k = 1; k < coordinate.joints.size(); ++k) others.push_back(coordinate.joints[k].joint);
    return others.empty() ? out : out + " (with " + core::base::joined(others) + ")";
}

// "lid meets frame, 0.004 mm deep"
std::string meeting_text(const RangesReport& report, const RangeEnd& end) {
    const core::clearance::PairClearance& pair = *end.pair;
    const std::string &a = report.model.bodies[pair.a].name, &b = report.model.bodies[pair.b].name;
    const double expected = 10 * report.asked.length;  // what is deeper is an upper bound of meshes that cannot be cut, and says little
    if (pair.overlap && pair.overlap->depth_upper > 0 && pair.overlap->depth_upper <= expected)
        return a + " is " + length_text(pair.overlap->depth_upper) + " in " + b;
    if (pair.is_clash() || pair.minimum < report.asked.minimum || !(report.asked.minimum > 0)) return a + " meets " + b;
    return a + " is " + length_text(pair.upper) + " from " + b + ", closer than " + length_text(report.asked.minimum);
}

std::string end_line(const RangesReport& report, const FreeRange& range, const RangeEnd& end, bool is_below) {
    const Numbers numbers(report, range);
    const std::string way = is_below ? "   below: " : "   above: ";
    if (end.kind == Kind::blocked)
        return way + "at " + numbers.nearest(end.at) + " " + numbers.name() + " " + meeting_text(report, end) + "\n";
    if (end.kind == Kind::open)
        return way + "nothing in the way up to " + numbers.nearest(end.free) + " " + numbers.name() + ", where the search ended\n";
    const std::string pair = end.pair ? names_of(report, end.pair->a, end.pair->b) : std::string("a pair");
    const std::string why = end.pair && !end.pair->reason.empty() ? ": " + end.pair->reason : std::string();
    return way + "undecided beyond " + numbers.nearest(end.free) + " " + numbers.name() + ", for " + pair + why + "\n";
}

// What could be written into the scene, where that says more than stands there.
std::string as_limits(const RangesReport& report, const FreeRange& range, const Numbers& numbers) {
    if (range.turns_freely || starts_in_a_clash(range)) return {};
    const auto quoted = [&](double value, Towards towards) { return "\"" + numbers.rounded(value, towards) + " " + numbers.name() + "\""; };
    if (is_swing(report, range)) {
        const bool is_one = range.above.free > 0 && range.above.free < std::numbers::pi;
        return is_one ? "   as limit: \"swing\": " + quoted(range.above.free, Towards::down) + "\n" : "";
    }
    const auto limits = proposed_limits(report, range);
    return "   as limits: \"limits\": [\"" + limits->first + "\", \"" + limits->second + "\"]\n";
}

std::string limits_lines(const RangesReport& report, const FreeRange& range) {
    const Numbers numbers(report, range);
    if (!report.ranges.has_limits[range.coordinate]) return as_limits(report, range, numbers);
    const LinkageCoordinate& own = coordinate_of(report, range);
    const std::string limits = numbers.nearest(own.low) + " to " + numbers.nearest(own.high) + " " + numbers.name();
    const bool inside = range.turns_freely || (range.below.free <= own.low && own.high <= range.above.free);
    return "   its limits, " + limits + (inside ? ", lie within\n" : ", go beyond\n" + as_limits(report, range, numbers));
}

std::string too_close(const RangesReport& report) {
    return report.asked.minimum > 0 ? "closer than " + length_text(report.asked.minimum) : "they meet";
}

std::string start_lines(const RangesReport& report, const FreeRange& range) {
    std::string out;
    for (const NotSearched& each : range.not_searched)
        out += "   " + names_of(report, each.a, each.b) +
               (!each.undecided.empty() ? ": not looked at; undecided as assembled: " + each.undecided + "\n"
                : each.is_joined        ? ": not looked at; a joint joins them, and they meet as assembled and beside it\n"
                                        : ": " + too_close(report) + " as assembled\n");
    for (const auto& [a, b] : range.touching) out += "   " + names_of(report, a, b) + ": they touch as assembled, and come apart\n";
    return out;
}

Json end_json(const RangesReport& report, const RangeEnd& end) {
    if (end.kind == Kind::open) return nullptr;
    Json out = {{"finding", end.kind == Kind::blocked ? "blocked" : "undecided"}};
    if (end.kind == Kind::blocked) out["at"] = end.at;
    if (!end.pair) return out;
    out["a"] = report.model.bodies[end.pair->a].name;
    out["b"] = report.model.bodies[end.pair->b].name;
    if (end.kind == Kind::undecided) {
        out["reason"] = end.pair->reason;
        return out;
    }
    out["distance"] = end.pair->upper;
    const auto place = [](const Vector3& x) { return Json{x.x(), x.y(), x.z()}; };
    out["point_a"] = place(end.pair->witness.point_a);
    out["point_b"] = place(end.pair->witness.point_b);
    if (end.pair->overlap) out["depth"] = {{"lower", end.pair->overlap->depth_lower}, {"upper", end.pair->overlap->depth_upper}};
    return out;
}

Json range_json(const RangesReport& report, const FreeRange& range) {
    const LinkageCoordinate& own = coordinate_of(report, range);
    Json joints = Json::array(), touching = Json::array(), not_searched = Json::array();
    for (const auto& joint : own.joints) joints.push_back(joint.joint);
    for (const auto& [a, b] : range.touching) touching.push_back(names_of(report, a, b));
    for (const NotSearched& each : range.not_searched)
        not_searched.push_back({{"pair", names_of(report, each.a, each.b)},
                                {"reason", !each.undecided.empty() ? each.undecided
                                           : each.is_joined        ? "joined"
                                                                   : "clash as assembled"}});
    const bool is_angle = own.joints.front().is_angle, is_limited = report.ranges.has_limits[range.coordinate];
    return {{"joint", own.joints.front().joint},
            {"joints", std::move(joints)},
            {"unit", is_angle ? "rad" : "m"},
            {"start", range.start},
            {"turns_freely", range.turns_freely},
            {"free", {{"lower", range.below.free}, {"upper", range.above.free}}},
            {"below", range.turns_freely ? Json() : end_json(report, range.below)},
            {"above", end_json(report, range.above)},
            {"limits", is_limited ? Json{own.low, own.high} : Json()},
            {"touching", std::move(touching)},
            {"not_searched", std::move(not_searched)}};
}

}  // namespace

RangesStatus status_of(const FreeRange& range) {
    if (starts_in_a_clash(range)) return RangesStatus::clash;
    return range.is_decided() ? RangesStatus::ok : RangesStatus::undecided;
}

RangesStatus status_of(const RangesReport& report) {
    const auto any = [&](RangesStatus status) {
        return std::any_of(report.found.begin(), report.found.end(), [&](const FreeRange& each) { return status_of(each) == status; });
    };
    if (any(RangesStatus::clash)) return RangesStatus::clash;
    return report.interrupted || any(RangesStatus::undecided) ? RangesStatus::undecided : RangesStatus::ok;
}

const char* to_string(RangesStatus status) {
    switch (status) {
        case RangesStatus::ok:
            return "ok";
        case RangesStatus::clash:
            return "violated";
        case RangesStatus::undecided:
            break;
    }
    return "undecided";
}

std::string range_sentence(const RangesReport& report, const FreeRange& range) {
    if (const NotSearched* clash = range.clash_at_start())
        return "free nowhere: " + names_of(report, clash->a, clash->b) + ", " + too_close(report) + " as assembled";
    std::vector<std::string> but_for;
    for (const NotSearched& each : range.not_searched) but_for.push_back(names_of(report, each.a, each.b));
    const std::string proven = but_for.empty() ? ", proven" : ", proven but for " + core::base::joined(but_for);
    if (range.turns_freely) return "free all round" + proven;
    const Numbers numbers(report, range);
    return "free from " + numbers.rounded(range.below.free, Towards::up) + " to " + numbers.rounded(range.above.free, Towards::down) + " " +
           numbers.name() + proven;
}

std::optional<std::pair<std::string, std::string>> proposed_limits(const RangesReport& report, const FreeRange& range) {
    if (range.turns_freely || starts_in_a_clash(range) || is_swing(report, range)) return std::nullopt;
    const Numbers numbers(report, range);
    const auto told = [&](double value, Towards towards) { return numbers.rounded(value, towards) + " " + numbers.name(); };
    return std::pair(told(range.below.free, Towards::up), told(range.above.free, Towards::down));
}

Json ranges_json(const RangesReport& report) {
    Json json = {{"status", report.interrupted ? "interrupted" : to_string(status_of(report))},
                 {"minimum", report.asked.minimum},
                 {"others", report.asked.others_anywhere ? "anywhere within their limits" : "where they start"},
                 {"reach", report.reach},
                 {"joints", Json::array()}};
    for (const FreeRange& range : report.found) json["joints"].push_back(range_json(report, range));
    json["held"] = report.ranges.held;
    json["not_looked_at"] = report.not_looked_at;
    return json;
}

std::string ranges_text(const RangesReport& report) {
    std::string text;
    for (const FreeRange& range : report.found) {
        const Numbers numbers(report, range);
        text += joint_names(coordinate_of(report, range)) + ": " + range_sentence(report, range) + "; starts at " +
                numbers.nearest(range.start) + " " + numbers.name() + "\n";
        if (!range.turns_freely && !starts_in_a_clash(range)) {
            if (!is_swing(report, range) || range.start > 0) text += end_line(report, range, range.below, true);
            text += end_line(report, range, range.above, false);
        }
        text += start_lines(report, range) + limits_lines(report, range);
    }
    text += report.asked.others_anywhere ? "the other joints anywhere within their limits" : "the other joints where they start";
    if (report.asked.minimum > 0) text += ", at least " + length_text(report.asked.minimum) + " between the bodies";
    text += "\n";
    for (const std::string& each : report.not_looked_at) text += "not looked at: " + each + "\n";
    return text;
}

}  // namespace fettle::design::clearance
