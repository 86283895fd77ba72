// SPDX-License-Identifier: MIT
#include "core/setup/round_contact.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/setup/build_model.hpp"
#include "tests/core/model/box_scenes.hpp"
#include "tests/support/prisms.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::setup::round_contact_test {

using namespace fettle::tests::support;
using model::Model;

namespace {

constexpr int corners = 32;
const double cover = std::tan(std::numbers::pi / corners) * std::tan(std::numbers::pi / corners / 2);  // of a circle of radius 1

scene::Body body(const char* name, geometry::Mesh mesh, const Vector3& at = Vector3::Zero()) {
    scene::Body out;
    out.name = name;
    out.where = name;
    out.mesh = std::move(mesh);
    out.pose.position = at;
    return out;
}

Model model_of(std::vector<scene::Body> bodies, const BuildOptions& options = {}) {
    scene::Scene scene = tests::scene_of(std::move(bodies));
    scene.dhat = 1e-3;
    auto model = build_model(scene, options);
    REQUIRE(model);
    return std::move(model).value();
}

// A pin of circumscribed facets, so that the round surfaces have these radii.
scene::Body pin(double radius, const Vector3& at = Vector3::Zero()) {
    return body("pin", prism(circle_outline(corners, radius / std::cos(std::numbers::pi / corners)), -1, 1), at);
}
scene::Body bore(double radius) {
    return body("plate", plate_with_hole(circle_outline(corners, radius / std::cos(std::numbers::pi / corners)), 1, -0.5, 0.5));
}
scene::Body slot(double radius) { return body("plate", plate_with_hole(slot_outline(corners / 2, radius, 1), 1, -0.5, 0.5)); }

// What is said of contact.
std::vector<std::string> warnings_of(const Model& model) {
    std::vector<std::string> out;
    for (const std::string& warning : model.warnings)
        if (contains(warning, "contact")) out.push_back(warning);
    return out;
}

}  // namespace

TEST_CASE("contact is round unless a scene says otherwise", "[round_contact]") {
    const Model model = model_of({bore(1.1), pin(1)});
    CHECK(model.round_reach > 0);
    CHECK(model.bodies[0].round);
    CHECK(model.facet_sides.empty());
    CHECK(warnings_of(model).empty());
    scene::Scene scene = tests::scene_of({bore(1.1), pin(1)});
    scene.round_contact = false;
    CHECK(build_model(scene)->round_reach == 0);
    const auto boxes =
        build_model(tests::scene_of({tests::box_body("a", {0, 0, 0}, {1, 1, 1}), tests::box_body("b", {2, 0, 0}, {3, 1, 1})}));
    CHECK(boxes->round_reach == 0);
    CHECK_FALSE(boxes->bodies[0].round);
}

TEST_CASE("contact that knows facets alone says so where round surfaces are asked for", "[round_contact]") {
    scene::Scene scene = tests::scene_of({bore(1.1), pin(1)});
    scene.contact_damping_time = 1e-3;
    CHECK(warnings_of(*build_model(scene)).empty());
    scene.round_contact = true;
    const auto model = build_model(scene);
    CHECK(model->round_reach == 0);
    REQUIRE(warnings_of(*model).size() == 1);
    CHECK(contains(warnings_of(*model)[0], "contact.round has no effect with contact.damping_time"));
}

TEST_CASE("a pin whose play is less than the covers meets its bore with facets", "[round_contact]") {
    CHECK(model_of({bore(1 + 1.2 * cover), pin(1)}).facet_sides.empty());
    const Model narrow = model_of({bore(1 + 0.8 * cover), pin(1)});
    REQUIRE(narrow.facet_sides.size() == 1);
    CHECK((narrow.facet_sides[0].a == 0 && narrow.facet_sides[0].b == 1));
    CHECK(narrow.bodies[0].round->sides[narrow.facet_sides[0].side_a].is_circle);
    REQUIRE(warnings_of(narrow).size() == 1);
    CHECK(contains(warnings_of(narrow)[0], "between `plate` and `pin` contact takes some facets as they are"));

    BuildOptions as_before;
    as_before.facet_sides = narrow.facet_sides;
    CHECK(model_of({bore(1.1), pin(1)}, as_before).facet_sides == narrow.facet_sides);
}

TEST_CASE("a pin in the round end of a slot needs a play of dhat besides", "[round_contact]") {
    CHECK(model_of({slot(1.1), pin(1)}).facet_sides.empty());
    const Model narrow = model_of({slot(1 + 2 * cover + 0.5e-3), pin(1)});
    CHECK(narrow.facet_sides.size() == 1);
    CHECK(contains(warnings_of(narrow).at(0), "a smaller contact.dhat"));
}

TEST_CASE("sides whose covers overlap at the start meet with facets", "[round_contact]") {
    const auto beside = [](double gap) {  // facet on facet
        const double turn = std::numbers::pi / corners;
        const auto roller = prism(circle_outline(corners, 1 / std::cos(turn), turn), -1, 1);
        return model_of({body("one", roller), body("other", roller, {2 + gap, 0, 0})});
    };
    CHECK(beside(2.1 * cover).facet_sides.empty());
    const Model narrow = beside(1.5 * cover);
    CHECK(narrow.facet_sides.size() == 1);
    CHECK(contains(warnings_of(narrow).at(0), "a gap of"));
}

}  // namespace fettle::core::setup::round_contact_test
