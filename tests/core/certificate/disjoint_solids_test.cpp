// SPDX-License-Identifier: MIT
#include "core/certificate/disjoint_solids.hpp"

#include <catch2/catch.hpp>

#include "core/certificate/certificate_checker.hpp"
#include "tests/core/certificate/certificate_case.hpp"

namespace fettle::core::certificate::disjoint_solids_test {

using namespace fettle::tests::certificate;

namespace {

// Two bodies at rest; the second is at `place`.
Case case_of(const Solid& a, const Solid& b, const Vector3& place, double minimum = 0.01) {
    Case c;
    c.trajectory.timestep = 0.1;
    c.trajectory.poses.resize(1);
    for (const auto& [solid, position] : {std::pair{&a, Vector3(0.3, -7, 2)}, std::pair{&b, Vector3(Vector3(0.3, -7, 2) + place)}}) {
        core::model::Body body;
        body.name = "body " + std::to_string(c.model.bodies.size());
        body.mesh = solid->mesh;
        body.hierarchy = solid->hierarchy;
        c.model.bodies.push_back(body);
        c.trajectory.body_names.push_back(body.name);
        c.trajectory.poses[0].push_back({core::kinematics::rotation(Vector3(0.3, 0.2, -1)), position});
    }
    auto proven = core::clearance::certify_with_proof(c.model, c.trajectory, {{0, 1, minimum}}, {});
    c.results = std::move(proven.pairs);
    c.certificate = std::move(proven.certificate);
    return c;
}

}  // namespace

TEST_CASE("No claim about a body inside another is accepted", "[clearance]") {
    const Case c = case_of(box({1, 1, 1}), box({0.2, 0.2, 0.2}), Vector3(0.1, 0, 0));
    CHECK(c.certificate.pairs.at(0).solids == Solids::overlap);
    // The bound of the surfaces, which is true and proven, with every claim about the solids.
    auto aside = case_of(box({1, 1, 1}), box({0.2, 0.2, 0.2}), Vector3(3, 0, 0));
    Certificate forged = c.certificate;
    const auto open = [&] {  // the proof, as the surfaces have one: that of an open block of the same faces
        Solid shell = box({1, 1, 1});
        auto triangles = shell.mesh.triangles;
        std::swap(triangles[0][0], triangles[0][1]);  // not closed any more: an edge has the same direction twice
        return case_of(make_solid(shell.mesh.vertices, triangles), box({0.2, 0.2, 0.2}), Vector3(0.1, 0, 0));
    }();
    CHECK(open.certificate.pairs.at(0).solids == Solids::unverified);
    REQUIRE(open.certificate.pairs.at(0).lower > 0.1);
    forged.pairs = open.certificate.pairs;
    for (const Solids claim : {Solids::unproven, Solids::disjoint, Solids::not_closed, Solids::overlap}) {
        forged.pairs[0].solids = claim;
        const auto report = check_certificate(forged, c.model, c.trajectory);
        CAPTURE(to_string(claim));
        CHECK(!report.accepted());
        CHECK(!report.stale);
        REQUIRE(report.faults.size() == 1);
        CHECK(report.faults[0].where == "/pairs/0/solids");
    }
    CHECK(aside.certificate.pairs.at(0).solids == Solids::disjoint);
    CHECK(check_certificate(aside.certificate, aside.model, aside.trajectory).accepted());
    aside.certificate.pairs[0].solids = Solids::unproven;  // less is claimed than is true
    CHECK(check_certificate(aside.certificate, aside.model, aside.trajectory).accepted());
}

TEST_CASE("A certificate without pairs, or of another path, certifies nothing", "[clearance]") {
    Case c = case_of(box({1, 1, 1}), box({0.2, 0.2, 0.2}), Vector3(3, 0, 0));
    REQUIRE(check_certificate(c.certificate, c.model, c.trajectory).accepted());
    Certificate empty = c.certificate;
    empty.pairs.clear();
    CHECK(!check_certificate(empty, c.model, c.trajectory).accepted());
    auto moved = c.trajectory;
    moved.poses[0][1].position.x() += 5;  // farther: the bounds still hold, but they are not about this
    const auto report = check_certificate(c.certificate, c.model, moved);
    CHECK(report.stale);
    CHECK(!report.accepted());
    c.model.bodies[0].mesh.vertices(0, 0) *= 0.5;
    CHECK(check_certificate(c.certificate, c.model, c.trajectory).stale);
    CHECK(uncovered_pairs(c.certificate, 3) == std::vector<std::array<int, 2>>{{0, 2}, {1, 2}});
}

TEST_CASE("Inside and outside are told right up to rounding", "[clearance]") {
    const Solid block = box({1, 1, 1}), point = box({1e-6, 1e-6, 1e-6});
    const SolidMesh a = solid_mesh(block.mesh), b = solid_mesh(point.mesh);
    std::mt19937 random(11);
    for (int trial = 0; trial < 300; ++trial) {
        core::stepper::Trajectory trajectory;
        const Matrix3 rotation = core::kinematics::rotation(random_vector(random, 3));
        const double gap = std::pow(10, uniform(random, -12, -1));
        const bool inside = trial % 2 == 0;
        const Vector3 place = random_vector(random, 1) * 0.5, origin = random_vector(random, 10);
        Vector3 local = place;
        local[trial % 3] = inside ? 1 - gap - 1e-6 : 1 + gap + 1e-6;
        trajectory.poses.push_back({{rotation, origin}, {rotation, rotation * local + origin}});
        const Solids found = solids_of(a, b, {trajectory, -1, 0, 0, 1}, gap / 2);
        CAPTURE(trial, gap);
        CHECK(found == (inside ? Solids::overlap : Solids::disjoint));
        CHECK(solids_of(a, b, {trajectory, -1, 0, 0, 1}, 1e-18) == Solids::unproven);
        CHECK(solids_of(a, b, {trajectory, -1, 0, 0, 1}, 0) == Solids::unproven);
    }
}

TEST_CASE("What bodies may be off their path counts for lids as for surfaces", "[clearance]") {
    const Solid whole = box({1, 1, 1}), part = box({0.01, 0.01, 0.01});
    auto triangles = whole.mesh.triangles;
    const core::geometry::Triangle gone = triangles.back();
    triangles.pop_back();
    const Solid open = make_solid(whole.mesh.vertices, triangles);
    const auto corner = [&](std::size_t k) { return Vector3(whole.mesh.vertices.col(gone[k])); };
    const Vector3 out = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    // 0.1 above the middle of the opening, 0.47 and more from its edges.
    const Vector3 place = (corner(0) + corner(1) + corner(2)) / 3 + 0.11 * out;
    core::stepper::Trajectory trajectory;
    trajectory.poses.push_back({{Matrix3::Identity(), Vector3::Zero()}, {Matrix3::Identity(), place}});
    const SolidMesh a = solid_mesh(open.mesh), b = solid_mesh(part.mesh);
    const auto found = [&](double charge) { return solids_of(a, b, {trajectory, -1, 0, 0, 1, {Place{}}, charge}, 0.4); };
    CHECK(found(0) == Solids::not_closed);
    CHECK(found(0.05) == Solids::not_closed);
    CHECK(found(0.2) == Solids::unverified);
    CHECK(found(0.45) == Solids::unproven);
}

}  // namespace fettle::core::certificate::disjoint_solids_test
