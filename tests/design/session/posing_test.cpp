// SPDX-License-Identifier: MIT
#include "design/session/posing.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/model/model.hpp"
#include "tests/core/clearance/random_trees.hpp"

namespace fettle::design::session::posing_test {

namespace {

using namespace fettle::tests::mechanisms;

const Vector3 z_axis = Vector3::UnitZ();

// Two links in a plane, 60 and 40 mm long, 12 mm wide, and a post of 20 mm whose face is 80 mm from the shoulder.
std::shared_ptr<const core::model::Model> arm_and_post() {
    core::scene::Body upper = bar("upper", 0.06, Vector3::Zero(), Vector3(0, 0, M_PI / 2), 0.006),
                      fore = bar("fore", 0.04, Vector3(0, 0.06, 0), Vector3(0, 0, M_PI / 2), 0.006),
                      post = bar("post", 0.02, Vector3(0.08, 0, 0));
    post.type = core::scene::BodyType::static_body;
    core::scene::Scene scene = scene_of({upper, fore, post}, 0.01);
    for (core::scene::Body& body : scene.bodies) body.group = -1;
    scene.mechanism.joints = {
        joint("shoulder", core::scene::JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"upper", Vector3::Zero(), z_axis}),
        joint("elbow", core::scene::JointKind::revolute, {"upper", Vector3(0.06, 0, 0), z_axis}, {"fore", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].forces.limits = {-1.8, 0.5};
    return std::make_shared<const core::model::Model>(built(scene));
}

// The pair of two bodies, by their names.
const core::clearance::PairClearance& pair_of(const Posed& posed, const core::model::Model& model, const std::string& a,
                                              const std::string& b) {
    for (const core::clearance::PairClearance& pair : posed.pairs)
        if (model.bodies[pair.a].name == a && model.bodies[pair.b].name == b) return pair;
    FAIL("no such pair");
    return posed.pairs.front();
}

}  // namespace

TEST_CASE("posing: an arm is put somewhere, its poses and distances by trigonometry") {
    const auto model = arm_and_post();
    const Result<Posing> posing = Posing::of(model);
    REQUIRE(posing);
    REQUIRE(posing->handles().size() == 2);
    CHECK(posing->handles()[0].has_limits);
    CHECK_FALSE(posing->handles()[1].has_limits);
    CHECK(posing->handles()[0].moves == std::vector<std::string>{"upper", "fore"});
    CHECK(posing->handles()[1].moves == std::vector<std::string>{"fore"});

    // From straight up: the shoulder turned by s, the elbow by e.
    for (const auto& [s, e] : {std::pair{0.0, 0.0}, {-0.7, 0.0}, {-0.4, -0.9}, {0.3, 0.5}}) {
        const Result<Posed> posed = posing->at({{"shoulder", s}, {"elbow", e}});
        REQUIRE(posed);
        const double up = M_PI / 2 + s, out = up + e;
        const Vector3 elbow = 0.06 * Vector3(std::cos(up), std::sin(up), 0), tip = elbow + 0.04 * Vector3(std::cos(out), std::sin(out), 0);
        const auto& body = model->bodies[1];
        const core::kinematics::Pose& start = body.pose_start;
        // A point of the forearm that is its tip at the start.
        const Vector3 local = start.rotation.transpose() * (Vector3(0, 0.1, 0) - start.position);
        CHECK((posed->poses[1].rotation * local + posed->poses[1].position - tip).norm() < 1e-15);
        // The corners of the forearm's end, against the post's face x = 80 mm, where the post is (0 < y as the bar's half width allows).
        const Vector3 across = 0.006 * Vector3(-std::sin(out), std::cos(out), 0);
        const double reach = std::max({(tip + across).x(), (tip - across).x(), (elbow + across).x(), (elbow - across).x()});
        const auto& pair = pair_of(*posed, *model, "fore", "post");
        CHECK(pair.lower <= pair.upper);
        CHECK(pair.upper >= 0.08 - reach - 1e-9);
    }
}

TEST_CASE("posing: the nearest pair comes first, and parts that meet are told with their depth") {
    const auto model = arm_and_post();
    const Result<Posing> posing = Posing::of(model);
    REQUIRE(posing);
    const Result<Posed> posed = posing->at({{"shoulder", -M_PI / 2}});  // straight into the post
    REQUIRE(posed);
    const auto& pair = pair_of(*posed, *model, "fore", "post");
    CHECK(pair.is_clash());
    REQUIRE(pair.overlap);
    CHECK(pair.overlap->depth_lower > 1e-3);
    for (std::size_t k = 1; k < posed->pairs.size(); ++k) CHECK(posed->pairs[k - 1].upper <= posed->pairs[k].upper);
    const Result<Posed> quick = posing->at({{"shoulder", -M_PI / 2}}, false);
    REQUIRE(quick);
    CHECK(pair_of(*quick, *model, "fore", "post").is_clash());
    CHECK_FALSE(pair_of(*quick, *model, "fore", "post").overlap);
    const Result<Posed> straight = posing->at({});
    REQUIRE(straight);
    CHECK(pair_of(*straight, *model, "upper", "post").lower == Approx(0.08 - 0.006).epsilon(1e-3));
}

TEST_CASE("posing: what cannot be is refused") {
    const Result<Posing> posing = Posing::of(arm_and_post());
    REQUIRE(posing);
    CHECK(posing->at({{"sholder", 0.1}}).errors().front().message.find("shoulder") != std::string::npos);
    CHECK(posing->at({{"shoulder", 0.6}}).errors().front().code == ErrorCode::out_of_range);
    CHECK(posing->at({{"shoulder", std::nan("")}}).errors().front().code == ErrorCode::out_of_range);
    CHECK(posing->at({{"shoulder", 0.5}}));  // limits are closed
    core::scene::Scene loose = scene_of({bar("one", 0.02, Vector3::Zero())}, 0.01);
    CHECK_FALSE(Posing::of(std::make_shared<const core::model::Model>(built(loose))));
}

}  // namespace fettle::design::session::posing_test
