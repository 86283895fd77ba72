// SPDX-License-Identifier: MIT
#include "design/gradient_audit/contact_states.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/support/test_models.hpp"

namespace fettle::design::gradient_audit::contact_states_test {

namespace {

using tests::support::box_mesh;
using tests::support::make_body;
using tests::support::make_pose;
using Kind = ContactFeature::Kind;

// One step of bodies that go from one place to another.
core::stepper::Trajectory one_step(const core::model::Model& model, const std::vector<core::kinematics::Pose>& end) {
    core::stepper::Trajectory out;
    out.timestep = model.timestep;
    std::vector<core::kinematics::Pose> start;
    std::vector<core::kinematics::ChartPoint> first, last;
    for (std::size_t i = 0; i < end.size(); ++i) {
        start.push_back(model.bodies[i].pose_start);
        first.push_back({start[i].position, Vector3::Zero()});
        last.push_back({end[i].position, core::kinematics::rotation_vector(end[i].rotation * start[i].rotation.transpose())});
    }
    out.poses = {start, end};
    out.steps = {{{first, last}}};
    return out;
}

core::model::Model on_plate(core::model::Body body) {
    core::model::Model model;
    model.dhat = 1e-3;
    model.timestep = 0.01;
    model.kappa = 1e3;
    model.bodies = {tests::support::ground_plate(), std::move(body)};
    return model;
}

std::vector<ContactState> states(const core::model::Model& model, const core::kinematics::Pose& end) {
    return contact_states(model, one_step(model, {model.bodies[0].pose_start, end})).at(0);
}

}  // namespace

TEST_CASE("a box on a plate is four vertices on one face, wherever the plate is cut", "[contact]") {
    const core::geometry::Mesh box = box_mesh({-0.05, -0.04, 0}, {0.05, 0.04, 0.1});
    for (const double x : {-0.3, 0.0, 0.021}) {  // on one triangle of the plate, on both
        const auto pose = make_pose({0, 0, 0}, {x, 0, 5e-4});
        const core::model::Model model = on_plate(make_body("box", box, pose));
        const std::vector<ContactState> found = states(model, pose);
        REQUIRE(found.size() == 4);
        for (const ContactState& s : found) {
            CHECK(s.a == 0);
            CHECK(s.b == 1);
            CHECK(s.on_a.kind == Kind::face);
            CHECK(s.on_a.vertices.size() == 4);
            CHECK(s.on_b.kind == Kind::vertex);
            CHECK(s.place.z() == Approx(2.5e-4));
            CHECK_FALSE(s.slides);
            CHECK_FALSE(s.is_mollified);
        }
        CHECK(compare_contacts(found[0], found[1]) < 0);
    }
    const core::model::Model apart = on_plate(make_body("box", box, make_pose({0, 0, 0}, {0, 0, 1.1e-3})));
    CHECK(states(apart, apart.bodies[1].pose_start).empty());
}

TEST_CASE("a contact slides faster than eps_v, and sticks below it", "[contact]") {
    core::model::Model model =
        on_plate(make_body("box", box_mesh({-0.05, -0.04, 0}, {0.05, 0.04, 0.1}), make_pose({0, 0, 0}, {0, 0, 5e-4})));
    model.friction.eps_v = 1e-3;  // 1e-5 m a step
    for (const double mu : {0.0, 0.3})
        for (const double moved : {0.99e-5, 1.01e-5}) {
            model.friction.mu.setConstant(mu);
            const std::vector<ContactState> found = states(model, make_pose({0, 0, 0}, {0.6 * moved, -0.8 * moved, 4e-4}));
            REQUIRE(found.size() == 4);
            for (const ContactState& s : found) CHECK(s.slides == (mu > 0 && moved > 1e-5));
        }
}

TEST_CASE("edges that cross, and edges that are nearly parallel", "[contact]") {
    // Two boxes with an edge up and an edge down, over one another.
    const core::geometry::Mesh box = box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
    const double reach = 0.05 * std::sqrt(2.0);
    const Vector3 on_edge(std::numbers::pi / 4, 0, 0);
    const auto turned = [&](double angle) {
        core::kinematics::Pose pose = make_pose(on_edge, {0, 0, 5e-4});
        pose.rotation = core::kinematics::rotation(Vector3(0, 0, angle)) * pose.rotation;
        pose.position.z() += 2 * reach;
        return pose;
    };
    const double limit = std::asin(std::sqrt(1e-3));  // where the mollifier begins
    for (const double angle : {0.98 * limit, 1.02 * limit}) {
        core::model::Model model = on_plate(make_body("upper", box, turned(angle)));
        model.bodies[0] = make_body("lower", box, make_pose(on_edge, {0, 0, 0}), core::scene::BodyType::static_body);
        const std::vector<ContactState> found = states(model, turned(angle));
        CAPTURE(angle, found.size());
        const auto edges = std::find_if(found.begin(), found.end(),
                                        [](const ContactState& s) { return s.on_a.kind == Kind::edge && s.on_b.kind == Kind::edge; });
        REQUIRE(edges != found.end());
        CHECK(edges->is_mollified == (angle < limit));
        CHECK(edges->on_a.vertices.size() == 2);
    }
}

TEST_CASE("neighbouring features have a vertex in common", "[contact]") {
    const ContactFeature vertex{Kind::vertex, {3}}, edge{Kind::edge, {3, 7}}, face{Kind::face, {0, 1, 7}}, other{Kind::vertex, {2}};
    CHECK(adjoin(vertex, edge));
    CHECK(adjoin(edge, face));
    CHECK_FALSE(adjoin(vertex, face));
    CHECK_FALSE(adjoin(other, edge));
}

}  // namespace fettle::design::gradient_audit::contact_states_test
