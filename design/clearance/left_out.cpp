// SPDX-License-Identifier: MIT
#include "design/clearance/left_out.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "core/base/text.hpp"
#include "core/model/joint_fit.hpp"

namespace fettle::design::clearance {

namespace {

constexpr std::size_t most_told = 8;  // names of one kind, on a terminal

std::string first_of(const std::vector<std::string>& names) {
    return core::base::joined(std::span(names).first(std::min(names.size(), most_told))) + (names.size() > most_told ? ", ..." : "");
}

}  // namespace

LeftOut left_out_of_contact(const core::model::Model& model) {
    LeftOut out;
    const auto name = [&](int a, int b) { return model.bodies[a].name + ":" + model.bodies[b].name; };
    for (const auto& [a, b] : model.ignored) out.ignored.push_back(name(a, b));
    for (const auto& [a, b] : model.mechanism.not_colliding)
        if (why_no_contact(model, a, b) == core::model::NoContact::joined)
            out.joined.emplace_back(name(a, b), core::model::joints_between(model, a, b));
    std::map<int, std::vector<std::string>> groups;
    for (const core::model::Body& body : model.bodies) {
        if (body.group >= 0) groups[body.group].push_back(body.name);
        if (body.type != core::scene::BodyType::dynamic_body) out.not_dynamic.push_back(body.name);
    }
    for (auto& [number, names] : groups)
        if (names.size() > 1) out.groups.push_back(std::move(names));
    if (out.not_dynamic.size() < 2) out.not_dynamic.clear();
    return out;
}

std::string left_out_text(const LeftOut& left_out) {
    std::vector<std::string> parts, joined;
    for (const auto& [pair, joints] : left_out.joined) joined.push_back(pair + " (" + core::base::joined(joints) + ")");
    if (!joined.empty()) parts.push_back("joined by joints: " + first_of(joined));
    if (!left_out.ignored.empty()) parts.push_back("ignored by the scene: " + first_of(left_out.ignored));
    for (const std::vector<std::string>& group : left_out.groups) parts.push_back("one group: " + first_of(group));
    if (!left_out.not_dynamic.empty()) parts.push_back("among bodies that are not dynamic: " + first_of(left_out.not_dynamic));
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "left out: " : "; ") + part;
    return text.empty() ? text : text + "\n";
}

nlohmann::ordered_json left_out_json(const LeftOut& left_out) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const auto& [pair, joints] : left_out.joined) json["joined"].push_back({{"pair", pair}, {"joints", joints}});
    if (!left_out.ignored.empty()) json["ignored"] = left_out.ignored;
    if (!left_out.groups.empty()) json["groups"] = left_out.groups;
    if (!left_out.not_dynamic.empty()) json["not_dynamic"] = left_out.not_dynamic;
    return json;
}

}  // namespace fettle::design::clearance
