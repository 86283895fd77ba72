// SPDX-License-Identifier: MIT
// Clearance over the ranges of closed loops: against linkages by trigonometry, sampled in extended precision, and their certificates.
#include <random>

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/looped_bodies.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::clearance::looped_clearance_test {

using namespace fettle::tests::mechanisms;
using fettle::tests::clearance::Real;
using scene::JointKind;

namespace {

const Vector3 zero = Vector3::Zero(), z_axis = Vector3::UnitZ();

constexpr double crank = 0.1, coupler = 0.3, rocker = 0.25, ground = 0.35;

// The angles of crank, coupler and rocker, the open assembly: the two circles' intersection above the ground line.
std::array<double, 3> angles_at(double of_crank) {
    const Vector2 pin(crank * std::cos(of_crank), crank * std::sin(of_crank)), pivot(ground, 0), between = pivot - pin;
    const double length = between.norm(), along = (length * length + coupler * coupler - rocker * rocker) / (2 * length);
    const double across = std::sqrt(coupler * coupler - along * along);
    const Vector2 unit = between / length, joint = pin + along * unit + across * Vector2(-unit.y(), unit.x());
    return {of_crank, std::atan2(joint.y() - pin.y(), joint.x() - pin.x()), std::atan2(joint.y(), joint.x() - ground)};
}

std::array<Vector3, 3> places_at(double of_crank) {
    return {zero, Vector3(crank * std::cos(of_crank), crank * std::sin(of_crank), 0), Vector3(ground, 0, 0)};
}

// @param low, high  of the crank, from where it stands at `start`
scene::Scene four_bar(double start, double low, double high) {
    const auto angles = angles_at(start);
    const auto places = places_at(start);
    std::vector<scene::Body> bodies;
    const std::array<const char*, 3> names{"crank", "coupler", "rocker"};
    const std::array<double, 3> lengths{crank, coupler, rocker};
    for (std::size_t k = 0; k < 3; ++k) bodies.push_back(bar(names[k], lengths[k], places[k], Vector3(0, 0, angles[k])));
    scene::Body post = bar("post", 0.03, Vector3(0.12, 0.34, 0));
    post.type = scene::BodyType::static_body;
    bodies.push_back(post);
    scene::Scene scene = scene_of(bodies, 0.01);
    scene.mechanism.joints = {
        joint("A", JointKind::revolute, {"", zero, z_axis}, {"crank", zero, z_axis}),
        joint("B", JointKind::revolute, {"crank", Vector3(crank, 0, 0), z_axis}, {"coupler", zero, z_axis}),
        joint("D", JointKind::revolute, {"", Vector3(ground, 0, 0), z_axis}, {"rocker", zero, z_axis}),
        joint("C", JointKind::revolute, {"coupler", Vector3(coupler, 0, 0), z_axis}, {"rocker", Vector3(rocker, 0, 0), z_axis})};
    scene.mechanism.joints[0].forces.limits = {low, high};
    return scene;
}

double distance_at(const model::Model& model, int a, int b, double of_crank) {
    const auto vertices = [&](int body) {
        const model::Body& of = model.bodies[body];
        const Matrix3X file = of.mesh.vertices.colwise() + of.reference_point;
        tests::clearance::RealVertices x = file.cast<Real>();
        if (body == 3) return tests::clearance::RealVertices(x.colwise() + tests::clearance::Real3(0.12L, 0.34L, 0));
        const auto k = static_cast<std::size_t>(body);
        const auto turn = tests::clearance::oracle_rotation(Real(angles_at(of_crank)[k]) * tests::clearance::Real3(0, 0, 1));
        return tests::clearance::RealVertices((turn * x).colwise() + places_at(of_crank)[k].cast<Real>());
    };
    return static_cast<double>(tests::clearance::oracle_distance(model.bodies[a].mesh, vertices(a), model.bodies[b].mesh, vertices(b)));
}

struct Looked {
    model::Model model;
    certificate::Toleranced bodies;
    std::vector<PairClearance> found;
    certificate::Certificate certificate;
};

Looked looked_at(const scene::Scene& scene, const std::vector<PairRequest>& pairs) {
    Looked out{built(scene), {}, {}, {}};
    CHECK(closes_loops(out.model));
    CHECK(!joint_ranges(out.model));
    const auto looped = looped_ranges(out.model);
    REQUIRE(looped);
    out.bodies = looped_bodies(out.model, *looped);
    CHECK(out.bodies.deviations.empty());
    CHECK(is_over_ranges(out.bodies));
    ProvenClearances proven = certify_with_proof(out.model, out.bodies, pairs, usual_options(pairs, 1e-3));
    out.found = std::move(proven.pairs);
    out.certificate = std::move(proven.certificate);
    return out;
}

}  // namespace

TEST_CASE("loops: a four-bar over all positions of its crank, no sample is below the bound", "[ranges][loops]") {
    const double start = 1.2, low = -0.7, high = 0.9;
    const std::vector<PairRequest> pairs{{1, 3, 1e-3}, {2, 3, 1e-3}, {0, 2, 1e-3}};
    const Looked looked = looked_at(four_bar(start, low, high), pairs);
    std::mt19937 random(1);
    for (const PairClearance& pair : looked.found) {
        CAPTURE(pair.a, pair.b, pair.lower, pair.upper, pair.reason, pair.bounds);
        double least = 1e9;
        for (int i = 0; i <= 2000; ++i)
            least = std::min(least, distance_at(looked.model, pair.a, pair.b, start + low + (high - low) * i / 2000));
        CHECK(pair.lower <= least);
        CHECK(pair.upper >= least - 1e-4);
        CHECK(pair.lower > least - 2e-3);
        REQUIRE(!pair.at.empty());
        CHECK(distance_at(looked.model, pair.a, pair.b, start + pair.at[0]) == Approx(pair.upper).margin(1e-8));
        CHECK(pair.status == PairStatus::clear);
    }
    const auto report = check_certificate(looked.certificate, looked.model, as_assembled(looked.model));
    for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
    CHECK(report.accepted());
    CHECK(report.leaves > 0);
}

TEST_CASE("loops: a post in the coupler's way is found, whole turns of a crank are looked at", "[ranges][loops]") {
    scene::Scene scene = four_bar(1.2, -0.1, 0.1);
    scene.mechanism.joints[0].forces.limits.reset();
    scene::Motor drive = motor("drive", "A", {});
    drive.curve.rate = 1;
    scene.mechanism.motors.push_back(drive);
    const Looked looked = looked_at(scene, {{1, 3, 1e-3}});
    const PairClearance& pair = looked.found.front();
    double least = 1e9;
    for (int i = 0; i < 2000; ++i) least = std::min(least, distance_at(looked.model, 1, 3, 2 * M_PI * i / 2000));
    CAPTURE(pair.lower, pair.upper, pair.reason, least);
    CHECK(pair.lower <= least);
    CHECK((least > 0 ? pair.upper >= least - 1e-4 : pair.status == PairStatus::violated));
    CHECK(pair.status != PairStatus::undecided);
}

}  // namespace fettle::core::clearance::looped_clearance_test
