// SPDX-License-Identifier: MIT
// Certificates: every one of ours is accepted, also after a round through a file. Damaged ones: certificate_damage_test.cpp.
#include "core/certificate/certificate.hpp"

#include <atomic>
#include <catch2/catch.hpp>

#include "core/certificate/certificate_checker.hpp"
#include "core/certificate/interval_motion.hpp"
#include "tests/core/certificate/certificate_case.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::certificate::certificate_test {

using namespace fettle::tests::certificate;
using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;
namespace kinematics = fettle::core::kinematics;

namespace {

Case proven_case(std::mt19937& random) {
    Case c = random_case(random, 0.1, 2, 1e-5);
    while (!(c.results[0].lower > 0)) c = random_case(random, 0.1, 2, 1e-5);
    return c;
}

}  // namespace

TEST_CASE("A certificate survives a file bit for bit", "[clearance]") {
    std::mt19937 random(3);
    Case c = proven_case(random);
    for (BoxProof& box : c.certificate.pairs[0].boxes)  // some leaves whose plane turns, and others
        for (const LeafPlace& leaf : leaves_of(BoxProof(box), 1)) {
            if (leaf.count > 1) normals_of(box, leaf).back() *= 1 - 1e-15;
        }
    const tests::support::TemporaryFolder folder;
    const std::string path = folder.file("a.certificate.json");
    REQUIRE(write_certificate(path, c.certificate).empty());
    CHECK(is_certificate_file(path));
    const auto read = read_certificate(path);
    REQUIRE(read);
    CHECK(read->geometry_hash == c.certificate.geometry_hash);
    CHECK(read->motion == c.certificate.motion);
    const PairCertificate &x = read->pairs.at(0), &y = c.certificate.pairs.at(0);
    CHECK((x.lower == y.lower && x.upper == y.upper && x.at == y.at && x.point_a.weight == y.point_a.weight &&
           x.point_b.index == y.point_b.index));
    REQUIRE(x.boxes.size() == y.boxes.size());
    for (std::size_t i = 0; i < x.boxes.size(); ++i) {
        CHECK(x.boxes[i].splits == y.boxes[i].splits);
        CHECK(x.boxes[i].normals == y.boxes[i].normals);
    }
    CHECK(check_certificate(*read, c.model, c.trajectory).accepted());
}

TEST_CASE("Certificates of earlier versions are read, hold as they did, and are written as those of today", "[clearance]") {
    const std::filesystem::path corpus = std::filesystem::path(FETTLE_SOURCE_DIR) / "tests/fuzz/corpus";
    const tests::support::TemporaryFolder folder;
    const std::string file = folder.file("now.certificate.json");
    for (const auto& [name, about] : {std::pair<const char*, const char*>{"path_version_2", "path"}, {"ranges_version_1", "start"}}) {
        CAPTURE(name);
        const auto stored = core::records::read_trajectory((corpus / "trajectory" / (about + std::string(".json"))).string());
        const auto old = read_certificate(corpus / "certificate" / (name + std::string(".json")));
        REQUIRE((stored && old));
        CHECK(is_certificate_file(corpus / "certificate" / (name + std::string(".json"))));
        CHECK(old->version == certificate_version);
        CHECK(old->linkage.has_value() == (std::string(about) == "start"));
        const CertificateReport report = check_certificate(*old, *stored);
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
        CHECK(report.leaves > 0);
        REQUIRE(write_certificate(file, *old).empty());
        const auto now = read_certificate(file);
        REQUIRE(now);
        CHECK(now->linkage == old->linkage);
        CHECK(now->pairs[0].at == old->pairs[0].at);
        REQUIRE(now->pairs[0].boxes.size() == old->pairs[0].boxes.size());
        CHECK(now->pairs[0].boxes[0].splits == old->pairs[0].boxes[0].splits);
        CHECK(now->pairs[0].boxes[0].normals == old->pairs[0].boxes[0].normals);
        CHECK(check_certificate(*now, *stored).leaves == report.leaves);
    }
}

TEST_CASE("A certificate with a minimum has few leaves, and is accepted", "[clearance]") {
    std::mt19937 random(6);
    for (int i = 0; i < 10; ++i) {
        Case c = proven_case(random);
        core::clearance::ClearanceOptions options;
        options.motion = true;
        options.answer_is_enough = true;
        const double minimum = 1e-3 * c.results[0].lower;
        c.certificate = core::clearance::certify_with_proof(c.model, c.trajectory, {{0, 1, minimum}}, options).certificate;
        REQUIRE(c.certificate.pairs.size() == 1);
        const auto& boxes = c.certificate.pairs[0].boxes;
        std::size_t leaves = 0;
        for (const BoxProof& proof : boxes) leaves += leaves_of(proof, 1).size();
        CAPTURE(i, leaves, boxes.size(), c.certificate.pairs[0].lower, c.results[0].lower);
        CHECK(c.certificate.pairs[0].lower > minimum);
        CHECK(leaves < 100 * boxes.size());  // of hundreds of pairs of elements
        CHECK(check_certificate(c.certificate, c.model, c.trajectory).accepted());
    }
}

TEST_CASE("A stop while a certificate is made leaves nothing that is claimed and not proven", "[clearance]") {
    std::mt19937 random(9);
    const Case c = proven_case(random);
    for (const int calls : {0, 1, 2, 5, 20}) {
        std::atomic<int> left = calls;
        core::clearance::ClearanceOptions options;
        options.motion = true;
        options.should_stop = [&] { return left-- <= 0; };
        const auto proven = core::clearance::certify_with_proof(c.model, c.trajectory, {{0, 1, 1e-6}}, options);
        CAPTURE(calls, proven.pairs[0].lower);
        for (const PairCertificate& pair : proven.certificate.pairs) {
            CHECK(pair.lower == proven.pairs[0].lower);
            CHECK(pair.boxes.empty() == !(pair.lower > 0));
        }
        if (proven.pairs[0].lower == 0) CHECK(proven.pairs[0].status == core::clearance::PairStatus::undecided);
        if (!proven.certificate.pairs.empty()) CHECK(check_certificate(proven.certificate, c.model, c.trajectory).accepted());
    }
}

TEST_CASE("Certificates of small, large, far and fast pairs are accepted", "[clearance]") {
    std::mt19937 random(4);
    int proven = 0;
    for (int i = 0; i < 30; ++i) {
        const double size = std::pow(10, uniform(random, -3, 1));
        const double relative = std::pow(10, uniform(random, -7, -3));
        Case c = random_case(random, size, 2, size * relative);
        CAPTURE(i, size, c.results[0].lower, c.results[0].upper);
        const auto report = check_certificate(c.certificate, c.model, c.trajectory);
        CAPTURE(report.leaves, report.accepted() ? "" : report.faults[0].where + ": " + report.faults[0].message);
        CHECK(report.accepted());
        proven += c.results[0].lower > 0;
    }
    CHECK(proven > 12);
}

TEST_CASE("What the checker proves of a leaf is what sampling in extended precision finds", "[clearance]") {
    std::mt19937 random(5);
    for (int trial = 0; trial < 200; ++trial) {
        const double size = std::pow(10, uniform(random, -3, 1)), turn = std::pow(10, uniform(random, -3, 0.5));
        core::stepper::Trajectory trajectory;
        trajectory.poses.resize(1);
        core::stepper::TrajectoryStep step;
        step.nodes.resize(2);
        for (int b = 0; b < 2; ++b) {
            trajectory.poses[0].push_back({kinematics::rotation(random_vector(random, 2)), Vector3(b * 5 * size, 0, 0)});
            const Vector3 t0 = trial % 3 == 0 ? Vector3(0, 0, 0) : random_vector(random, turn);
            step.nodes[0].push_back({Vector3(-b * 5 * size, 0, 0), t0});
            step.nodes[1].push_back({Vector3(-b * 5 * size, 0, 0) + random_vector(random, size), t0 + random_vector(random, turn)});
        }
        trajectory.steps.push_back(step);
        const auto path_a = body_path(trajectory, 0, 0, 0), path_b = body_path(trajectory, 0, 0, 1);
        const auto cloud = [&](std::size_t count) {
            std::vector<Vector3> points(count);
            for (Vector3& x : points) x = random_vector(random, size * uniform(random, 0.3, 1));
            return points;
        };
        const auto points_a = cloud(trial % 2 ? 3 : 200), points_b = cloud(trial % 4 < 2 ? 3 : 250);
        const auto region = [&](const std::vector<Vector3>& points) {
            Region r{points, points[0], points[0], 1.001 * size};
            for (const Vector3& x : points) {
                r.low = r.low.cwiseMin(x);
                r.high = r.high.cwiseMax(x);
            }
            return r;
        };
        const auto a = region(points_a), b = region(points_b);
        const double h = std::ldexp(1.0, -static_cast<int>(random() % 5)), s0 = h * std::floor(uniform(random, 0, 1) / h);
        LeafPlane plane{Vector3(1, 0, 0) + random_vector(random, 0.3), Vector3(1, 0, 0) + random_vector(random, 0.3)};
        if (trial % 5 == 0) plane.n1 = plane.n0;
        const auto along = [&](Real u) {  // n.(x_a - x_b) of the nearest points, and |n|
            const Real s = s0 + u * h;
            const Real3 n = (1 - u) * plane.n0.cast<Real>() + u * plane.n1.cast<Real>();
            const auto values = [&](int body, const std::vector<Vector3>& X) {
                RealVertices x(3, static_cast<long>(X.size()));
                for (std::size_t k = 0; k < X.size(); ++k) x.col(static_cast<long>(k)) = X[k].cast<Real>();
                const auto p = core::stepper::path_segment(trajectory, 0, 0, body);
                const Real3 t = p.rotation_vector_t0.cast<Real>() + s * p.rotation_vector_step.cast<Real>();
                const Real3 q = p.position_t0.cast<Real>() + s * p.position_step.cast<Real>();
                return (n.transpose() * ((oracle_rotation(t) * p.base.cast<Real>() * x).colwise() + q)).eval();
            };
            return std::pair{values(0, points_a).minCoeff() - values(1, points_b).maxCoeff(), n.norm()};
        };
        Real least = 1e300L, least_unscaled = 1e300L, at = 0;
        const auto sample = [&](Real u) {
            if (u < 0 || u > 1) return;
            const auto [value, norm] = along(u);
            least = std::min(least, value / norm);
            if (value < least_unscaled) {
                least_unscaled = value;
                at = u;
            }
        };
        for (int i = 0; i <= 60; ++i) sample(Real(i) / 60);
        for (Real step = Real(1) / 60; step > 1e-7L; step /= 4)
            for (const Real middle = at; const int i : {-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6}) sample(middle + i * step / 6);
        const double bound = static_cast<double>(least), n_max = std::max(plane.n0.norm(), plane.n1.norm());
        CAPTURE(trial, size, turn, h, bound);
        PathProver prover(path_a, path_b);
        const std::array<Vector3, 2> normals{plane.n0, plane.n1};
        CHECK(prover.prove(a, b, {{s0}, {s0 + h}}, normals, bound + 1e-12 * size, 6) == 0);
        const double claim = static_cast<double>(least_unscaled) / n_max;
        CHECK(prover.prove(a, b, {{s0}, {s0 + h}}, normals, claim - 1e-11 * size, 24) > 0);  // what is true with a little room is proven
    }
}

}  // namespace fettle::core::certificate::certificate_test
