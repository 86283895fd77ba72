// SPDX-License-Identifier: MIT
#include "core/model/ignored_pairs.hpp"

#include "core/setup/build_model.hpp"
#include "tests/core/model/box_scenes.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::model::ignored_pairs_test {

using tests::box_body;
using tests::support::contains;

namespace {

using Pairs = std::vector<std::pair<int, int>>;

scene::Scene four(const std::vector<std::string>& ignore) {
    scene::Scene scene = tests::scene_of({box_body("arm", {0, 0, 0}, {1, 1, 1}), box_body("finger_1", {0.5, 0, 0}, {2, 1, 1}),
                                          box_body("finger_2", {5, 0, 0}, {6, 1, 1}), box_body("ns:palm", {7, 0, 0}, {8, 1, 1})});
    scene.ignore = ignore;
    return scene;
}

}  // namespace

TEST_CASE("A scene ignores pairs by name or pattern, in any order, names with colons too", "[model]") {
    CHECK(*ignored_pairs(four({})) == Pairs{});
    CHECK(*ignored_pairs(four({"finger_1:arm"})) == Pairs{{0, 1}});
    CHECK(*ignored_pairs(four({"finger_*:arm", "arm:finger_2"})) == Pairs{{0, 1}, {0, 2}});
    CHECK(*ignored_pairs(four({"ns:palm:arm"})) == Pairs{{0, 3}});
    CHECK(ignored_pairs(four({"*:*"}))->size() == 6);
}

TEST_CASE("What a scene cannot ignore is refused with its place and the nearest name", "[model]") {
    const auto misspelt = tests::only_error(ignored_pairs(four({"arm:finger_1", "arm:fingr_2"})));
    CHECK(misspelt.where == "a.scene.json#/ignore/1");
    CHECK(contains(misspelt.message, "there is no body \"fingr_2\"; did you mean \"finger_2\"?"));
    CHECK(contains(tests::only_error(ignored_pairs(four({"arm"}))).message, "write \"A:B\""));
    CHECK(contains(tests::only_error(ignored_pairs(four({"arm:arm"}))).message, "not a pair of bodies"));
    CHECK(contains(tests::only_error(ignored_pairs(four({"thumb*:arm"}))).message, "no body's name matches \"thumb*\""));
    CHECK(tests::only_error(setup::build_model(four({"arm:thumb"}))).where == "a.scene.json#/ignore/0");
}

TEST_CASE("Ignored bodies may overlap at the start, and contact does not act between them", "[model]") {
    const auto refused = tests::only_error(setup::build_model(four({})));
    CHECK(refused.code == base::ErrorCode::bodies_intersect);
    CHECK(contains(refused.message, "list \"arm:finger_1\" in the scene's `ignore`"));
    const auto model = setup::build_model(four({"arm:finger_1"}));
    REQUIRE(model);
    CHECK(why_no_contact(*model, 1, 0) == NoContact::ignored);
    CHECK(!may_collide(*model, 0, 1));
    CHECK(may_collide(*model, 0, 2));
    CHECK(model->warnings.empty());
}

}  // namespace fettle::core::model::ignored_pairs_test
