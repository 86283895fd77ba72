// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "design/features/features_report.hpp"

namespace fettle::design::features {

namespace {

using Json = nlohmann::ordered_json;
using core::features::Feature;
using core::parts::SurfaceKind;

Json vector_json(const Vector3& x) { return {x.x(), x.y(), x.z()}; }

Json stretch_json(const core::features::Stretch& stretch) { return {stretch.from, stretch.to}; }

void add_shape(const Feature& feature, Json& out) {
    const core::features::Surface& surface = feature.surface;
    out["point"] = vector_json(surface.point);
    if (surface.kind != SurfaceKind::sphere) out["axis"] = vector_json(surface.axis);
    out["origin"] = vector_json(feature.origin);
    if (surface.kind == SurfaceKind::plane) return;
    out["radius"] = surface.radius;
    if (surface.kind == SurfaceKind::torus) out["tube_radius"] = surface.slope;
    if (surface.kind == SurfaceKind::cone) {
        out["half_angle"] = std::atan(std::abs(surface.slope));
        out["radii"] = {feature.radius_at(feature.along.from), feature.radius_at(feature.along.to)};
    }
    out["covered"] = feature.covered;
    if (surface.kind == SurfaceKind::sphere) return;
    out["along"] = stretch_json(feature.along);
    out["length"] = feature.length();
    out["pieces"] = Json::array();
    for (const core::features::Stretch& piece : feature.pieces) out["pieces"].push_back(stretch_json(piece));
    out["ends"] = {{"lower", to_string(feature.lower)}, {"upper", to_string(feature.upper)}};
    if (feature.is_hole) out["through"] = feature.is_through;
    out["coaxial"] = feature.coaxial;
}

Json feature_json(const Feature& feature, bool triangles) {
    Json out = {{"name", feature.name}, {"kind", core::parts::name_of(feature.surface.kind)}, {"role", role_of(feature)}};
    if (feature.surface.kind != SurfaceKind::plane) out["side"] = feature.is_hole ? "hole" : "boss";
    add_shape(feature, out);
    out["area"] = feature.area;
    out["centre"] = vector_json(feature.centre);
    out["source"] = feature.is_exact ? "exact" : "fitted";
    out["residual"] = feature.residual;
    if (feature.surface.kind != SurfaceKind::plane && feature.surface.kind != SurfaceKind::cone)
        out["facets"] = {{"least", feature.facets_least}, {"largest", feature.facets_largest}};
    out["triangle_count"] = feature.triangles.size();
    if (triangles) out["triangles"] = feature.triangles;
    return out;
}

Json fit_json(const FeaturesReport& report, const FoundFit& found) {
    const core::features::Fit& fit = found.fit;
    const auto end = [&](const core::features::FeatureOf& of) {
        return Json{{"body", report.model.bodies[of.body].name}, {"feature", report.parts[of.body].features[of.feature].name}};
    };
    Json processes = Json::array();
    for (const ProcessVerdict& verdict : found.processes) {
        Json each = {{"process", verdict.process}};
        each["required"] = verdict.fault.empty() ? Json(verdict.required) : Json();
        each["enough"] = verdict.fault.empty() ? Json(verdict.is_enough) : Json();
        if (!verdict.fault.empty()) each["reason"] = verdict.fault;
        processes.push_back(std::move(each));
    }
    const bool is_bounded = found.gap.is_bounded;
    return {{"pin", end(fit.pin)},
            {"hole", end(fit.hole)},
            {"play", {{"surfaces", fit.play}, {"facets", fit.facets_play}}},
            {"off_centre", fit.off_centre},
            {"lean", fit.lean},
            {"overlap", fit.overlap},
            {"centred", fit.is_centred},
            {"held", fit.is_held},
            {"gap",
             {{"lower", found.gap.lower},
              {"upper", is_bounded ? Json(found.gap.upper) : Json()},
              {"proven", found.gap.lower > 0},
              {"intersecting", found.gap.intersecting}}},
            {"processes", std::move(processes)}};
}

}  // namespace

Json features_json(const FeaturesReport& report, bool triangles) {
    Json out = {{"status", report.interrupted ? "interrupted" : to_string(status_of(report))}, {"bodies", Json::array()}};
    for (std::size_t b = 0; b < report.parts.size(); ++b) {
        const core::features::Features& part = report.parts[b];
        Json body = {{"name", report.model.bodies[b].name},   {"triangle_count", report.model.bodies[b].mesh.triangles.size()},
                     {"tolerance", part.tolerance},           {"area", part.area},
                     {"free_form_area", part.free_form_area}, {"features", Json::array()}};
        for (const Feature& feature : part.features) body["features"].push_back(feature_json(feature, triangles));
        if (triangles) body["free_form_triangles"] = part.free_form;
        out["bodies"].push_back(std::move(body));
    }
    out["fits"] = Json::array();
    for (const FoundFit& fit : report.fits) out["fits"].push_back(fit_json(report, fit));
    return out;
}

}  // namespace fettle::design::features
