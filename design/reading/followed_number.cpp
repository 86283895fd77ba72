// SPDX-License-Identifier: MIT
#include "design/reading/followed_number.hpp"

#include <string_view>
#include <vector>

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using core::scene::PlaceKind;

std::vector<JsonNode> rows(const JsonNode& list) { return list.is_array() ? list.elements() : std::vector<JsonNode>(); }

// Is a part of this pair (`point`, `axis`) computed from something else in the file?
bool is_derived(const JsonNode& joint, const std::string& pair) {
    const bool own_a = joint[pair + "_a"].exists(), own_b = joint[pair + "_b"].exists();
    return joint[pair].exists() || own_a != own_b;
}

bool is_at(const JsonNode& joint, const std::string& body) {
    const auto is_end = [&](const char* end) { return joint[end].is_string() && *joint[end].string() == body; };
    return is_end("a") || is_end("b");
}

std::string told(const std::string& what, const std::string& name) {
    return what + " `" + name +
           "` is given in the world, or at one of its ends alone, and follows from this number as the file is read: a deviation of the "
           "number by itself would leave it behind. Make the number a variable of the scene, \"= v\", and give the tolerance to `v`; or "
           "give `point_a` and `point_b` (and `axis_a` and `axis_b`), in the bodies' frames";
}

std::string of_body(const JsonNode& file, const std::string& body, bool turns) {
    for (const char* kind : {"joints", "springs", "dampers"}) {
        for (const JsonNode& each : rows(file[kind])) {
            if (!each.is_object() || !is_at(each, body)) continue;
            if (is_derived(each, "point") || (turns && is_derived(each, "axis")))
                return told(std::string(kind, std::string_view(kind).size() - 1), each["name"].string().value_or(""));
        }
    }
    return {};
}

// Tells of the one end that is given, which the other is computed from.
std::string of_end(const JsonNode& each, const std::string& pair, const std::string& pointer, const char* what) {
    const auto is_given_alone = [&](const std::string& end, const std::string& other) {
        return pointer.find("/" + pair + end + "/") != std::string::npos && !each[pair + other].exists() && !each[pair].exists();
    };
    if (!each.is_object() || (!is_given_alone("_a", "_b") && !is_given_alone("_b", "_a"))) return {};
    return told(what, each["name"].string().value_or(""));
}

}  // namespace

std::string what_follows(const JsonNode& file, const core::scene::Scene& scene, const core::scene::Place& place) {
    const PlaceKind kind = core::scene::kind_of(place);
    const std::string pointer = core::scene::pointer_to(scene, place);
    const auto item = static_cast<std::size_t>(place.item);
    if (kind == PlaceKind::position || kind == PlaceKind::rotation)
        return of_body(file, scene.bodies[item].name, kind == PlaceKind::rotation);
    if (kind == PlaceKind::joint_point || kind == PlaceKind::joint_axis) {
        const std::vector<JsonNode> joints = rows(file["joints"]);
        const bool is_point = kind == PlaceKind::joint_point;
        return item < joints.size() ? of_end(joints[item], is_point ? "point" : "axis", pointer, "joint") : std::string();
    }
    if (kind != PlaceKind::spring_point) return {};
    std::vector<JsonNode> springs = rows(file["springs"]);
    const std::vector<JsonNode> dampers = rows(file["dampers"]);
    springs.insert(springs.end(), dampers.begin(), dampers.end());
    return item < springs.size() ? of_end(springs[item], "point", pointer, "spring or damper") : std::string();
}

}  // namespace fettle::design::reading
