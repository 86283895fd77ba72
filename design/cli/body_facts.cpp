// SPDX-License-Identifier: MIT
#include "design/cli/body_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/base/units.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/solids/shells.hpp"
#include "design/answers/answer_json.hpp"
#include "design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::model::Body;
using core::scene::BodyType;

const char* type_name(BodyType type) {
    return type == BodyType::dynamic_body ? "dynamic" : type == BodyType::static_body ? "static" : "kinematic";
}

Vector3 size_of(const Body& body) { return core::geometry::box_sides(body.mesh.vertices); }

struct MeshFacts {
    std::optional<double> volume;
    int solids = 0;
};

MeshFacts facts_of(const core::geometry::Mesh& mesh) {
    MeshFacts facts{std::nullopt, core::solids::solids_of_shells(mesh).count};
    const auto openings = core::geometry::openings(mesh.vertices, mesh.triangles);
    if (core::geometry::is_nearly_closed(mesh.vertices, mesh.triangles, openings))
        facts.volume = core::geometry::capped_solid_moments(mesh.vertices, mesh.triangles, openings)(3, 3);
    return facts;
}

/// Bodies that share a hierarchy have one mesh, which is measured once.
std::vector<MeshFacts> facts_of(const core::model::Model& model) {
    std::map<const core::geometry::BodyHierarchy*, MeshFacts> known;
    std::vector<MeshFacts> facts;
    facts.reserve(model.bodies.size());
    for (const Body& body : model.bodies) {
        const auto [entry, fresh] = known.try_emplace(body.hierarchy.get());
        if (fresh || body.hierarchy == nullptr) entry->second = facts_of(body.mesh);
        facts.push_back(entry->second);
    }
    return facts;
}

std::optional<double> mass_of(const Body& body) {
    if (body.type != BodyType::dynamic_body) return std::nullopt;
    return body.moments(3, 3);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::string mass_text(const std::optional<double>& mass) {
    if (!mass) return "";
    return *mass < 1 ? formatted("%.4g g", 1000 * *mass) : formatted("%.4g kg", *mass);
}

}  // namespace

Json parts_json(const core::model::Model& model) {
    Json list = Json::array();
    const std::vector<MeshFacts> facts = facts_of(model);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Body& body = model.bodies[i];
        const Vector3 size = size_of(body);
        list.push_back({{"name", body.name},
                        {"type", type_name(body.type)},
                        {"size", {size.x(), size.y(), size.z()}},
                        {"solids", facts[i].solids},
                        {"volume", or_null(facts[i].volume)},
                        {"mass", or_null(mass_of(body))}});
    }
    return list;
}

std::string parts_text(const core::model::Model& model) {
    const std::string unit = answers::unit_name(model.length_unit);
    const double per_metre = 1 / core::base::metres_per_unit(unit).value();
    std::size_t widest = 4;
    for (const Body& body : model.bodies) widest = std::max(widest, std::min<std::size_t>(body.name.size(), 32));
    std::string text = formatted("  %-*s  %-9s  %-30s  %-14s  %s\n", static_cast<int>(widest), "body", "type",
                                 ("size [" + unit + "]").c_str(), ("volume [" + unit + "^3]").c_str(), "mass");
    const std::vector<MeshFacts> facts = facts_of(model);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Body& body = model.bodies[i];
        const Vector3 size = per_metre * size_of(body);
        const std::optional<double>& volume = facts[i].volume;
        const std::string shown = volume ? formatted("%.5g", *volume * per_metre * per_metre * per_metre) : std::string("open");
        const std::string several = facts[i].solids > 1 ? "  " + std::to_string(facts[i].solids) + " solids" : "";
        text += formatted("  %-*s  %-9s  %-30s  %-14s  %s%s\n", static_cast<int>(widest), body.name.c_str(), type_name(body.type),
                          formatted("%.5g x %.5g x %.5g", size.x(), size.y(), size.z()).c_str(), shown.c_str(),
                          mass_text(mass_of(body)).c_str(), several.c_str());
    }
    return text;
}

}  // namespace fettle::design::cli
