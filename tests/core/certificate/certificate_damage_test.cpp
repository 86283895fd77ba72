// SPDX-License-Identifier: MIT
// Certificates that were made false or unproven are rejected, every one.
#include <catch2/catch.hpp>

#include <functional>
#include <set>

#include "core/certificate/certificate_checker.hpp"
#include "tests/core/certificate/certificate_case.hpp"

namespace fettle::core::certificate::certificate_damage_test {

using namespace fettle::tests::certificate;
using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;
namespace kinematics = fettle::core::kinematics;

namespace {

Real distance_at(const Case& c, int step, int segment, Real s) {
    const auto placed = [&](int b) {
        return oracle_vertices(core::stepper::path_segment(c.trajectory, step, segment, b), c.model.bodies[b].mesh.vertices, s);
    };
    return oracle_distance(c.model.bodies[0].mesh, placed(0), c.model.bodies[1].mesh, placed(1));
}

// A kind of damage. True: the claim is now false, or its proof is gone.
using Damage = std::function<bool(Case&, std::mt19937&)>;

BoxProof& any_proof(Case& c, std::mt19937& random) {
    auto& boxes = c.certificate.pairs[0].boxes;
    return boxes[random() % boxes.size()];
}

LeafPlace any_leaf(const BoxProof& proof, std::mt19937& random) {
    const auto leaves = leaves_of(proof, 1);
    return leaves[random() % leaves.size()];
}

// After moving what the certificate is about: false if the witness's instant shows less than the claimed bound.
bool claim_is_false(const Case& c) {
    const PairCertificate& pair = c.certificate.pairs[0];
    return distance_at(c, pair.step, pair.segment, pair.at[0]) < pair.lower * (1 - 1e-9);
}

Vector3 from_b_to_a(const Case& c) { return (c.results[0].witness.point_a - c.results[0].witness.point_b).normalized(); }

const std::vector<std::pair<const char*, Damage>>& damages() {
    static const std::vector<std::pair<const char*, Damage>> list{
        {"lower above upper",
         [](Case& c, std::mt19937& r) {
             return c.certificate.pairs[0].lower = c.certificate.pairs[0].upper * (1 + uniform(r, 1e-9, 1)), true;
         }},
        {"both bounds raised",
         [](Case& c, std::mt19937& r) {
             PairCertificate& p = c.certificate.pairs[0];
             p.lower = p.upper * (1 + uniform(r, 1e-6, 0.5));
             p.upper = p.lower * (1 + uniform(r, 0, 0.5));
             return true;
         }},
        {"upper lowered",
         [](Case& c, std::mt19937& r) {
             PairCertificate& p = c.certificate.pairs[0];
             p.upper *= 1 - uniform(r, 1e-8, 1);
             p.lower = std::min(p.lower, p.upper);
             return true;
         }},
        {"upper not attained",
         [](Case& c, std::mt19937& r) {
             return c.certificate.pairs[0].upper *= 1 + uniform(r, 1e-3, 1), c.certificate.pairs[0].upper > 1e-6;
         }},
        {"bound not a number",
         [](Case& c, std::mt19937& r) {
             return (r() % 2 ? c.certificate.pairs[0].lower : c.certificate.pairs[0].upper) = std::nan(""), true;
         }},
        {"negative bound", [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].lower = -uniform(r, 1e-12, 1), true; }},
        {"witness elsewhere in time",
         [](Case& c, std::mt19937& r) {
             PairCertificate& p = c.certificate.pairs[0];
             p.at[0] = uniform(r, 0, 1);
             // A false claim only if the same points are elsewhere then; the least distance of the bodies tells on one side.
             return distance_at(c, p.step, p.segment, p.at[0]) > p.upper * (1 + 1e-6);
         }},
        {"witness outside of time", [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].at[0] = (r() % 2 ? 1.5 : -0.5), true; }},
        {"witness of no step", [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].step = r() % 2 ? -1 : 1000, true; }},
        {"witness of no segment", [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].segment = r() % 2 ? -1 : 7, true; }},
        {"witness of no primitive",
         [](Case& c, std::mt19937& r) {
             return (r() % 2 ? c.certificate.pairs[0].point_a : c.certificate.pairs[0].point_b).index = r() % 2 ? -1 : 100000, true;
         }},
        {"negative weight",
         [](Case& c, std::mt19937& r) {
             return (r() % 2 ? c.certificate.pairs[0].point_a : c.certificate.pairs[0].point_b).weight = {2, -1, 0}, true;
         }},
        {"no weight",
         [](Case& c, std::mt19937& r) {
             return (r() % 2 ? c.certificate.pairs[0].point_a : c.certificate.pairs[0].point_b).weight = {0, 0, 0}, true;
         }},
        {"another vertex as witness",
         [](Case& c, std::mt19937& r) {
             PairCertificate& p = c.certificate.pairs[0];
             const int body = static_cast<int>(r() % 2);
             const auto& x = c.model.bodies[body].mesh.vertices;
             CertifiedPoint& point = body == 0 ? p.point_a : p.point_b;
             point = {Primitive::vertex, static_cast<int>(r() % x.cols()), {1, 0, 0}};
             const auto pose = kinematics::pose_at(core::stepper::path_segment(c.trajectory, p.step, p.segment, body), p.at[0]);
             const Vector3 old = body == 0 ? c.results[0].witness.point_a : c.results[0].witness.point_b;
             const Vector3 other = body == 0 ? c.results[0].witness.point_b : c.results[0].witness.point_a;
             const Vector3 now = kinematics::world_position(pose, x.col(point.index));
             return std::abs((now - other).norm() - (old - other).norm()) > 1e-6 * p.upper;
         }},
        {"plane reversed",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             const auto normals = normals_of(proof, any_leaf(proof, r));
             const auto which = r() % 3;
             if (which != 1) normals.front() *= -1;
             if (which != 0 && (which == 1 || normals.size() > 1)) normals.back() *= -1;
             return true;
         }},
        {"plane without direction",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             const std::array<double, 4> values{0, std::nan(""), 1e300, std::numeric_limits<double>::infinity()};
             const double value = values[r() % 4];
             for (Vector3& n : normals_of(proof, any_leaf(proof, r))) n.setConstant(value);
             return true;
         }},
        {"plane missing",
         [](Case& c, std::mt19937& r) {
             auto& normals = any_proof(c, r).normals;
             normals.erase(normals.begin() + static_cast<long>(r() % normals.size()));
             return true;
         }},
        {"plane too many", [](Case& c, std::mt19937& r) { return any_proof(c, r).normals.push_back(Vector3::UnitX()), true; }},
        {"leaf missing",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             const LeafPlace leaf = any_leaf(proof, r);
             proof.splits.erase(leaf.at, 1);
             const auto first = proof.normals.begin() + static_cast<long>(leaf.first);
             proof.normals.erase(first, first + static_cast<long>(leaf.count));
             return true;
         }},
        {"leaf too many",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             proof.splits += '.';
             proof.normals.push_back(proof.normals.back());
             return true;
         }},
        {"leaf split for nothing",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             const auto at = proof.splits.find_first_of(".:");
             return proof.splits[at] = "0ab1x"[r() % 5], true;
         }},
        {"tree cut short",
         [](Case& c, std::mt19937& r) {
             BoxProof& proof = any_proof(c, r);
             return proof.splits.resize(r() % proof.splits.size()), true;
         }},
        {"segment missing",
         [](Case& c, std::mt19937& r) {
             auto& boxes = c.certificate.pairs[0].boxes;
             return boxes.erase(boxes.begin() + static_cast<long>(r() % boxes.size())), true;
         }},
        {"segment too many",
         [](Case& c, std::mt19937&) {
             auto& boxes = c.certificate.pairs[0].boxes;
             return boxes.push_back(boxes.back()), true;
         }},
        {"element missing",
         [](Case& c, std::mt19937& r) {
             auto& elements = c.certificate.bodies[r() % 2].elements;
             return elements[r() % elements.size()] = elements[0] == elements[1] ? -1 : elements[r() % 2 ? 0 : 1],
                                   c.certificate.bodies[0].elements.size() > 0 &&
                                       std::set<int>(elements.begin(), elements.end()).size() < elements.size();
         }},
        {"no such element",
         [](Case& c, std::mt19937& r) {
             auto& elements = c.certificate.bodies[r() % 2].elements;
             return elements[r() % elements.size()] = r() % 2 ? -5 : 1000000, true;
         }},
        {"cut wrong",
         [](Case& c, std::mt19937& r) {
             auto& cuts = c.certificate.bodies[r() % 2].cuts;
             const std::size_t i = r() % cuts.size();
             if (r() % 3 == 0) return cuts.erase(cuts.begin() + static_cast<long>(i)), true;
             return cuts[i] = r() % 2 ? 0 : 1000000, true;
         }},
        {"hash", [](Case& c, std::mt19937& r) { return c.certificate.geometry_hash ^= std::uint64_t{1} << (r() % 64), true; }},
        {"hash of the path", [](Case& c, std::mt19937& r) { return c.certificate.path_hash ^= std::uint64_t{1} << (r() % 64), true; }},
        {"no pair", [](Case& c, std::mt19937&) { return c.certificate.pairs.clear(), true; }},
        {"solids claimed otherwise",
         [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].solids = r() % 2 ? Solids::overlap : Solids::not_closed, true; }},
        {"disjoint without a bound",
         [](Case& c, std::mt19937&) {
             c.certificate.pairs[0].lower = 0;
             c.certificate.pairs[0].boxes.clear();
             return true;
         }},
        {"version",
         [](Case& c, std::mt19937& r) { return c.certificate.version = certificate_version + 1 + static_cast<int>(r() % 5), true; }},
        {"said to be over ranges of joints",
         [](Case& c, std::mt19937&) {
             c.certificate.linkage.emplace().bodies.resize(2);
             return true;
         }},
        {"witness of more coordinates", [](Case& c, std::mt19937&) { return c.certificate.pairs[0].at.push_back(0), true; }},
        {"witness without a coordinate", [](Case& c, std::mt19937&) { return c.certificate.pairs[0].at.clear(), true; }},
        {"other bodies",
         [](Case& c, std::mt19937& r) {
             return c.certificate.pairs[0].b = static_cast<int>(r() % 3) - 1 == 1 ? 2 : static_cast<int>(r() % 2) * -1, true;
         }},
        {"start only", [](Case& c, std::mt19937&) { return c.certificate.motion = false, true; }},
        {"body moved closer",
         [](Case& c, std::mt19937& r) {
             const PairCertificate& p = c.certificate.pairs[0];
             const double by = (p.upper - p.lower) * 1.01 + p.upper * std::pow(10, uniform(r, -6, 0));
             for (const int k : {p.segment, p.segment + 1}) c.trajectory.steps[p.step].nodes[k][1].position += by * from_b_to_a(c);
             return claim_is_false(c);
         }},
        {"body turned",
         [](Case& c, std::mt19937& r) {
             const PairCertificate& p = c.certificate.pairs[0];
             Matrix3& rotation = c.trajectory.poses[p.step][r() % 2].rotation;
             rotation = kinematics::rotation(random_vector(r, std::pow(10, uniform(r, -4, 0)))) * rotation;
             return claim_is_false(c);
         }},
        {"node moved",
         [](Case& c, std::mt19937& r) {
             const PairCertificate& p = c.certificate.pairs[0];
             auto& node = c.trajectory.steps[p.step].nodes[p.segment + static_cast<int>(r() % 2)][r() % 2];
             (r() % 2 ? node.position : node.rotation_vector) += random_vector(r, std::pow(10, uniform(r, -4, 0)));
             return claim_is_false(c);
         }},
        {"nodes swapped",
         [](Case& c, std::mt19937& r) {
             const PairCertificate& p = c.certificate.pairs[0];
             auto& nodes = c.trajectory.steps[p.step].nodes;
             const int body = static_cast<int>(r() % 2);
             if (r() % 2)
                 std::swap(nodes[p.segment][body], nodes[p.segment + 1][body]);
             else
                 std::swap(c.trajectory.steps[p.step], c.trajectory.steps[r() % c.trajectory.steps.size()]);
             return p.segment + 1 < count_of(c.trajectory.steps[p.step].nodes) && claim_is_false(c);
         }},
        {"vertex moved",
         [](Case& c, std::mt19937& r) {
             const int body = static_cast<int>(r() % 2);
             Matrix3X& x = c.model.bodies[body].mesh.vertices;
             x.col(static_cast<long>(r() % x.cols())) += random_vector(r, std::pow(10, uniform(r, -4, 0)) * c.results[0].upper * 4);
             c.certificate.geometry_hash = core::records::geometry_hash(c.model);  // or the hash alone would give it away
             return claim_is_false(c);
         }},
    };
    return list;
}

// Damages certificates `wanted` times; how many were rejected.
std::pair<int, int> damage_campaign(std::mt19937& random, int wanted, int per_case) {
    int made = 0, rejected = 0;
    std::vector<int> of_kind(damages().size(), 0);
    while (made < wanted) {
        const Case whole = random_case(random, uniform(random, 0.02, 2), 3, 1e-4);
        if (!(whole.results[0].lower > 0)) continue;
        const auto report = check_certificate(whole.certificate, whole.model, whole.trajectory);
        CAPTURE(made, report.accepted() ? "" : report.faults[0].where + ": " + report.faults[0].message);
        REQUIRE(report.accepted());
        for (int i = 0, tries = 0; i < per_case && made < wanted && tries < 20 * per_case; ++tries) {
            const std::size_t kind = random() % damages().size();
            Case damaged = whole;
            if (!damages()[kind].second(damaged, random)) continue;
            ++i;
            ++made;
            ++of_kind[kind];
            // Or the hash alone would give the changed path away.
            if (damaged.certificate.path_hash == whole.certificate.path_hash)
                damaged.certificate.path_hash = core::records::path_hash(damaged.trajectory);
            const bool found = !check_certificate(damaged.certificate, damaged.model, damaged.trajectory).accepted();
            CAPTURE(damages()[kind].first);
            if (!found) CHECK(found);
            rejected += found;
        }
    }
    for (std::size_t kind = 0; kind < of_kind.size(); ++kind) {
        CAPTURE(damages()[kind].first);
        if (wanted >= 1000) CHECK(of_kind[kind] > 0);
    }
    return {made, rejected};
}

}  // namespace

TEST_CASE("Pairs at fault are not looked at further, however many faults there are", "[clearance]") {
    std::mt19937 random(5);
    Case c = random_case(random, 1, 1, 1e-3);
    REQUIRE(check_certificate(c.certificate, c.model, c.trajectory).accepted());
    const PairCertificate good = c.certificate.pairs.at(0);
    PairCertificate bad = good;
    bad.a = 2'000'000'000;
    c.certificate.pairs.assign(1001, bad);
    c.certificate.pairs.push_back(good);
    CHECK(check_certificate(c.certificate, c.model, c.trajectory).faults.size() == 1000);
    PairCertificate nowhere = good;  // of a path that is none
    nowhere.lower = 0;
    nowhere.boxes.clear();
    c.certificate.pairs.assign(1001, nowhere);
    c.trajectory.steps.clear();
    c.trajectory.poses.resize(1);
    c.certificate.path_hash = core::records::path_hash(c.trajectory);
    CHECK(check_certificate(c.certificate, c.model, c.trajectory).faults.size() == 1000);
}

TEST_CASE("Certificates of random motions are accepted and damaged ones rejected", "[clearance]") {
    std::mt19937 random(1);
    const auto [made, rejected] = damage_campaign(random, 400, 40);
    CHECK(made == 400);
    CHECK(rejected == made);
}

TEST_CASE("Ten thousand damaged certificates: ten thousand rejected", "[clearance][slow]") {
    std::mt19937 random(2);
    const auto [made, rejected] = damage_campaign(random, 10000, 200);
    CHECK(made == 10000);
    CHECK(rejected == made);
}

}  // namespace fettle::core::certificate::certificate_damage_test
