// SPDX-License-Identifier: MIT
// Round features made larger and smaller: radii, the rest bit for bit, walls, refusals.
#include "core/features/resize.hpp"
#include "core/features/wall.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "core/features/find_features.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/core/features/known_parts.hpp"

namespace fettle::core::features::resize_test {

using namespace known_parts;  // NOLINT(google-build-using-namespace)

namespace {

struct Part {
    geometry::Mesh mesh;
    Features features;
    explicit Part(const std::function<Result<Solid>(Drawing&)>& part) : mesh(drawn_mesh(part)), features(find_features(mesh)) {}
    int named(const std::string& name) const {
        const int found = features.find(name);
        REQUIRE(found >= 0);
        return found;
    }
    const Feature& feature(const std::string& name) const { return features.features[named(name)]; }
};

std::string fault_of(const Part& part, const std::string& name, double by) {
    const auto made = resized(part.mesh, part.features, {{part.named(name), by}});
    if (made) return {};
    return made.errors().front().where + ": " + made.errors().front().message;
}

// A block of 40 x 20 x 6 mm with a bore of 4 mm at its middle and one of 2 mm at x = 12 mm, 3 mm from its end when it has 5.
Part block() {
    return Part([](Drawing& d) {
        const auto profile = with_holes(*filled(rectangle({-20 * mm, -10 * mm}, 40 * mm, 20 * mm, "block")),
                                        {circle({}, 4 * mm, "middle"), circle({12 * mm, 0}, 2 * mm, "side")});
        return extruded(d, *profile, 0, 6 * mm);
    });
}

}  // namespace

TEST_CASE("a bore is made wider or narrower; the rest stays bit for bit") {
    const Part part = block();
    for (const double by : {0.5 * mm, -0.5 * mm, 1e-6}) {
        const Feature& bore = part.feature("B1");
        const auto made = resized(part.mesh, part.features, {{part.named("B1"), by}});
        REQUIRE(made);
        CHECK(made->triangles == part.mesh.triangles);
        CHECK(solids::validate_mesh(*made, {}).empty());
        std::set<int> of_bore;
        for (const int t : bore.triangles)
            for (const int v : part.mesh.triangles[t]) of_bore.insert(v);
        for (int v = 0; v < made->vertices.cols(); ++v) {
            if (of_bore.count(v) == 0) CHECK(made->vertices.col(v) == part.mesh.vertices.col(v));
            if (of_bore.count(v) != 0) CHECK(made->vertices(2, v) == part.mesh.vertices(2, v));
        }
        const Features found = find_features(*made);
        const Feature& now = found.features[found.find("B1")];
        CHECK(now.facets_least == Approx(bore.facets_least + by).epsilon(1e-9));
        CHECK(now.is_through);
        CHECK(found.features.size() == part.features.features.size());
    }
    // Both at once.
    const auto both = resized(part.mesh, part.features, {{part.named("B1"), 0.2 * mm}, {part.named("B2"), -0.3 * mm}});
    REQUIRE(both);
    const Features found = find_features(*both);
    CHECK(found.features[found.find("B1")].surface.radius == Approx(4.2 * mm).epsilon(1e-3));
    CHECK(found.features[found.find("B2")].surface.radius == Approx(1.7 * mm).epsilon(1e-3));
}

TEST_CASE("what would cut through, turn over or bend is refused with its place") {
    const Part part = block();
    // The two bores are 6 mm apart: what is between them ends at 5.9 mm for one that reaches it.
    CHECK(fault_of(part, "B1", 5.5 * mm).find("B1: ") == 0);
    CHECK(fault_of(part, "B1", 7 * mm) != "");
    CHECK(fault_of(part, "B2", 5 * mm) != "");
    CHECK(fault_of(part, "B1", 1 * mm).empty());
    // A bore across another: corners of both.
    const Part crossed([](Drawing& d) {
        const auto cube = extruded(d, *filled(rectangle({-10 * mm, -10 * mm}, 20 * mm, 20 * mm, "cube")), -10 * mm, 10 * mm);
        const auto along_z = extruded(d, *filled(circle({}, 4 * mm, "z")), -12 * mm, 12 * mm);
        const auto along_x = extruded(d, *filled(circle({0.1 * mm, 0.2 * mm}, 3 * mm, "x")), -12 * mm, 12 * mm);
        return difference(d, *cube, {*along_z, turned(*along_x, {0, 1, 0}, std::numbers::pi / 2)});
    });
    std::string bore;
    for (const Feature& feature : crossed.features.features)
        if (feature.is_hole && std::abs(feature.surface.axis.z()) > 0.9) bore = feature.name;
    REQUIRE(bore != "");
    CHECK(fault_of(crossed, bore, 0.2 * mm).find(", which would bend") != std::string::npos);
}

TEST_CASE("a pin is made thinner, a step on its axis goes along") {
    const Part part([](Drawing& d) {
        const Profile shaft = *filled(circle({}, 3 * mm, "shaft")), head = *filled(circle({}, 5 * mm, "head"));
        return stacked(d, {{head, 0, 2 * mm, {}, {}, "head"}, {shaft, 2 * mm, 20 * mm, {}, {}, "shaft"}});
    });
    const auto made = resized(part.mesh, part.features, {{part.named("P2"), -0.25 * mm}});
    REQUIRE(made);
    const Features found = find_features(*made);
    CHECK(found.features[found.find("P2")].facets_largest == Approx(2.75 * mm).epsilon(1e-9));
    CHECK(found.features[found.find("P1")].facets_largest == Approx(5 * mm).epsilon(1e-9));
    CHECK(fault_of(part, "P2", 2.5 * mm) != "");  // thicker than its head: the shoulder would turn over
}

TEST_CASE("chamfers at both ends of a bore move along; a taper between two bores may not turn round") {
    const auto turned_part = [](const std::vector<std::pair<double, double>>& corners) {
        return Part([&](Drawing& d) {
            std::vector<Point2> outline;
            for (const auto& [r, z] : corners) outline.push_back({r * mm, z * mm});
            return revolved(d, *filled(polygon(outline, "outline")));
        });
    };
    const Part chamfered = turned_part({{2.1, 0.5}, {2.6, 0}, {8, 0}, {8, 6}, {2.6, 6}, {2.1, 5.5}});
    const auto made = resized(chamfered.mesh, chamfered.features, {{chamfered.named("B1"), 0.7 * mm}});
    REQUIRE(made);
    CHECK(solids::validate_mesh(*made, {}).empty());
    const Features found = find_features(*made);
    for (const char* name : {"C1", "C2"}) {
        REQUIRE(found.find(name) >= 0);
        CHECK(std::abs(found.features[found.find(name)].surface.slope) == Approx(1).epsilon(1e-3));
        CHECK(found.features[found.find(name)].length() == Approx(0.5 * mm).epsilon(1e-6));
    }
    // No corner is nearer to the axis than the bore.
    double least = 1;
    for (int v = 0; v < made->vertices.cols(); ++v) least = std::min(least, made->vertices.col(v).head<2>().norm());
    CHECK(least >= chamfered.feature("B1").facets_least + 0.7 * mm);
    const Part tapered = turned_part({{2, 0}, {8, 0}, {8, 9}, {2.5, 9}, {2.5, 6}, {2, 3}});
    const std::string narrow = tapered.feature("B1").surface.radius < 2.2 * mm ? "B1" : "B2";
    CHECK(fault_of(tapered, narrow, 0.3 * mm).empty());
    CHECK(fault_of(tapered, narrow, 0.8 * mm).find("would lean the other way") != std::string::npos);
}

TEST_CASE("the wall behind a bore is the least that is left") {
    const Part part = block();
    // From the bore of 2 mm at x = 12 mm to the end at 20 mm there are 6 mm, to the other bore 6 mm, to the sides 8 mm.
    const auto wall = wall_behind(part.mesh, part.feature("B2"));
    REQUIRE(wall);
    CHECK(wall->thickness == Approx(6 * mm).margin(0.02 * mm));
    const auto of_middle = wall_behind(part.mesh, part.feature("B1"));
    REQUIRE(of_middle);
    CHECK(of_middle->thickness == Approx(6 * mm).margin(0.05 * mm));
    const Part near([](Drawing& d) {
        return extruded(d, *with_hole(*filled(rectangle({-20 * mm, -5 * mm}, 40 * mm, 10 * mm, "bar")), circle({}, 4 * mm, "bore")), 0,
                        6 * mm);
    });
    CHECK(wall_behind(near.mesh, near.feature("B1"))->thickness == Approx(1 * mm).margin(0.01 * mm));
}

}  // namespace fettle::core::features::resize_test
