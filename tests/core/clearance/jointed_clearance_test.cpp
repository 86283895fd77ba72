// SPDX-License-Identifier: MIT
// Clearance of a closed loop that a motor turns, charged with what its joints part by between the nodes: against trigonometry; and its
// certificate, which is rejected where the charge is too small.
#include "core/clearance/jointed_clearance.hpp"

#include <filesystem>

#include "core/base/limits.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "tests/core/clearance/four_bar_motion.hpp"

namespace fettle::core::clearance::jointed_clearance_test {

using namespace fettle::tests::four_bar;
using fettle::tests::mechanisms::at_rate;
using fettle::tests::mechanisms::built;
using fettle::tests::support::contains;

namespace {

struct Looked {
    model::Model model;
    stepper::Trajectory trajectory;
    JointedPath path;
    certificate::Certificate certificate;
    PairClearance result, of_path;
};

Looked look(double allowed_gap, double tolerance, double minimum, double plate_lowered = 0, double touch_depth = 0) {
    Looked out;
    out.model = built(four_bar_scene(at_rate(2 * M_PI), 1.0 / 40));
    out.model.bodies[plate_body].pose_start.position.y() -= plate_lowered;
    auto motion = stepper::follow_joints(out.model, 40, allowed_gap);
    REQUIRE(motion);
    out.path = jointed_path(out.model, *motion);
    INFO(out.path.refusal);
    REQUIRE(out.path.joints);
    out.trajectory = motion->trajectory;
    ClearanceOptions options;
    options.motion = true;
    options.tolerance = tolerance;
    std::vector<PairRequest> pairs{{coupler_body, plate_body, minimum}};
    pairs[0].touch_depth = touch_depth;
    out.of_path = certify(out.model, out.trajectory, pairs, options).front();
    auto proven = certify_with_proof(out.model, out.trajectory, out.path, pairs, options);
    out.result = proven.pairs.front();
    out.certificate = std::move(proven.certificate);
    return out;
}

}  // namespace

TEST_CASE("jointed clearance: a four-bar's least gap by trigonometry lies between the charged bounds", "[mechanism][clearance]") {
    for (const double allowed_gap : {1.0, 1e-6}) {
        const Looked at = look(allowed_gap, 1e-8, 0);
        const double truth = least_gap(at.model), charge = joint_charge(*at.path.joints, coupler_body, plate_body);
        CAPTURE(allowed_gap, truth, charge, at.result.lower, at.result.upper, at.of_path.lower);
        CHECK(charge > 0);
        CHECK(at.result.lower <= truth);
        CHECK(truth <= at.result.upper);
        CHECK(truth - at.result.lower <= charge);
        CHECK(at.result.status == PairStatus::clear);
        if (allowed_gap == 1) CHECK(at.of_path.lower > truth + 1e-6);  // the path as stored cuts the corner: its bound alone is too much
        if (allowed_gap < 1) CHECK(charge < 2e-5);
    }
}

TEST_CASE("jointed clearance: verdicts are of the joints, not of the path", "[mechanism][clearance]") {
    const double truth = least_gap(built(four_bar_scene(at_rate(1), 1)));
    const double charge = joint_charge(*look(1, 1e-6, 0).path.joints, coupler_body, plate_body);
    CHECK(look(1, 1e-6, truth - 2.5 * charge).result.status == PairStatus::clear);
    CHECK(look(1, 1e-6, truth + 2.5 * charge).result.status == PairStatus::violated);
    const Looked between = look(1, 1e-6, truth);
    CHECK(between.result.status == PairStatus::undecided);
    CHECK(!between.result.reason.empty());
    CHECK(between.of_path.status == PairStatus::clear);  // which is not so
    CHECK(between.result.minimum == truth);
}

TEST_CASE("jointed clearance: a clash of the path is one of the joints if it is deeper than they part by", "[mechanism][clearance]") {
    const double truth = least_gap(built(four_bar_scene(at_rate(1), 1)));
    const double charge = joint_charge(*look(1, 1e-6, 0).path.joints, coupler_body, plate_body);
    const Looked deep = look(1, 1e-6, 0, truth + 0.012);
    CHECK(deep.result.is_clash());
    CHECK(deep.result.status == PairStatus::violated);
    CHECK(deep.result.overlap->depth_lower > charge);
    const Looked shallow = look(1, 1e-6, 0, truth + 0.2 * charge);
    CHECK(shallow.of_path.is_clash());
    CHECK(!shallow.result.is_clash());
    CHECK(shallow.result.status == PairStatus::undecided);
    CHECK(shallow.result.solids == Solids::unproven);
    CHECK(shallow.result.lower == 0);
    CHECK(shallow.result.reason.find("joints part") == 0);
}

TEST_CASE("jointed clearance: bodies that touch, and cross on the path by less than joints part by, are not told as crossing",
          "[mechanism][clearance]") {
    const double truth = least_gap(built(four_bar_scene(at_rate(1), 1)));
    const double charge = joint_charge(*look(1e-6, 1e-6, 0).path.joints, coupler_body, plate_body);
    int crossing = 0;
    for (const double share : {0.2, 0.6, 1.5}) {
        const Looked at = look(1e-6, 1e-6, 0, truth + share * charge, 1e-3);
        CAPTURE(share, charge, at.of_path.reason, at.result.reason);
        if (!at.of_path.touch || at.of_path.status != PairStatus::violated) continue;
        ++crossing;
        CHECK(at.result.status == PairStatus::undecided);
        CHECK(at.result.reason.find("joints part") == 0);
    }
    CHECK(crossing >= 1);
}

TEST_CASE("jointed clearance: the certificate is accepted, and rejected where it charges too little", "[mechanism][clearance]") {
    const Looked at = look(1, 1e-5, 0);
    REQUIRE(at.certificate.joints);
    const auto checked = [&](const certificate::Certificate& c) { return check_certificate(c, at.model, at.trajectory); };
    CHECK(checked(at.certificate).accepted());
    for (const double share : {0.0, 0.9}) {
        certificate::Certificate doctored = at.certificate;
        for (double& deviation : doctored.joints->deviations) deviation *= share;
        const auto report = checked(doctored);
        REQUIRE(!report.accepted());
        CHECK(report.faults.front().where == "/joints/deviations/0");
        CHECK(contains(report.faults.front().message, "farther from the path than is claimed"));
    }
    certificate::Certificate loose = at.certificate;  // one joint less, and its rows' room filled with another's
    loose.joints->rows.back() = loose.joints->rows.front();
    CHECK(!checked(loose).accepted());
    certificate::Certificate fewer = at.certificate;
    fewer.joints->bodies.pop_back();
    CHECK(!checked(fewer).accepted());

    const auto file = std::filesystem::temp_directory_path() / "fettle_jointed.certificate.json";
    REQUIRE(write_certificate(file, at.certificate).empty());
    const auto read = certificate::read_certificate(file);
    std::filesystem::remove(file);
    REQUIRE(read);
    REQUIRE(read->joints);
    CHECK(same_joints(*read->joints, *at.certificate.joints));
    CHECK(read->joints->deviations == at.certificate.joints->deviations);
    CHECK(checked(*read).accepted());
}

TEST_CASE("jointed clearance: bodies with prescribed coordinates beside joints are not charged, so nothing is told of them as proven",
          "[mechanism][clearance]") {
    scene::Scene written = four_bar_scene(at_rate(2 * M_PI), 1.0 / 40);
    auto model = built(written);
    model.bodies[rocker_body].prescribed[2] = core::scene::MotionCurve{};
    const auto joints = ideal_joints(model, {});
    REQUIRE(!joints);
    CHECK(contains(joints.errors()[0].message, "'rocker' has prescribed coordinates beside joints"));
}

TEST_CASE("jointed clearance: where the joints have bodies is not proven, so their pairs have no bounds and no certificate",
          "[mechanism][clearance]") {
    const Looked at = look(1, 1e-5, 0);
    model::Model model = at.model;  // and two bodies that no joint moves: a post below the plate
    model.bodies.push_back(model.bodies[plate_body]);
    model.bodies.back().name = "post";
    model.bodies.back().pose_start.position.y() += 0.3;
    stepper::Trajectory trajectory = at.trajectory;
    trajectory.body_names.push_back("post");
    for (auto& poses : trajectory.poses) poses.push_back(model.bodies.back().pose_start);
    for (auto& step : trajectory.steps)
        for (auto& node : step.nodes) node.push_back({model.bodies.back().pose_start.position, Vector3::Zero()});
    const int post = plate_body + 1;
    ClearanceOptions options;
    options.motion = options.margin_curve = true;
    options.tolerance = 1e-5;
    CHECK(jointed_bodies(model, {}) == std::vector<int>{crank_body, coupler_body, rocker_body});
    CHECK(jointed_bodies(model, {"crank", "coupler", "rocker"}).empty());
    const JointedPath unproven{std::nullopt, "why", jointed_bodies(model, {})};
    const std::vector<PairRequest> pairs{{coupler_body, plate_body, 1e-3}, {plate_body, post, 0.1}, {crank_body, rocker_body, 0}};
    const auto [results, certificate] = certify_with_proof(model, trajectory, unproven, pairs, options);
    for (const int k : {0, 2}) {
        const PairClearance& untold = results[k];
        CAPTURE(k, untold.reason);
        CHECK(untold.status == PairStatus::undecided);
        CHECK(contains(untold.reason, "why"));
        CHECK(!untold.is_bounded);
        CHECK(untold.lower == 0);
        CHECK(untold.upper == base::infinity);
        CHECK(untold.margin.empty());
        CHECK(untold.minimum == pairs[k].minimum);
    }
    CHECK(results[1].status == PairStatus::clear);
    CHECK(results[1].is_bounded);
    CHECK(results[1].lower == Approx(0.2).margin(1e-4));
    REQUIRE(certificate.pairs.size() == 1);
    CHECK(certificate.pairs[0].a == plate_body);
    CHECK(certificate.is_of_path);
    CHECK(check_certificate(certificate, model, trajectory).accepted());
}

}  // namespace fettle::core::clearance::jointed_clearance_test
