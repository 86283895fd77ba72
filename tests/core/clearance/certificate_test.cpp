// SPDX-License-Identifier: MIT
// Certificates: every one of ours is accepted, also after a round through a file; every one that was made false or unproven is rejected.
#include "fettle/core/clearance/certificate.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <set>

#include "fettle/core/clearance/certificate_checker.hpp"
#include "fettle/core/clearance/certificate_thinning.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/interval_motion.hpp"
#include "fettle/tests/core/clearance/clearance_oracle.hpp"
#include "fettle/tests/support/temporary_folder.hpp"

using namespace fettle;
using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;
namespace kinematics = fettle::core::kinematics;

namespace {

struct Case {
    core::model::Model model;
    core::stepper::Trajectory trajectory;
    Certificate certificate;
    std::vector<PairClearance> results;
};

double uniform(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

// Two solids side by side, wandering and turning for a few steps of one or two segments.
Case random_case(std::mt19937& random, double size, int steps, double tolerance) {
    Case c;
    const std::array<Solid, 2> solids{random_solid(random, size), random_solid(random, size)};
    const double apart = solids[0].radius() + solids[1].radius() + size * uniform(random, 0.1, 0.5);
    c.trajectory.timestep = 0.1;
    c.trajectory.poses.resize(1);
    for (int b = 0; b < 2; ++b) {
        core::model::Body body;
        body.name = "body " + std::to_string(b);
        body.mesh = solids[b].mesh;
        body.hierarchy = solids[b].hierarchy;
        c.model.bodies.push_back(body);
        c.trajectory.body_names.push_back(body.name);
        c.trajectory.poses[0].push_back({kinematics::rotation(random_vector(random, 2)), Vector3(b * apart, 0, 0)});
    }
    for (int t = 0; t < steps; ++t) {
        core::stepper::TrajectoryStep step;
        const auto from = c.trajectory.poses.back();
        step.nodes.push_back({{from[0].position, Vector3::Zero()}, {from[1].position, Vector3::Zero()}});
        for (int k = 0, segments = 1 + static_cast<int>(random() % 2); k < segments; ++k) {
            auto next = step.nodes.back();
            for (int b = 0; b < 2; ++b) {
                next[b].position += random_vector(random, 0.1 * size * uniform(random, 0, 1));
                next[b].rotation_vector += random_vector(random, random() % 4 == 0 ? 0 : uniform(random, 0, 0.8));
            }
            step.nodes.push_back(next);
        }
        c.trajectory.poses.emplace_back();
        for (int b = 0; b < 2; ++b)
            c.trajectory.poses.back().push_back(
                {kinematics::rotation(step.nodes.back()[b].rotation_vector) * from[b].rotation, step.nodes.back()[b].position});
        c.trajectory.steps.push_back(step);
    }
    ClearanceOptions options;
    options.motion = true;
    options.tolerance = tolerance;
    options.certificate = &c.certificate;
    c.results = certify_clearance(c.model, c.trajectory, {{0, 1, 0}}, options);
    return c;
}

Real distance_at(const Case& c, int step, int segment, Real s) {
    const auto placed = [&](int b) {
        return oracle_vertices(core::stepper::path_segment(c.trajectory, step, segment, b), c.model.bodies[b].mesh.vertices, s);
    };
    return oracle_distance(c.model.bodies[0].mesh, placed(0), c.model.bodies[1].mesh, placed(1));
}

// A kind of damage. True: the claim is now false, or its proof is gone.
using Damage = std::function<bool(Case&, std::mt19937&)>;

SegmentProof& any_proof(Case& c, std::mt19937& random) {
    auto& segments = c.certificate.pairs[0].segments;
    return segments[random() % segments.size()];
}

// After moving what the certificate is about: false if the witness's instant shows less than the claimed bound.
bool claim_is_false(const Case& c) {
    const PairCertificate& pair = c.certificate.pairs[0];
    return distance_at(c, pair.step, pair.segment, pair.s) < pair.lower * (1 - 1e-9);
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
             p.s = uniform(r, 0, 1);
             // A false claim only if the same points are elsewhere then; the least distance of the bodies tells on one side.
             return distance_at(c, p.step, p.segment, p.s) > p.upper * (1 + 1e-6);
         }},
        {"witness outside of time", [](Case& c, std::mt19937& r) { return c.certificate.pairs[0].s = (r() % 2 ? 1.5 : -0.5), true; }},
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
             const auto pose = kinematics::pose_at(core::stepper::path_segment(c.trajectory, p.step, p.segment, body), p.s);
             const Vector3 old = body == 0 ? c.results[0].witness.point_a : c.results[0].witness.point_b;
             const Vector3 other = body == 0 ? c.results[0].witness.point_b : c.results[0].witness.point_a;
             const Vector3 now = kinematics::world_position(pose, x.col(point.index));
             return std::abs((now - other).norm() - (old - other).norm()) > 1e-6 * p.upper;
         }},
        {"plane reversed",
         [](Case& c, std::mt19937& r) {
             auto& planes = any_proof(c, r).planes;
             LeafPlane& plane = planes[r() % planes.size()];
             const auto which = r() % 3;
             if (which != 1) plane.n0 = -plane.n0;
             if (which != 0) plane.n1 = -plane.n1;
             return true;
         }},
        {"plane without direction",
         [](Case& c, std::mt19937& r) {
             auto& planes = any_proof(c, r).planes;
             LeafPlane& plane = planes[r() % planes.size()];
             const std::array<double, 4> values{0, std::nan(""), 1e300, std::numeric_limits<double>::infinity()};
             plane.n0 = plane.n1 = Vector3::Constant(values[r() % 4]);
             return true;
         }},
        {"plane missing",
         [](Case& c, std::mt19937& r) {
             auto& planes = any_proof(c, r).planes;
             planes.erase(planes.begin() + static_cast<long>(r() % planes.size()));
             return true;
         }},
        {"plane too many",
         [](Case& c, std::mt19937& r) {
             return any_proof(c, r).planes.push_back({Vector3::UnitX(), Vector3::UnitX()}), true;
         }},
        {"leaf missing",
         [](Case& c, std::mt19937& r) {
             SegmentProof& proof = any_proof(c, r);
             const std::size_t leaf = r() % proof.planes.size();
             std::size_t at = 0;
             for (std::size_t seen = 0; at < proof.splits.size(); ++at)
                 if (proof.splits[at] == '.' && seen++ == leaf) break;
             proof.splits.erase(at, 1);
             proof.planes.erase(proof.planes.begin() + static_cast<long>(leaf));
             return true;
         }},
        {"leaf too many",
         [](Case& c, std::mt19937& r) {
             SegmentProof& proof = any_proof(c, r);
             proof.splits += '.';
             proof.planes.push_back(proof.planes.back());
             return true;
         }},
        {"leaf split for nothing",
         [](Case& c, std::mt19937& r) {
             SegmentProof& proof = any_proof(c, r);
             const auto at = proof.splits.find('.');
             return proof.splits[at] = "tabx"[r() % 4], true;
         }},
        {"tree cut short",
         [](Case& c, std::mt19937& r) {
             SegmentProof& proof = any_proof(c, r);
             return proof.splits.resize(r() % proof.splits.size()), true;
         }},
        {"segment missing",
         [](Case& c, std::mt19937& r) {
             auto& segments = c.certificate.pairs[0].segments;
             return segments.erase(segments.begin() + static_cast<long>(r() % segments.size())), true;
         }},
        {"segment too many",
         [](Case& c, std::mt19937&) {
             auto& segments = c.certificate.pairs[0].segments;
             return segments.push_back(segments.back()), true;
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
        {"version", [](Case& c, std::mt19937& r) { return c.certificate.version = 2 + static_cast<int>(r() % 5), true; }},
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
             return p.segment + 1 < static_cast<int>(c.trajectory.steps[p.step].nodes.size()) && claim_is_false(c);
         }},
        {"vertex moved",
         [](Case& c, std::mt19937& r) {
             const int body = static_cast<int>(r() % 2);
             Matrix3X& x = c.model.bodies[body].mesh.vertices;
             x.col(static_cast<long>(r() % x.cols())) += random_vector(r, std::pow(10, uniform(r, -4, 0)) * c.results[0].upper * 4);
             c.certificate.geometry_hash = core::stepper::geometry_hash(c.model);  // or the hash alone would give it away
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
    for (SegmentProof& segment : c.certificate.pairs[0].segments)  // some leaves whose plane turns, and others
        for (std::size_t k = 0; k < segment.planes.size(); k += 2) segment.planes[k].n1 *= 1 - 1e-15;
    const tests::support::TemporaryFolder folder;
    const std::string path = folder.file("a.certificate.json");
    REQUIRE(write_certificate(path, c.certificate).empty());
    CHECK(is_certificate_file(path));
    const auto read = read_certificate(path);
    REQUIRE(read);
    CHECK(read->geometry_hash == c.certificate.geometry_hash);
    CHECK(read->motion == c.certificate.motion);
    const PairCertificate &x = read->pairs.at(0), &y = c.certificate.pairs.at(0);
    CHECK((x.lower == y.lower && x.upper == y.upper && x.s == y.s && x.point_a.weight == y.point_a.weight &&
           x.point_b.index == y.point_b.index));
    REQUIRE(x.segments.size() == y.segments.size());
    for (std::size_t i = 0; i < x.segments.size(); ++i) {
        CHECK(x.segments[i].splits == y.segments[i].splits);
        REQUIRE(x.segments[i].planes.size() == y.segments[i].planes.size());
        for (std::size_t k = 0; k < x.segments[i].planes.size(); ++k)
            CHECK((x.segments[i].planes[k].n0 == y.segments[i].planes[k].n0 && x.segments[i].planes[k].n1 == y.segments[i].planes[k].n1));
    }
    CHECK(check_certificate(*read, c.model, c.trajectory).accepted());
}

TEST_CASE("Thinning takes back needless splits, and nothing that it cannot prove", "[clearance]") {
    std::mt19937 random(6);
    std::size_t before = 0, after = 0;
    for (int i = 0; i < 10; ++i) {
        Case c = proven_case(random);
        PairCertificate& pair = c.certificate.pairs[0];
        const auto a = checker::certified_body(c.certificate.bodies[0], c.model.bodies[0].mesh);
        const auto b = checker::certified_body(c.certificate.bodies[1], c.model.bodies[1].mesh);
        REQUIRE((a && b));
        std::size_t index = 0;
        for (int t = 0; t < static_cast<int>(c.trajectory.steps.size()); ++t) {
            for (int k = 0; k < core::stepper::segment_count(c.trajectory, t); ++k) {
                SegmentProof& proof = pair.segments[index++];
                SegmentProof wasteful;
                std::size_t leaf = 0;
                for (const char kind : proof.splits) {
                    wasteful.splits += kind == '.' ? "tt..t.." : std::string(1, kind);
                    if (kind != '.') continue;
                    const LeafPlane plane = proof.planes[leaf++];
                    const Vector3 turn = 0.25 * (plane.n1 - plane.n0);
                    for (int part = 0; part < 4; ++part) wasteful.planes.push_back({plane.n0 + part * turn, plane.n0 + (part + 1) * turn});
                }
                CAPTURE(i, t, k);
                const SegmentProof same = thinned(wasteful, pair, *a, *b, c.trajectory, t, k, 100);
                CHECK((same.splits == wasteful.splits && same.planes[0].n0 == wasteful.planes[0].n0));
                const SegmentProof thin = thinned(wasteful, pair, *a, *b, c.trajectory, t, k, 0);
                before += wasteful.planes.size();
                after += thin.planes.size();
                proof = thin;
            }
        }
        CHECK(check_certificate(c.certificate, c.model, c.trajectory).accepted());
    }
    CAPTURE(before, after);
    CHECK(2 * after < before);  // four to one, but where the checker itself has to halve a leaf
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
        const auto path_a = checker::body_path(trajectory, 0, 0, 0), path_b = checker::body_path(trajectory, 0, 0, 1);
        const auto cloud = [&](std::size_t count) {
            std::vector<Vector3> points(count);
            for (Vector3& x : points) x = random_vector(random, size * uniform(random, 0.3, 1));
            return points;
        };
        const auto points_a = cloud(trial % 2 ? 3 : 200), points_b = cloud(trial % 4 < 2 ? 3 : 250);
        const auto region = [&](const std::vector<Vector3>& points) {
            checker::Region r{points, points[0], points[0], 1.001 * size};
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
        checker::LeafProver prover(path_a, path_b);
        CHECK(prover.prove(a, b, {s0, s0 + h}, plane, bound + 1e-12 * size, 6) == 0);
        const double claim = static_cast<double>(least_unscaled) / n_max;
        CHECK(prover.prove(a, b, {s0, s0 + h}, plane, claim - 1e-11 * size, 24) > 0);  // what is true with a little room is proven
    }
}
