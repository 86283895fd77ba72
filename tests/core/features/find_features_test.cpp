// SPDX-License-Identifier: MIT
#include "core/features/find_features.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/core/features/known_parts.hpp"

namespace fettle::core::features::find_features_test {

using namespace known_parts;  // NOLINT(google-build-using-namespace)

namespace {

const std::vector<SurfaceKind> curved{SurfaceKind::cylinder, SurfaceKind::cone, SurfaceKind::sphere, SurfaceKind::torus};

bool is_curved(SurfaceKind kind) { return std::find(curved.begin(), curved.end(), kind) != curved.end(); }

double area_of(const geometry::Mesh& mesh, int t) {
    const auto& c = mesh.triangles[t];
    const Vector3 a = mesh.vertices.col(c[0]), b = mesh.vertices.col(c[1]), d = mesh.vertices.col(c[2]);
    return 0.5 * (b - a).cross(d - a).norm();
}

// Faults of the features found, against the surfaces that the kernel drew; empty: none.
std::string fault(const DrawnPart& part, const Features& found) {
    std::string out;
    std::vector<int> feature_of(part.mesh.triangles.size(), -1);
    for (int f = 0; f < count_of(found.features); ++f)
        for (const int t : found.features[f].triangles) feature_of[t] = f;
    // Each curved feature is of one kind, on one side, as drawn.
    for (const Feature& feature : found.features) {
        if (feature.surface.kind == SurfaceKind::plane) continue;
        double right = 0;
        for (const int t : feature.triangles) {
            const DrawnSurface& drawn = part.surfaces[part.facets[t].surface];
            if (drawn.kind == feature.surface.kind && drawn.hollow == feature.is_hole) right += area_of(part.mesh, t);
        }
        if (right < 0.98 * feature.area)
            out += feature.name + " is a wrong " + name_of(feature.surface.kind) + " (" + std::to_string(right / feature.area) +
                   " of it right), ";
    }
    // Each curved surface is found, as one feature or several.
    std::vector<double> area(part.surfaces.size(), 0), of_kind(part.surfaces.size(), 0);
    for (int t = 0; t < count_of(part.mesh.triangles); ++t) {
        const int s = part.facets[t].surface;
        area[s] += area_of(part.mesh, t);
        if (feature_of[t] >= 0 && found.features[feature_of[t]].surface.kind == part.surfaces[s].kind) of_kind[s] += area_of(part.mesh, t);
    }
    for (std::size_t s = 0; s < area.size(); ++s)
        if (is_curved(part.surfaces[s].kind) && area[s] > 0 && of_kind[s] < 0.6 * area[s])
            out += "a " + std::string(name_of(part.surfaces[s].kind)) + " of `" + part.surfaces[s].feature + "` is not found (" +
                   std::to_string(of_kind[s] / area[s]) + " of it), ";
    return out;
}

struct Campaign {
    int parts = 0, features = 0, faults = 0;
    std::map<SurfaceKind, int> kinds;
};

Campaign run(int count, unsigned first) {
    Campaign out;
    for (int k = 0; k < count; ++k) {
        Chance chance(first + static_cast<unsigned>(k));
        const Lean lean = chance.among(2) == 0 ? Lean::through : Lean::cover;
        Result<DrawnPart> part = random_part(chance, lean);
        if (!part) continue;  // dimensions that do not go together
        const Roughness rough{chance.among(2) == 0, chance.among(2) == 0, chance.among(2) == 0, chance.among(4) == 0 ? 1e-5 : 0};
        roughen(*part, rough, chance);
        const Features found = find_features(part->mesh);
        const std::string wrong = fault(*part, found);
        ++out.parts;
        out.faults += wrong.empty() ? 0 : 1;
        for (const Feature& feature : found.features) ++out.kinds[feature.surface.kind];
        out.features += count_of(found.features);
        INFO("seed " << first + static_cast<unsigned>(k) << (lean == Lean::through ? " through" : " cover") << " turned " << rough.turned
                     << " float " << rough.float32 << " shuffled " << rough.shuffled << " noise " << rough.noise << ", tolerance "
                     << found.tolerance);
        CHECK(wrong == "");
    }
    return out;
}

}  // namespace

TEST_CASE("random parts: each surface is found, and none of a wrong kind") {
    const Campaign done = run(40, 1);
    CHECK(done.parts >= 30);
    for (const SurfaceKind kind : curved) CHECK(done.kinds.at(kind) > 0);
}

TEST_CASE("the same mesh in another order has the same features, names and bits") {
    Chance chance(7);
    Result<DrawnPart> part = random_part(chance, Lean::through);
    REQUIRE(part);
    const Features before = find_features(part->mesh);
    DrawnPart other = *part;
    roughen(other, {false, false, true, 0}, chance);
    const Features after = find_features(other.mesh);
    REQUIRE(after.features.size() == before.features.size());
    for (std::size_t k = 0; k < before.features.size(); ++k) {
        const Feature &a = before.features[k], &b = after.features[k];
        CHECK(a.name == b.name);
        CHECK(a.surface.point == b.surface.point);
        CHECK(a.surface.axis == b.surface.axis);
        CHECK(a.surface.radius == b.surface.radius);
        CHECK(a.residual == b.residual);
        CHECK(a.triangles.size() == b.triangles.size());
    }
}

TEST_CASE("many random parts", "[slow]") {
    const Campaign done = run(450, 1000);
    CHECK(done.parts >= 300);
    CHECK(done.faults == 0);
}

}  // namespace fettle::core::features::find_features_test
