// SPDX-License-Identifier: MIT
#include "core/certificate/linkage.hpp"

#include <algorithm>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;

bool is_usable_screw(const Screw& screw, int coordinates) {
    return screw.coordinate >= 0 && screw.coordinate < coordinates && screw.point.allFinite() && screw.axis.allFinite() &&
           screw.point.cwiseAbs().maxCoeff() <= base::largest_magnitude && std::abs(screw.axis.norm() - 1) < 1e-9 &&
           base::is_usable_number(screw.turn) && base::is_usable_number(screw.slide);
}

bool ends_in_the_world(const Linkage& linkage, std::size_t body) {
    int at = static_cast<int>(body);
    for (std::size_t k = 0; k <= linkage.bodies.size(); ++k) {
        if (at == -1) return true;
        if (at < 0 || at >= count_of(linkage.bodies)) return false;
        at = linkage.bodies[at].parent;
    }
    return false;
}

// From the world on.
std::vector<int> ancestry(const Linkage& linkage, int body) {
    std::vector<int> out;
    for (int at = body; at >= 0; at = linkage.bodies[at].parent) out.push_back(at);
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace

base::Errors check_linkage(const Linkage& linkage, std::size_t bodies) {
    const auto fault = [](const char* list, std::size_t k, const char* message) {
        return base::Errors{{ErrorCode::inconsistent, std::string("/") + list + "/" + std::to_string(k), message}};
    };
    if (linkage.bodies.size() != bodies) return {{ErrorCode::inconsistent, "/links", "one entry per body of the model is expected"}};
    for (std::size_t k = 0; k < linkage.coordinates.size(); ++k) {
        const LinkageCoordinate& c = linkage.coordinates[k];
        const bool usable = base::is_usable_number(c.low) && base::is_usable_number(c.high);
        if (!usable || !(c.low <= c.start && c.start <= c.high)) return fault("coordinates", k, "low <= start <= high is expected");
    }
    const auto count = count_of(linkage.coordinates);
    for (std::size_t k = 0; k < bodies; ++k) {
        for (const Screw& screw : linkage.bodies[k].screws)
            if (!is_usable_screw(screw, count)) return fault("links", k, "a screw of it is wrong");
        if (!ends_in_the_world(linkage, k)) return fault("links", k, "its parents do not lead to the world");
    }
    return {};
}

void write_coordinate(files::JsonWriter& out, const LinkageCoordinate& coordinate) {
    const auto number = [&](std::string_view name, double value) {
        out.key(name);
        out.number(value);
    };
    const auto flag = [&](std::string_view name, bool value) {
        out.key(name);
        out.text += value ? "true" : "false";
    };
    out.text += '{';
    number("start", coordinate.start);
    number("low", coordinate.low);
    number("high", coordinate.high);
    flag("is_whole_turn", coordinate.is_whole_turn);
    out.key("joints");
    out.list(coordinate.joints.size(), ", ", [&](std::size_t i) {
        const JointCoordinate& joint = coordinate.joints[i];
        out.text += '{';
        out.key("joint");
        out.string(joint.joint);
        flag("is_angle", joint.is_angle);
        number("scale", joint.scale);
        number("offset", joint.offset);
        out.text += '}';
    });
    out.text += '}';
}

LinkageCoordinate read_coordinate(const files::JsonNode& node) {
    const auto number = [](const files::JsonNode& from) { return from.number().value_or(0); };
    LinkageCoordinate out;
    out.start = number(node.require("start"));
    out.low = number(node.require("low"));
    out.high = number(node.require("high"));
    out.is_whole_turn = node.require("is_whole_turn").boolean().value_or(false);
    for (const files::JsonNode& joint : node.require("joints").elements())
        out.joints.push_back({joint.require("joint").string().value_or(""), joint.require("is_angle").boolean().value_or(false),
                              number(joint.require("scale")), number(joint.require("offset"))});
    return out;
}

std::optional<Revolution> revolution_of(const LinkedPair& pair) {
    std::vector<Screw> screws = pair.a;
    screws.insert(screws.end(), pair.b.begin(), pair.b.end());
    if (screws.empty()) return std::nullopt;
    const auto turns = [](const Screw& screw) { return screw.turn != 0; };
    const auto first = std::find_if(screws.begin(), screws.end(), turns);
    if (first == screws.end()) return std::nullopt;
    const Vector3 point = first->point, axis = first->axis;
    const auto all = [&](const auto& holds) { return std::all_of(screws.begin(), screws.end(), holds); };
    if (all([&](const Screw& s) { return s.axis == axis && (s.point == point || s.turn == 0); })) return Revolution{point, axis};
    if (all([&](const Screw& s) { return s.point == point && s.slide == 0; })) return Revolution{point, Vector3::Zero()};
    return std::nullopt;
}

LinkedPair linked_pair(const Linkage& linkage, int a, int b) {
    const std::vector<int> from_a = ancestry(linkage, a), from_b = ancestry(linkage, b);
    std::size_t common = 0;
    while (common < from_a.size() && common < from_b.size() && from_a[common] == from_b[common]) ++common;
    LinkedPair pair;
    const auto collect = [&](const std::vector<int>& line, std::vector<Screw>& out) {
        for (std::size_t i = common; i < line.size(); ++i) {
            const auto& screws = linkage.bodies[line[i]].screws;
            out.insert(out.end(), screws.begin(), screws.end());
        }
        for (const Screw& screw : out) pair.coordinates.push_back(screw.coordinate);
    };
    collect(from_a, pair.a);
    collect(from_b, pair.b);
    std::sort(pair.coordinates.begin(), pair.coordinates.end());
    pair.coordinates.erase(std::unique(pair.coordinates.begin(), pair.coordinates.end()), pair.coordinates.end());
    for (std::vector<Screw>* side : {&pair.a, &pair.b})
        for (Screw& screw : *side)
            screw.coordinate = static_cast<int>(std::lower_bound(pair.coordinates.begin(), pair.coordinates.end(), screw.coordinate) -
                                                pair.coordinates.begin());
    return pair;
}

}  // namespace fettle::core::certificate
