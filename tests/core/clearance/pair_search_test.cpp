// SPDX-License-Identifier: MIT
#include "core/clearance/pair_search.hpp"

#include <catch2/catch.hpp>

#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::core::clearance::pair_search_test {

using namespace fettle::tests::clearance;
using core::clearance::search_pair;
using core::clearance::SearchOptions;
using core::clearance::SearchResult;

namespace {

/// What is wrong with a result, in metres; all three are at most 0 for a certificate that holds.
struct Audit {
    double lower_above_sample = 0;  ///< lower minus the least sampled distance
    double upper_not_attained = 0;  ///< |upper - distance at the witness instant| minus what rounding may do
    double gap_too_wide = 0;        ///< upper - lower - tolerance
    double sampled = 0;
};

Audit audit(const MovingPair& pair, const SearchResult& result, double tolerance, int samples) {
    Audit audit;
    const Real at_witness = pair.distance_at(result.nearest.s);
    const Real sampled = std::min(sampled_minimum(pair, samples, 6), at_witness);
    audit.sampled = static_cast<double>(sampled);
    audit.lower_above_sample = static_cast<double>(result.lower - sampled);
    audit.upper_not_attained = static_cast<double>(std::abs(result.upper - at_witness)) - 2 * pair.segment().slack;
    // The true distance at the witness must not be above `upper` at all.
    audit.upper_not_attained = std::max(audit.upper_not_attained, static_cast<double>(at_witness - result.upper));
    audit.gap_too_wide = result.upper - result.lower - tolerance - 8 * pair.segment().slack;
    return audit;
}

struct Campaign {
    int pairs = 0, apart = 0, lower_wrong = 0, upper_wrong = 0, too_wide = 0;
};

struct Family {
    double size, turn;
    Vector3 origin;
    double relative_tolerance;
};

Campaign run(const Family& family, int pairs, int samples, unsigned seed) {
    std::mt19937 random(seed);
    Campaign campaign;
    for (int i = 0; i < pairs; ++i) {
        const MovingPair pair = random_pair(random, family.size, family.turn, family.origin);
        const double tolerance = family.relative_tolerance * family.size;
        SearchOptions options;
        options.tolerance = tolerance;
        const SearchResult result = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, options);
        ++campaign.pairs;
        if (result.upper <= 4 * pair.segment().slack) continue;  // they intersect: lower is 0
        const Audit a = audit(pair, result, tolerance, samples);
        ++campaign.apart;
        campaign.lower_wrong += a.lower_above_sample > 0;
        campaign.upper_wrong += a.upper_not_attained > 0;
        campaign.too_wide += a.gap_too_wide > 0;
    }
    return campaign;
}

const std::vector<Family> families{
    {1, 1, Vector3::Zero(), 1e-6},
    {1, 12, Vector3::Zero(), 1e-6},             // rotation vectors of several pi
    {1e-3, 2, Vector3::Zero(), 1e-6},           // parts of a millimetre, to a nanometre
    {0.02, 1, Vector3(300, -800, 1500), 1e-4},  // far from the origin
    {1e-3, 0.01, Vector3(1e5, 1e5, 0), 1e-9},   // rounding is larger than the tolerance
    {0.05, 0.03, Vector3(0.1, 0.2, 0), 2e-5},   // a time step of a crank
};

}  // namespace

TEST_CASE("Bounds of random moving solids hold against dense sampling in extended precision", "[clearance]") {
    unsigned seed = 1;
    for (const Family& family : families) {
        const Campaign c = run(family, 12, 150, seed++);
        CAPTURE(family.size, family.turn, family.origin.transpose());
        CHECK(c.apart >= 4);
        CHECK(c.lower_wrong == 0);
        CHECK(c.upper_wrong == 0);
        CHECK(c.too_wide == 0);
    }
}

TEST_CASE("Bounds of many random moving solids hold against denser sampling", "[clearance][slow]") {
    unsigned seed = 100;
    for (const Family& family : families) {
        const Campaign c = run(family, 150, 1000, seed++);
        CAPTURE(family.size, family.turn, family.origin.transpose());
        CHECK(c.apart >= 40);
        CHECK(c.lower_wrong == 0);
        CHECK(c.upper_wrong == 0);
        CHECK(c.too_wide == 0);
    }
}

TEST_CASE("A proof of enough ends where it is one, or with the least distance, whatever the order", "[clearance]") {
    std::mt19937 random(11);
    int proven = 0, measured = 0, cut_short = 0;
    for (int i = 0; i < 40; ++i) {
        const MovingPair pair = random_pair(random, 1, 1, Vector3::Zero());
        const std::vector<PairSegment> segments(i % 2 == 0 ? 1 : 20, pair.segment());  // more than one are searched together first
        SearchOptions options;
        const SearchResult least = search_pair(pair.a.search(), pair.b.search(), segments, options);
        if (least.upper <= 0.01) continue;
        for (const double share : {0.3, 0.99, 1.01, 3.0}) {
            options.enough = share * least.upper;
            const SearchResult found = search_pair(pair.a.search(), pair.b.search(), segments, options);
            CAPTURE(i, share, least.lower, least.upper, found.lower, found.upper);
            CHECK(found.complete);
            CHECK(found.lower <= least.upper);
            CHECK(found.upper >= least.lower);
            if (share < 1) {
                ++proven;
                CHECK(found.lower >= options.enough);
            } else {
                ++measured;
                CHECK(found.upper - found.lower <= options.tolerance + 8 * pair.segment().slack);
            }
            SearchOptions poor = options;
            for (poor.max_evaluations = 1; poor.max_evaluations < std::min(found.evaluations, 60L); ++poor.max_evaluations) {
                const SearchResult part = search_pair(pair.a.search(), pair.b.search(), segments, poor);
                cut_short += part.complete ? 0 : 1;
                CHECK((part.lower <= least.upper && part.upper >= least.lower));
            }
        }
    }
    CHECK((proven >= 20 && measured >= 20 && cut_short >= 1000));
}

TEST_CASE("A proof of enough that is cut short tells no more than holds for what is left", "[clearance]") {
    MovingPair pair{box({1, 1, 1}), box({1, 1, 1}), {}, {}};  // from 4 m apart to 0.5 m
    pair.path_b.position_t0 << 6, 0.1, 0.2;
    pair.path_b.position_step << -3.5, 0, 0;
    for (const int copies : {1, 20}) {
        const std::vector<PairSegment> segments(copies, pair.segment());
        SearchOptions options;
        options.enough = 3;
        for (options.max_evaluations = 1; options.max_evaluations < 40; ++options.max_evaluations) {
            const SearchResult part = search_pair(pair.a.search(), pair.b.search(), segments, options);
            CAPTURE(copies, options.max_evaluations, part.lower, part.upper);
            CHECK(part.lower <= 0.5 + 1e-9);
            CHECK(part.upper >= 0.5 - 1e-9);
        }
    }
}

TEST_CASE("A bound without the rest beside the parabola is found out", "[clearance]") {
    // A lever's tip swings past a wall, nearest away from the places that the parabola goes through.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(0.2, 1);
    int wrong_without = 0, wrong = 0;
    for (int i = 0; i < 10; ++i) {
        MovingPair pair{box({1, 0.02, 0.05 * u(random)}), box({0.1, 2, 2}), {}, {}};
        const double turn = u(random);
        pair.path_a.rotation_vector_t0 << 0, 0, -0.3 * turn;
        pair.path_a.rotation_vector_step << 0, 0, 2 * turn;
        pair.path_b.position_t0 << 1.2 + 0.1 * u(random), 0, 0;
        // Along the wall's normal the whole swing is one cubic: that of the parabolas through the corners' places, and no more.
        const PairSegment segment = pair.segment();
        const Vector3 n(-1 + 1e-15, 0, 0);
        const MovingPlane plane = moving_plane(instant_at(segment, 0), instant_at(segment, 0.5), instant_at(segment, 1), n, n);
        const ReachPair reach{{pair.a.radius(), segment.a->speed * pair.a.radius() * (1 + 1e-12)}, {pair.b.radius(), 0}};
        double with_rest = std::numeric_limits<double>::infinity(), without = with_rest;
        for (const Vector3& tip : pair.a.mesh.vertices.colwise()) {
            Coefficients c{};
            for (std::size_t k = 0; k < c.size(); ++k)
                c[k] = plane.offset[k] + plane.a[k].dot(tip) - (plane.b[k].transpose() * pair.b.mesh.vertices).maxCoeff();
            with_rest = std::min(with_rest, segment_bound(segment, 1, plane, c, reach).lower);
            without = std::min(without, segment_bound(segment, 1, plane, c, {}).lower);  // as if no point turned
        }
        const Real sampled = sampled_minimum(pair, 100, 6);
        wrong_without += without > sampled;
        wrong += with_rest > sampled;
    }
    CHECK(wrong_without >= 5);
    CHECK(wrong == 0);
}

TEST_CASE("Near-parallel faces: bounds hold and the gap closes", "[clearance]") {
    for (const double tilt : {0.0, 1e-9, 1e-5, 1e-2}) {
        for (const double gap : {3e-4, 1e-6}) {
            MovingPair pair{box({0.02, 0.03, 0.005}), box({0.01, 0.01, 0.01}), {}, {}};
            pair.path_b.position_t0 << 0.004, -0.01, 0.015 + gap + 0.02 * tilt;
            pair.path_b.position_step << 0.003, 0.02, 0;
            pair.path_b.rotation_vector_step << tilt, -0.3 * tilt, 0.2;
            SearchOptions options;
            options.tolerance = 1e-8;
            const SearchResult result = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, options);
            const Audit a = audit(pair, result, options.tolerance, 200);
            CAPTURE(tilt, gap, result.lower, result.upper, result.evaluations);
            CHECK(a.lower_above_sample <= 0);
            CHECK(a.upper_not_attained <= 0);
            CHECK(a.gap_too_wide <= 0);
        }
    }
}

TEST_CASE("A pin turning in a bore", "[clearance]") {
    MovingPair pair{prism(24, 0.005, 0.02), ring(24, 0.0055, 0.01, 0.012), {}, {}};
    pair.path_a.rotation_vector_step << 0, 0, 2 * M_PI / 24;
    pair.path_a.position_t0 << 1e-4, 0, 0;
    pair.path_a.position_step << 0, 1e-4, 0;
    SearchOptions options;
    options.tolerance = 1e-6;
    const SearchResult result = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, options);
    const Audit a = audit(pair, result, options.tolerance, 30);
    CAPTURE(result.lower, result.upper, a.sampled, result.evaluations);
    CHECK(a.lower_above_sample <= 0);
    CHECK(a.upper_not_attained <= 0);
    CHECK(a.gap_too_wide <= 0);
    CHECK(result.evaluations < 300'000);
}

TEST_CASE("The cost grows like the logarithm of 1/tolerance", "[clearance]") {
    std::mt19937 random(5);
    int counted = 0;
    for (int i = 0; i < 20; ++i) {
        const MovingPair pair = random_pair(random, 1, 1, Vector3::Zero());
        std::vector<long> cost;
        double distance = 0;
        for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
            SearchOptions options;
            options.tolerance = tolerance;
            const SearchResult result = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, options);
            cost.push_back(result.evaluations);
            distance = result.upper;
        }
        if (distance < 0.01) continue;
        ++counted;
        CAPTURE(i, distance, cost[0], cost[1], cost[2], cost[3]);
        CHECK(cost[2] - cost[1] <= 2 * (cost[1] - cost[0]) + 200);
        CHECK(cost[3] - cost[2] <= 2 * (cost[1] - cost[0]) + 200);
    }
    CHECK(counted >= 8);
}

TEST_CASE("Solids that intersect are at distance 0", "[clearance]") {
    MovingPair pair{box({1, 1, 1}), box({0.2, 0.2, 3}), {}, {}};  // no edge of a near one of b: the rod pierces the faces
    pair.path_b.position_t0 << 0.1, 0.15, 0.3;
    const SearchResult held = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, {});
    CHECK(held.lower == 0);
    CHECK(held.upper < 1e-12);
    pair.path_b.position_t0 << 3, 0.15, 0.3;
    pair.path_b.position_step << -6, 0, 0;
    const SearchResult passing = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, {});
    CHECK(passing.lower == 0);
    CHECK(passing.upper <= 1e-6);
}

TEST_CASE("Out of budget: the bounds are true, only wide", "[clearance]") {
    std::mt19937 random(11);
    for (int i = 0; i < 10; ++i) {
        const MovingPair pair = random_pair(random, 1, 3, Vector3::Zero());
        for (const long budget : {1L, 10L, 100L}) {
            SearchOptions options;
            options.max_evaluations = budget;
            const SearchResult result = search_pair(pair.a.search(), pair.b.search(), {pair.segment()}, options);
            CHECK(result.lower <= static_cast<double>(sampled_minimum(pair, 100, 5)));
            CHECK(result.upper + 1e-15 >= result.lower);
            CHECK(std::isfinite(result.upper));
            CHECK(result.evaluations < budget + 12);  // the split that was begun is finished: two leaves of two triangles, three directions
        }
    }
}

TEST_CASE("Many segments: those far away cost one bound each", "[clearance]") {
    const Solid a = box({1, 1, 1}), b = box({0.5, 0.5, 0.5});
    std::vector<core::clearance::PairSegment> segments;
    for (int i = 0; i < 1000; ++i) {
        core::kinematics::PathSegment still, moving;
        moving.position_t0 << 3 + 0.1 * std::abs(i - 700), 0.2, 0.1;
        moving.position_step << (i < 700 ? -0.1 : 0.1), 0, 0;
        moving.rotation_vector_step << 0, 0, 0.01;
        segments.push_back(core::clearance::pair_segment(still, moving, a.radius(), b.radius()));
        segments.back().step = i;
    }
    const SearchResult result = search_pair(a.search(), b.search(), segments, {});
    CHECK(result.upper - result.lower <= 1e-6);
    CHECK((result.nearest.segment == 699 || result.nearest.segment == 700));
    CHECK(result.evaluations < 1500);
}

TEST_CASE("Bodies beside each other need no search of all pairs of their parts", "[clearance]") {
    const Solid a = ring(200, 0.01, 0.012, 0.004), b = ring(200, 0.01, 0.012, 0.004);
    std::vector<core::clearance::PairSegment> segments;
    for (int i = 0; i < 60; ++i) {  // round facets that are nearly as near as each other, at every instant
        core::kinematics::PathSegment still, rolling;
        rolling.position_t0 << 0.03, 1e-4 * i, 1e-3;
        rolling.position_step << 0, 1e-4, 0;
        rolling.base = core::kinematics::rotation(Vector3(0, 0, 0.01 * i));
        rolling.rotation_vector_step << 0, 0, 0.01;
        segments.push_back(core::clearance::pair_segment(still, rolling, a.radius(), b.radius()));
        segments.back().step = i;
    }
    SearchOptions options;
    options.tolerance = 1e-8;
    const SearchResult result = search_pair(a.search(), b.search(), segments, options);
    CHECK(result.upper - result.lower <= 1e-8);
    CHECK(result.upper == Approx(0.006).margin(2e-6));
    CAPTURE(result.evaluations);
    CHECK(result.evaluations < 3000);
}

TEST_CASE("What rests before a gap whose hull is closed costs no more the longer it does", "[clearance]") {
    const Solid prong = prism(60, 0.5, 0.5), pin = prism(60, 0.3, 0.5);
    Matrix3X x(3, 2 * prong.mesh.vertices.cols());
    std::vector<geometry::Triangle> triangles = prong.mesh.triangles;
    const auto count = static_cast<int>(prong.mesh.vertices.cols());
    x << prong.mesh.vertices.colwise() - Vector3(2, 0, 0), prong.mesh.vertices.colwise() + Vector3(2, 0, 0);
    for (const geometry::Triangle& t : prong.mesh.triangles) triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    const Solid fork = make_solid(x, triangles);
    const auto evaluations = [&](int steps, double distance) {
        std::vector<core::clearance::PairSegment> segments;
        for (int i = 0; i < steps; ++i) {
            core::kinematics::PathSegment still, resting;
            resting.position_t0 = Vector3(0, 0.5 + 0.3 + distance, 0);
            segments.push_back(core::clearance::pair_segment(still, resting, fork.radius(), pin.radius()));
            segments.back().step = i;
        }
        SearchOptions options;
        options.tolerance = 1e-6;
        const SearchResult result = search_pair(fork.search(), pin.search(), segments, options);
        CHECK(result.upper - result.lower <= 1e-6);
        CHECK(result.upper == Approx(std::hypot(2, 0.8 + distance) - 0.8).epsilon(0.01));
        return result.evaluations;
    };
    for (const double distance : {0.01, 0.2}) CHECK(evaluations(3375, distance) < 4 * evaluations(15, distance) + 2000);
}

}  // namespace fettle::core::clearance::pair_search_test
