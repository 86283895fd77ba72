// SPDX-License-Identifier: MIT
// Clearance over turns and tilts of round bodies: closed forms, and their certificates.
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/range_clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/round_meshes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::clearance::round_ranges_test {

using namespace fettle::tests::mechanisms;
using fettle::tests::clearance::Real;
using fettle::tests::clearance::Real3;
using fettle::tests::support::RoundMesh;
using scene::JointKind;

namespace {

const Vector3 zero = Vector3::Zero(), z_axis = Vector3::UnitZ();

scene::Body body_of(const std::string& name, const RoundMesh& mesh, bool is_static) {
    scene::Body body;
    body.name = name;
    body.where = "a.scene.json#/bodies/" + name;
    body.mesh = mesh.mesh();
    if (is_static) body.type = scene::BodyType::static_body;
    return body;
}

struct Fit {
    model::Model model;
    JointRanges ranges;
    PairClearance found;
    certificate::Certificate certificate;

    certificate::CertificateReport check() const { return check_certificate(certificate, model, as_assembled(model)); }
    std::string leaves() const {
        std::string out;
        for (const char c : certificate.pairs.at(0).boxes.at(0).splits)
            if (c == '.' || c == ':' || c == 'o') out += c;
        return out;
    }
};

// The inner one moves.
Fit fit_of(const RoundMesh& inner, const RoundMesh& outer, const scene::Joint& joint, double minimum) {
    scene::Scene scene = scene_of({body_of("seat", outer, true), body_of("pin", inner, false)}, 0.01);
    scene.mechanism.joints = {joint};
    Fit out{built(scene), {}, {}, {}};
    auto ranges = joint_ranges(out.model);
    REQUIRE(ranges);
    out.ranges = *std::move(ranges);
    const std::vector<PairRequest> pairs{{0, 1, minimum}};
    ProvenClearances proven = certify_with_proof(out.model, out.ranges, pairs, usual_options(pairs));
    out.found = proven.pairs.front();
    out.certificate = std::move(proven.certificate);
    return out;
}

scene::Joint in_seat(JointKind kind) { return joint("joint", kind, {"", zero, z_axis}, {"pin", zero, z_axis}); }

// How near the facets of a mesh come to the origin.
double nearest_facet(const RoundMesh& mesh) {
    Real least = 1e30L;
    const auto point = [&](int k) { return Real3(mesh.vertices[k].cast<Real>()); };
    for (const auto& t : mesh.triangles) {
        const Real3 a = point(t[0]), b = point(t[1]), c = point(t[2]), n = (b - a).cross(c - a);
        Real best = std::min({a.norm(), b.norm(), c.norm()});
        const auto edge = [&](const Real3& from, const Real3& to) {
            const Real s = -from.dot(to - from) / (to - from).squaredNorm();
            if (s > 0 && s < 1) best = std::min(best, (from + s * (to - from)).norm());
        };
        edge(a, b);
        edge(b, c);
        edge(c, a);
        const Real3 foot = n * (a.dot(n) / n.squaredNorm());
        const auto is_left = [&](const Real3& from, const Real3& to) { return (to - from).cross(foot - from).dot(n) >= 0; };
        if (is_left(a, b) && is_left(b, c) && is_left(c, a)) best = std::min(best, foot.norm());
        least = std::min(least, best);
    }
    return static_cast<double>(least);
}

}  // namespace

TEST_CASE("round: a ball in its socket keeps the play less the facets, whatever way it is turned", "[ranges]") {
    const double radius = 5e-3, play = 0.3e-3;
    const RoundMesh inner = tests::support::ball(radius, 12, 24), outer = tests::support::shell(radius + play, 8e-3, 12, 24);
    const double exact = nearest_facet(outer) - radius;
    REQUIRE(exact > 0.2e-3);
    const Fit fit = fit_of(inner, outer, in_seat(JointKind::ball), exact - 1e-9);
    CAPTURE(exact, fit.found.lower, fit.found.upper, fit.found.bounds);
    CHECK(fit.found.status == PairStatus::clear);
    CHECK(fit.found.lower >= exact - 1e-9);
    CHECK(fit.found.lower <= exact);
    CHECK(fit.found.upper >= exact - 1e-12);
    CHECK(fit.found.bounds < 300'000);
    CHECK(fit.found.coordinates.size() == 3);
    const auto report = fit.check();
    for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
    CHECK(report.accepted());
    CHECK(fit.leaves().find_first_not_of('o') == std::string::npos);
    // A nanometre more than the facets leave is not there, and is not proven.
    const Fit above = fit_of(inner, outer, in_seat(JointKind::ball), exact + 1e-9);
    CHECK(above.found.status != PairStatus::clear);
}

TEST_CASE("round: a pin that turns and slides in its bore keeps the apothem less its radius", "[ranges]") {
    const double radius = 4e-3, bore = 4.25e-3;
    const int sides = 20;
    const RoundMesh inner = tests::support::revolved({{0, -10e-3}, {radius, -10e-3}, {radius, 10e-3}, {0, 10e-3}}, 14),
                    outer = tests::support::revolved({{bore, -4e-3}, {7e-3, -4e-3}, {7e-3, 4e-3}, {bore, 4e-3}}, sides);
    scene::Joint joint = in_seat(JointKind::cylindrical);
    joint.forces.limits = {-3e-3, 3e-3};
    const double exact = bore * std::cos(M_PI / sides) - radius;
    const Fit fit = fit_of(inner, outer, joint, exact - 1e-12);
    CAPTURE(exact, fit.found.lower, fit.found.upper, fit.found.bounds);
    CHECK(fit.found.status == PairStatus::clear);
    CHECK(fit.found.lower <= exact);
    CHECK(fit.found.upper >= exact - 1e-15);
    CHECK(fit.found.bounds < 50'000);
    CHECK(fit.check().accepted());
}

TEST_CASE("round: a cone that turns in its seat, and sinks into it", "[ranges]") {
    // Both widen by 1 in 2; the seat's faces are flat between its 24 half planes.
    const double play = 0.5e-3, sink = 0.2e-3;
    const int sides = 24;
    const RoundMesh inner = tests::support::revolved({{0, 0}, {2e-3, 0}, {6e-3, 8e-3}, {0, 8e-3}}, 18),
                    outer = tests::support::revolved({{2e-3 + play, 0}, {9e-3, 0}, {9e-3, 8e-3}, {6e-3 + play, 8e-3}}, sides);
    scene::Joint joint = in_seat(JointKind::cylindrical);
    joint.forces.limits = {-sink, 1e-3};
    // In the half plane of r and z, from the inner cone's line to where the seat's faces are nearest: r of a face's middle is that of its
    // corners times cos(pi/n). The lines are no longer parallel; the nearest is at the foot, where the seat is widest against them.
    const double foot = std::cos(M_PI / sides);
    Real exact = 1e30L;
    for (int i = 0; i <= 4000; ++i) {
        const Real s = i / 4000.0L, r = foot * (2e-3L + play + s * 4e-3L), z = s * 8e-3L;
        for (int j = 0; j <= 4000; ++j) {
            const Real t = j / 4000.0L;
            exact = std::min(exact, std::hypot(r - (2e-3L + t * 4e-3L), z - (t * 8e-3L - static_cast<Real>(sink))));
        }
    }
    const double sampled = static_cast<double>(exact);  // above the least by less than a step's square over it
    const Fit fit = fit_of(inner, outer, joint, sampled - 1e-8);
    CAPTURE(sampled, fit.found.lower, fit.found.upper, fit.found.bounds);
    CHECK(fit.found.status == PairStatus::clear);
    CHECK(fit.found.lower <= sampled);
    CHECK(fit.found.bounds < 200'000);
    CHECK(fit.check().accepted());
}

TEST_CASE("round: damaged leaves are rejected, certificates are written and read back", "[ranges]") {
    const RoundMesh inner = tests::support::ball(5e-3, 6, 8), outer = tests::support::shell(7e-3, 9e-3, 6, 8);
    const Fit sound = fit_of(inner, outer, in_seat(JointKind::ball), 0.1e-3);
    REQUIRE(sound.check().accepted());
    REQUIRE(sound.leaves().find('o') != std::string::npos);
    const auto damaged = [&](const auto& damage) {
        Fit fit = sound;
        damage(fit.certificate.pairs[0]);
        return !fit.check().accepted();
    };
    using certificate::PairCertificate;
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].normals[0] *= -1; }));
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].normals[0] *= 0; }));
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].normals[0][2] = 1; }));
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].normals[0][0] = std::nan(""); }));
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].normals.pop_back(); }));
    CHECK(damaged([](PairCertificate& p) { p.lower = p.upper * (1 + 1e-9); }));
    CHECK(damaged([](PairCertificate& p) { p.boxes[0].splits[p.boxes[0].splits.find('o')] = '.'; }));
    // It proves nothing about a joint that lets the ball go about another point.
    Fit moved = sound;
    moved.certificate.linkage->bodies[1].screws[1].point += Vector3(1e-9, 0, 0);
    CHECK(!moved.check().accepted());
    // Nor of a pair on a path.
    Fit path = sound;
    path.certificate.linkage.reset();
    CHECK(!path.check().accepted());
    const tests::support::TemporaryFolder folder;
    const std::string file = folder.file("fit.certificate.json");
    REQUIRE(write_certificate(file, sound.certificate).empty());
    const auto read = certificate::read_certificate(file);
    REQUIRE(read);
    CHECK(read->pairs[0].boxes[0].splits == sound.certificate.pairs[0].boxes[0].splits);
    CHECK(check_certificate(*read, sound.model, as_assembled(sound.model)).accepted());
}

}  // namespace fettle::core::clearance::round_ranges_test
