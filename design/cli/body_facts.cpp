// SPDX-License-Identifier: MIT
#include "fettle/design/cli/body_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "fettle/core/base/units.hpp"
#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::model::Body;
using core::scene::BodyType;

const char* type_name(BodyType type) {
    return type == BodyType::dynamic_body ? "dynamic" : type == BodyType::static_body ? "static" : "kinematic";
}

Vector3 size_of(const Body& body) { return body.mesh.vertices.rowwise().maxCoeff() - body.mesh.vertices.rowwise().minCoeff(); }

std::optional<double> volume_of(const core::geometry::Mesh& mesh) {
    const auto openings = core::geometry::openings(mesh.vertices, mesh.triangles);
    if (!core::geometry::is_nearly_closed(mesh.vertices, mesh.triangles, openings)) return std::nullopt;
    return core::geometry::capped_solid_moments(mesh.vertices, mesh.triangles, openings)(3, 3);
}

/// Bodies that share a hierarchy have one mesh, which is measured once.
std::vector<std::optional<double>> volumes_of(const core::model::Model& model) {
    std::map<const core::geometry::BodyHierarchy*, std::optional<double>> known;
    std::vector<std::optional<double>> volumes;
    volumes.reserve(model.bodies.size());
    for (const Body& body : model.bodies) {
        const auto [entry, fresh] = known.try_emplace(body.hierarchy.get());
        if (fresh || body.hierarchy == nullptr) entry->second = volume_of(body.mesh);
        volumes.push_back(entry->second);
    }
    return volumes;
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
    const std::vector<std::optional<double>> volumes = volumes_of(model);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Body& body = model.bodies[i];
        const Vector3 size = size_of(body);
        list.push_back({{"name", body.name},
                        {"type", type_name(body.type)},
                        {"size", {size.x(), size.y(), size.z()}},
                        {"volume", or_null(volumes[i])},
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
    const std::vector<std::optional<double>> volumes = volumes_of(model);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Body& body = model.bodies[i];
        const Vector3 size = per_metre * size_of(body);
        const std::optional<double>& volume = volumes[i];
        const std::string shown = volume ? formatted("%.5g", *volume * per_metre * per_metre * per_metre) : std::string("open");
        text += formatted("  %-*s  %-9s  %-30s  %-14s  %s\n", static_cast<int>(widest), body.name.c_str(), type_name(body.type),
                          formatted("%.5g x %.5g x %.5g", size.x(), size.y(), size.z()).c_str(), shown.c_str(),
                          mass_text(mass_of(body)).c_str());
    }
    return text;
}

}  // namespace fettle::design::cli
