// SPDX-License-Identifier: MIT
// Certificates over ranges of joints: ours are accepted, damaged ones rejected, every one; written and read back.
#include <functional>

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/range_bound.hpp"
#include "tests/core/clearance/random_trees.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::certificate::range_certificate_test {

using namespace fettle::tests::trees;
using namespace fettle::core::clearance;

namespace {

struct RangeCase {
    Tree tree;
    stepper::Trajectory start;
    Certificate certificate;
    PairClearance found;
    CertificateReport check() const { return check_certificate(certificate, tree.model, start); }
};

// A case of a random tree whose pair does not clash and has coordinates.
RangeCase certified_case(std::mt19937& random, int most_coordinates_of_it) {
    for (;;) {
        RangeCase c{random_tree(random), {}, {}, {}};
        const int count = pair_coordinates(c.tree);
        if (count < 1 || count > most_coordinates_of_it) continue;
        c.start = as_assembled(c.tree.model);
        ClearanceOptions options;
        const double size = c.tree.model.bodies[c.tree.b].radius;
        options.tolerance = (count <= 2 ? 1e-3 : 5e-2) * size;
        auto proven = certify_with_proof(c.tree.model, c.tree.ranges, {{c.tree.a, c.tree.b}}, options);
        c.found = proven.pairs.front();
        c.certificate = std::move(proven.certificate);
        if (c.found.lower > 0 && c.found.solids != Solids::overlap) return c;
    }
}

using Damage = std::function<bool(RangeCase&, std::mt19937&)>;

double uniform(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

// What the claim is about, moved: false if no sample shows a lesser distance.
bool claim_is_false(RangeCase& c, std::mt19937& random) {
    // The oracle goes by the scene; the certificate's own linkage decides here.
    const PairCertificate& pair = c.certificate.pairs[0];
    const LinkedPair linked = linked_pair(*c.certificate.linkage, pair.a, pair.b);
    const auto shape = [&](int body) {
        const model::Body& b = c.tree.model.bodies[body];
        return make_piece_tree(b.mesh, *b.hierarchy);
    };
    const PieceTree a = shape(pair.a), b = shape(pair.b);
    const ScrewedPair moved = screwed_pair(a, b, *c.certificate.linkage, linked, c.start.poses[0][pair.a], c.start.poses[0][pair.b]);
    for (int i = 0; i < 40; ++i) {
        Coordinates at{};
        for (std::size_t k = 0; k < linked.coordinates.size(); ++k) {
            at[k] = std::clamp(i == 0 ? pair.at[k] : uniform(random, moved.ranges.low[k], moved.ranges.high[k]), moved.ranges.low[k],
                               moved.ranges.high[k]);
        }
        const auto placed = [&](const ScrewedBody& body, const geometry::Mesh& mesh) {
            const kinematics::Pose pose = pose_of(body, at);
            return tests::clearance::RealVertices((pose.rotation.cast<Real>() * mesh.vertices.cast<Real>()).colwise() +
                                                  pose.position.cast<Real>());
        };
        if (tests::clearance::oracle_distance(*a.mesh, placed(moved.body_a, *a.mesh), *b.mesh, placed(moved.body_b, *b.mesh)) <
            pair.lower * (1 - 1e-9))
            return true;
    }
    return false;
}

const std::vector<std::pair<const char*, Damage>>& damages_of_claims() {
    static const std::vector<std::pair<const char*, Damage>> list{
        {"lower above upper",
         [](RangeCase& c, std::mt19937& r) {
             return c.certificate.pairs[0].lower = c.certificate.pairs[0].upper * (1 + uniform(r, 1e-9, 1)), true;
         }},
        {"both bounds raised",
         [](RangeCase& c, std::mt19937& r) {
             auto& p = c.certificate.pairs[0];
             p.lower = p.upper * (1 + uniform(r, 1e-6, 0.5));
             p.upper = p.lower * (1 + uniform(r, 0, 0.5));
             return true;
         }},
        {"upper lowered",
         [](RangeCase& c, std::mt19937& r) {
             auto& p = c.certificate.pairs[0];
             p.upper *= 1 - uniform(r, 1e-7, 1);
             p.lower = std::min(p.lower, p.upper);
             return true;
         }},
        {"upper not attained", [](RangeCase& c, std::mt19937& r) { return c.certificate.pairs[0].upper *= 1 + uniform(r, 1e-3, 1), true; }},
        {"bound not a number",
         [](RangeCase& c, std::mt19937& r) {
             return (r() % 2 ? c.certificate.pairs[0].lower : c.certificate.pairs[0].upper) = std::nan(""), true;
         }},
        {"witness beyond the ranges",
         [](RangeCase& c, std::mt19937& r) { return c.certificate.pairs[0].at[r() % c.certificate.pairs[0].at.size()] = 50, true; }},
        {"witness without a coordinate", [](RangeCase& c, std::mt19937&) { return c.certificate.pairs[0].at.pop_back(), true; }},
        {"witness of no primitive", [](RangeCase& c, std::mt19937&) { return c.certificate.pairs[0].point_a.index = 100000, true; }},
        {"hash", [](RangeCase& c, std::mt19937& r) { return c.certificate.geometry_hash ^= std::uint64_t{1} << (r() % 64), true; }},
        {"hash of the start",
         [](RangeCase& c, std::mt19937& r) { return c.certificate.path_hash ^= std::uint64_t{1} << (r() % 64), true; }},
        {"said to be over a path", [](RangeCase& c, std::mt19937&) { return c.certificate.motion = true, true; }},
        {"witness of no box",
         [](RangeCase& c, std::mt19937& r) {
             auto& p = c.certificate.pairs[0];
             return (r() % 2 ? p.step : p.segment) = 1, true;
         }},
        {"a proof too many",
         [](RangeCase& c, std::mt19937&) {
             auto& boxes = c.certificate.pairs[0].boxes;
             return boxes.push_back(boxes.front()), true;
         }},
        {"no pair", [](RangeCase& c, std::mt19937&) { return c.certificate.pairs.clear(), true; }},
        {"version", [](RangeCase& c, std::mt19937&) { return c.certificate.version = certificate_version - 1, true; }},
        {"solids claimed otherwise",
         [](RangeCase& c, std::mt19937& r) {
             return c.certificate.pairs[0].solids = r() % 2 ? Solids::overlap : Solids::not_closed, true;
         }},
        {"other bodies", [](RangeCase& c, std::mt19937& r) { return c.certificate.pairs[0].b = r() % 2 ? -1 : 50, true; }},
        {"element missing", [](RangeCase& c, std::mt19937&) { return c.certificate.bodies[c.tree.a].elements.pop_back(), true; }},
    };
    return list;
}

const std::vector<std::pair<const char*, Damage>>& damages_of_proofs() {
    static const std::vector<std::pair<const char*, Damage>> list{
        {"vector turned over",
         [](RangeCase& c, std::mt19937& r) {
             auto& n = c.certificate.pairs[0].boxes[0].normals;
             n[r() % n.size()] *= -1;
             return true;
         }},
        {"vector of no length",
         [](RangeCase& c, std::mt19937& r) {
             auto& n = c.certificate.pairs[0].boxes[0].normals;
             n[r() % n.size()] *= c.certificate.pairs[0].boxes[0].splits.find(':') == std::string::npos ? 0 : std::nan("");
             return true;
         }},
        {"vector missing", [](RangeCase& c, std::mt19937&) { return c.certificate.pairs[0].boxes[0].normals.pop_back(), true; }},
        {"vector too many",
         [](RangeCase& c, std::mt19937&) { return c.certificate.pairs[0].boxes[0].normals.push_back(Vector3::UnitX()), true; }},
        {"tree cut short",
         [](RangeCase& c, std::mt19937& r) {
             auto& splits = c.certificate.pairs[0].boxes[0].splits;
             return splits.resize(r() % splits.size()), true;
         }},
        {"leaf split for nothing",
         [](RangeCase& c, std::mt19937& r) {
             auto& splits = c.certificate.pairs[0].boxes[0].splits;
             return splits[splits.find_last_of(".:")] = "0ab9x"[r() % 5], true;
         }},
        {"leaf too many",
         [](RangeCase& c, std::mt19937&) {
             auto& proof = c.certificate.pairs[0].boxes[0];
             proof.splits += '.';
             return proof.normals.push_back(proof.normals.back()), true;
         }},
        {"a bound without a proof", [](RangeCase& c, std::mt19937&) { return c.certificate.pairs[0].boxes = {}, true; }},
        {"range wider",
         [](RangeCase& c, std::mt19937& r) {
             const LinkedPair linked = linked_pair(*c.certificate.linkage, c.tree.a, c.tree.b);
             auto& coordinate = c.certificate.linkage->coordinates[linked.coordinates[r() % linked.coordinates.size()]];
             (r() % 2 ? coordinate.high : coordinate.low) += r() % 2 ? 0.5 : -0.5;
             if (!(coordinate.low <= coordinate.start && coordinate.start <= coordinate.high)) return true;
             return claim_is_false(c, r);
         }},
        {"range not a number", [](RangeCase& c, std::mt19937&) { return c.certificate.linkage->coordinates[0].high = std::nan(""), true; }},
        {"screw moved",
         [](RangeCase& c, std::mt19937& r) {
             auto& screws = c.certificate.linkage->bodies[c.tree.b].screws;
             if (screws.empty()) return false;
             screws[0].point += tests::clearance::random_vector(r, std::pow(10, uniform(r, -3, 0)));
             return claim_is_false(c, r);
         }},
        {"screw turned about",
         [](RangeCase& c, std::mt19937& r) {
             auto& screws = c.certificate.linkage->bodies[c.tree.b].screws;
             if (screws.empty()) return false;
             screws[0].axis = tests::clearance::random_vector(r, 1);
             return claim_is_false(c, r);
         }},
        {"screw of no coordinate",
         [](RangeCase& c, std::mt19937& r) {
             auto& screws = c.certificate.linkage->bodies[c.tree.b].screws;
             if (screws.empty()) return false;
             return screws[0].coordinate = r() % 2 ? -1 : 77, true;
         }},
        {"axis too long",
         [](RangeCase& c, std::mt19937&) {
             auto& screws = c.certificate.linkage->bodies[c.tree.b].screws;
             if (screws.empty()) return false;
             return screws[0].axis *= 1.1, true;
         }},
        {"parents in a ring",
         [](RangeCase& c, std::mt19937&) {
             auto& bodies = c.certificate.linkage->bodies;
             return bodies[c.tree.b].parent = c.tree.b, true;
         }},
        {"body moved closer",
         [](RangeCase& c, std::mt19937& r) {
             const Vector3 way = c.found.witness.point_a - c.found.witness.point_b;
             auto& pose = c.start.poses[0][c.tree.a];
             pose.position -= uniform(r, 0.01, 2) * way;
             c.certificate.path_hash = records::path_hash(c.start);  // or the hash alone would give it away
             return claim_is_false(c, r);
         }},
    };
    return list;
}

void expect_rejected(int rounds, unsigned seed) {
    std::mt19937 random(seed);
    int rejected = 0;
    for (int i = 0; i < rounds; ++i) {
        const RangeCase sound = certified_case(random, 2);
        for (const auto* list : {&damages_of_claims(), &damages_of_proofs()})
            for (const auto& [name, damage] : *list) {
                RangeCase damaged = sound;
                if (!damage(damaged, random)) continue;
                INFO(name);
                CHECK(!damaged.check().accepted());
                ++rejected;
            }
    }
    CHECK(rejected > rounds * 25);
}

void expect_accepted(int rounds, unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < rounds; ++i) {
        const RangeCase c = certified_case(random, 4);
        const CertificateReport report = c.check();
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
        CHECK(report.leaves > 0);
    }
}

}  // namespace

TEST_CASE("range certificates: ours are accepted", "[ranges]") { expect_accepted(6, 3); }

TEST_CASE("range certificates: damaged ones are rejected", "[ranges]") { expect_rejected(2, 4); }

TEST_CASE("range certificates: written and read back, bit for bit", "[ranges]") {
    std::mt19937 random(8);
    const RangeCase c = certified_case(random, 2);
    const tests::support::TemporaryFolder folder;
    const std::string file = folder.file("fit.certificate.json");
    REQUIRE(write_certificate(file, c.certificate).empty());
    CHECK(is_certificate_file(file));
    const auto read = read_certificate(file);
    REQUIRE(read);
    CHECK(read->linkage == c.certificate.linkage);
    CHECK(read->pairs[0].lower == c.certificate.pairs[0].lower);
    CHECK(read->pairs[0].at == c.certificate.pairs[0].at);
    CHECK(read->pairs[0].boxes[0].splits == c.certificate.pairs[0].boxes[0].splits);
    // One of version 3 says the same of what it has.
    std::string text = tests::support::contents(file);
    const std::string version = "\"fettle_certificate\": ";
    const std::size_t at = text.find(version + "4");
    REQUIRE(at != std::string::npos);
    text[at + version.size()] = '3';
    const auto old = read_certificate(folder.write("old.certificate.json", text));
    REQUIRE(old);
    CHECK(old->version == certificate_version);
    CHECK(check_certificate(*old, c.tree.model, c.start).accepted());
    CHECK(read->pairs[0].boxes[0].normals == c.certificate.pairs[0].boxes[0].normals);
    CHECK(check_certificate(*read, c.tree.model, c.start).accepted());
}

TEST_CASE("range certificates: 100 of ours accepted, 1,000 damaged ones rejected", "[ranges][slow]") {
    expect_accepted(100, 31);
    expect_rejected(40, 41);
}

}  // namespace fettle::core::certificate::range_certificate_test
