// SPDX-License-Identifier: MIT
#include "design/answers/ranges_answer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/bound_text.hpp"
#include "core/base/text.hpp"

namespace fettle::design::answers {

namespace {

using Json = nlohmann::ordered_json;
using core::base::formatted;
using core::base::Towards;
using core::certificate::LinkageCoordinate;
using core::clearance::FreeRange;
using core::clearance::FreeRangeEnd;
using core::clearance::NotSearched;
using Kind = FreeRangeEnd::Kind;

constexpr double degree = std::numbers::pi / 180, millimetre = 1e-3;

const LinkageCoordinate& coordinate_of(const RangesAnswer& answer, const FreeRange& range) {
    return answer.ranges.linkage.coordinates[range.coordinate];
}

// Numbers of a coordinate, in degrees or millimetres, as fine as its ends were looked for.
class Numbers {
public:
    Numbers(const RangesAnswer& answer, const FreeRange& range)
        : is_angle_(coordinate_of(answer, range).joints.front().is_angle),
          decimals_(static_cast<int>(std::clamp(std::ceil(-std::log10(near(answer) / unit())), 0.0, 9.0))) {}

    double unit() const { return is_angle_ ? degree : millimetre; }
    const char* name() const { return is_angle_ ? "deg" : "mm"; }
    std::string rounded(double value, Towards towards) const {
        return core::base::bound_text(value, unit(), unit(), towards, [&](double x) { return text(x); });
    }
    std::string nearest(double value) const { return text(value / unit()); }

private:
    double near(const RangesAnswer& answer) const { return is_angle_ ? answer.asked.angle : answer.asked.length; }
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

bool starts_in_a_clash(const FreeRange& range) { return range.clash_at_start() != nullptr; }

std::string length_text(double metres) { return formatted("%.3g mm", metres / millimetre); }

std::string names_of(const RangesAnswer& answer, int a, int b) { return answer.model.bodies[a].name + ":" + answer.model.bodies[b].name; }

std::string joint_names(const LinkageCoordinate& coordinate) {
    std::string out = coordinate.joints.front().joint;
    std::vector<std::string> others;
    for (std::size_t k = 1; k < coordinate.joints.size(); ++k) others.push_back(coordinate.joints[k].joint);
    return others.empty() ? out : out + " (with " + core::base::joined(others) + ")";
}

// "lid meets frame, 0.004 mm deep"
std::string meeting_text(const RangesAnswer& answer, const FreeRangeEnd& end) {
    const core::clearance::PairClearance& pair = *end.pair;
    const std::string &a = answer.model.bodies[pair.a].name, &b = answer.model.bodies[pair.b].name;
    const double expected = 10 * answer.asked.length;  // what is deeper is an upper bound of meshes that cannot be cut, and says little
    if (pair.overlap && pair.overlap->depth_upper > 0 && pair.overlap->depth_upper <= expected)
        return a + " is " + length_text(pair.overlap->depth_upper) + " in " + b;
    if (pair.is_clash() || !(answer.asked.minimum > 0)) return a + " meets " + b;
    return a + " is " + length_text(pair.upper) + " from " + b + ", closer than " + length_text(answer.asked.minimum);
}

std::string end_line(const RangesAnswer& answer, const FreeRange& range, const FreeRangeEnd& end, bool is_below) {
    const Numbers numbers(answer, range);
    const std::string way = is_below ? "   below: " : "   above: ";
    if (end.kind == Kind::blocked)
        return way + "at " + numbers.nearest(end.at) + " " + numbers.name() + " " + meeting_text(answer, end) + "\n";
    if (end.kind == Kind::open)
        return way + "nothing in the way up to " + numbers.nearest(end.free) + " " + numbers.name() + ", where the search ended\n";
    const std::string pair = end.pair ? names_of(answer, end.pair->a, end.pair->b) : std::string("a pair");
    const std::string why = end.pair && !end.pair->reason.empty() ? ": " + end.pair->reason : std::string();
    return way + "undecided beyond " + numbers.nearest(end.free) + " " + numbers.name() + ", for " + pair + why + "\n";
}

// What could be written into the scene, where that says more than stands there.
std::string as_limits(const FreeRange& range, const Numbers& numbers) {
    if (range.turns_freely || starts_in_a_clash(range)) return {};
    const auto quoted = [&](double value, Towards towards) { return "\"" + numbers.rounded(value, towards) + " " + numbers.name() + "\""; };
    return "   as limits: \"limits\": [" + quoted(range.below.free, Towards::up) + ", " + quoted(range.above.free, Towards::down) + "]\n";
}

std::string limits_lines(const RangesAnswer& answer, const FreeRange& range) {
    const Numbers numbers(answer, range);
    if (!answer.ranges.has_limits[range.coordinate]) return as_limits(range, numbers);
    const LinkageCoordinate& own = coordinate_of(answer, range);
    const std::string limits = numbers.nearest(own.low) + " to " + numbers.nearest(own.high) + " " + numbers.name();
    const bool inside = range.turns_freely || (range.below.free <= own.low && own.high <= range.above.free);
    return "   its limits, " + limits + (inside ? ", lie within\n" : ", go beyond\n" + as_limits(range, numbers));
}

std::string start_lines(const RangesAnswer& answer, const FreeRange& range) {
    std::string out;
    for (const NotSearched& each : range.not_searched)
        out += "   " + names_of(answer, each.a, each.b) +
               (!each.undecided.empty() ? ": not looked at; undecided as assembled: " + each.undecided + "\n"
                : each.is_joined        ? ": not looked at; a joint joins them, and they are closer than that as assembled and beside it\n"
                                        : ": closer than that as assembled: free nowhere\n");
    for (const auto& [a, b] : range.touching) out += "   " + names_of(answer, a, b) + ": they touch as assembled, and come apart\n";
    return out;
}

Json end_json(const RangesAnswer& answer, const FreeRangeEnd& end) {
    if (end.kind == Kind::open) return nullptr;
    Json out = {{"finding", end.kind == Kind::blocked ? "blocked" : "undecided"}};
    if (end.kind == Kind::blocked) out["at"] = end.at;
    if (!end.pair) return out;
    out["a"] = answer.model.bodies[end.pair->a].name;
    out["b"] = answer.model.bodies[end.pair->b].name;
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

Json range_json(const RangesAnswer& answer, const FreeRange& range) {
    const LinkageCoordinate& own = coordinate_of(answer, range);
    Json joints = Json::array(), touching = Json::array(), not_searched = Json::array();
    for (const auto& joint : own.joints) joints.push_back(joint.joint);
    for (const auto& [a, b] : range.touching) touching.push_back(names_of(answer, a, b));
    for (const NotSearched& each : range.not_searched)
        not_searched.push_back({{"pair", names_of(answer, each.a, each.b)},
                                {"reason", !each.undecided.empty() ? each.undecided
                                           : each.is_joined        ? "joined"
                                                                   : "clash as assembled"}});
    const bool is_angle = own.joints.front().is_angle, is_limited = answer.ranges.has_limits[range.coordinate];
    return {{"joint", own.joints.front().joint},
            {"joints", std::move(joints)},
            {"unit", is_angle ? "rad" : "m"},
            {"start", range.start},
            {"turns_freely", range.turns_freely},
            {"free", {{"lower", range.below.free}, {"upper", range.above.free}}},
            {"below", range.turns_freely ? Json() : end_json(answer, range.below)},
            {"above", end_json(answer, range.above)},
            {"limits", is_limited ? Json{own.low, own.high} : Json()},
            {"touching", std::move(touching)},
            {"not_searched", std::move(not_searched)}};
}

}  // namespace

RangesStatus status_of(const RangesAnswer& answer) {
    if (std::any_of(answer.found.begin(), answer.found.end(), starts_in_a_clash)) return RangesStatus::clash;
    const bool is_decided = std::all_of(answer.found.begin(), answer.found.end(), [](const FreeRange& each) { return each.is_decided(); });
    return is_decided && !answer.interrupted ? RangesStatus::ok : RangesStatus::undecided;
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

std::string range_sentence(const RangesAnswer& answer, const FreeRange& range) {
    if (starts_in_a_clash(range)) return "free nowhere: bodies meet as assembled";
    if (range.turns_freely) return "free all round, proven";
    const Numbers numbers(answer, range);
    return "free from " + numbers.rounded(range.below.free, Towards::up) + " to " + numbers.rounded(range.above.free, Towards::down) + " " +
           numbers.name() + ", proven";
}

Json ranges_json(const RangesAnswer& answer) {
    Json json = {{"status", answer.interrupted ? "interrupted" : to_string(status_of(answer))},
                 {"minimum", answer.asked.minimum},
                 {"others", answer.asked.others_anywhere ? "anywhere within their limits" : "where they start"},
                 {"reach", answer.reach},
                 {"joints", Json::array()}};
    for (const FreeRange& range : answer.found) json["joints"].push_back(range_json(answer, range));
    json["held"] = answer.ranges.held;
    json["not_looked_at"] = answer.not_looked_at;
    return json;
}

std::string ranges_text(const RangesAnswer& answer) {
    std::string text;
    for (const FreeRange& range : answer.found) {
        const Numbers numbers(answer, range);
        text += joint_names(coordinate_of(answer, range)) + ": " + range_sentence(answer, range) + "; starts at " +
                numbers.nearest(range.start) + " " + numbers.name() + "\n";
        if (!range.turns_freely && !starts_in_a_clash(range)) {
            text += end_line(answer, range, range.below, true);
            text += end_line(answer, range, range.above, false);
        }
        text += start_lines(answer, range) + limits_lines(answer, range);
    }
    text += answer.asked.others_anywhere ? "the other joints anywhere within their limits" : "the other joints where they start";
    if (answer.asked.minimum > 0) text += ", at least " + length_text(answer.asked.minimum) + " between the bodies";
    text += "\n";
    for (const std::string& each : answer.not_looked_at) text += "not looked at: " + each + "\n";
    return text;
}

}  // namespace fettle::design::answers
