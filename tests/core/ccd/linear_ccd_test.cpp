// SPDX-License-Identifier: MIT
// Oracle: exact rational arithmetic (tests/support/exact_ccd.hpp). A false negative or a toi too late is a bug, whatever the input.
#include "core/ccd/linear_ccd.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/exact_ccd.hpp"
#include "tests/support/inclusion_ccd.hpp"

namespace fettle::core::ccd::linear_ccd_test {

using fettle::tests::exact_distance_at_most;
using fettle::tests::exact_linear_contact;
using fettle::tests::exact_linear_contact_by_algebra;

namespace {

struct Query {
    geometry::PairType type = geometry::PairType::point_triangle;
    geometry::PairVertices t0, t1;
};

struct Tally {
    long hits = 0, false_negatives = 0, false_positives = 0, early_zero = 0, late = 0;
};

LinearCcdResult by_inclusion(const Query& q, double dmin = 0, double tolerance = 1e-6) {
    return fettle::tests::support::inclusion_ccd(q.type, q.t0, q.t1, dmin, {tolerance, 2000});
}

class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed) {}
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    Vector3 point(int range) { return Vector3(integer(-range, range), integer(-range, range), integer(-range, range)); }
    geometry::PairType type() { return integer(0, 1) == 0 ? geometry::PairType::point_triangle : geometry::PairType::edge_edge; }
    Query grid(int range) {
        Query q{type(), {}, {}};
        for (Vector3& x : q.t0) x = point(range);
        for (Vector3& x : q.t1) x = point(range);
        return q;
    }
    /// On the integer grid, with whatever makes trouble: coplanar, parallel, coincident vertices, no motion, common motion, touching at an
    /// end.
    Query degenerate(int range) {
        Query q = grid(range);
        const int axis = integer(0, 2);
        switch (integer(0, 7)) {
            case 0:
                for (std::size_t i = 0; i < 4; ++i) q.t0[i][axis] = q.t1[i][axis] = 0;
                break;
            case 1:
                q.t1 = q.t0;
                break;
            case 2:
                for (std::size_t i = 0; i < 4; ++i) q.t1[i] = q.t0[i] + Vector3(1, -2, axis);
                break;
            case 3:
                q.t0[3] = q.t0[2];
                q.t1[3] = q.t1[2];
                break;
            case 4:
                q.t0[3] = q.t0[2] + integer(-2, 2) * (q.t0[1] - q.t0[0]);
                q.t1[3] = q.t1[2] + integer(-2, 2) * (q.t1[1] - q.t1[0]);
                break;
            case 5:
                for (std::size_t i = 0; i < 4; ++i) {
                    q.t0[i] = (i % 2 ? 1 : 0) * q.t0[i][0] * Vector3(1, 1, 1);
                    q.t1[i] = q.t1[i][axis] * Vector3(1, 1, 1);
                }
                break;
            case 6:
                q.t0[0] = q.t0[integer(1, 3)];
                break;
            default:
                q.t1[0] = q.t1[3];
                q.t1[2] = q.t0[2];
                break;
        }
        return q;
    }

    double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    Vector3 vector() { return {uniform(), uniform(), uniform()}; }
    /// Coordinates of sizes from 1e-6 to 1e6 in one query; slivers, nearly parallel edges, nearly zero lengths; built to meet, all but
    /// rounding, at a random time and place.
    Query nearly_degenerate() {
        Query q{type(), {}, {}};
        const auto size = [&] { return std::pow(10.0, 6 * uniform()); };
        for (geometry::PairVertices* x : {&q.t0, &q.t1}) {
            const double whole = size();
            for (Vector3& v : *x) v = (integer(0, 3) == 0 ? size() : whole) * vector();
            const double thin = std::pow(10.0, -9 + 7 * uniform());
            switch (integer(0, 3)) {
                case 0:  // the last vertex nearly on the line of the two before it, or the edges nearly parallel
                    (*x)[3] = (*x)[2] + uniform() * ((*x)[1] - (*x)[0]) + thin * (*x)[3];
                    if (q.type == geometry::PairType::point_triangle) (*x)[3] = (*x)[2] + uniform() * ((*x)[2] - (*x)[1]) + thin * (*x)[3];
                    break;
                case 1:  // an edge of nearly no length
                    (*x)[3] = (*x)[2] + thin * (*x)[3];
                    break;
                case 2:  // nearly flat
                    for (Vector3& v : *x) v.z() *= thin;
                    break;
                default:
                    break;
            }
        }
        const double t = 0.5 + 0.5 * uniform(), u = 0.5 + 0.5 * uniform(), v = (1 - u) * (0.5 + 0.5 * uniform());
        const auto at = [&](std::size_t i) -> Vector3 { return q.t0[i] + t * (q.t1[i] - q.t0[i]); };
        const bool face = q.type == geometry::PairType::point_triangle;
        const Vector3 first = face ? at(0) : Vector3(at(0) + u * (at(1) - at(0)));
        const Vector3 second = face ? Vector3(at(1) + u * (at(2) - at(1)) + v * (at(3) - at(1))) : Vector3(at(2) + v * (at(3) - at(2)));
        for (std::size_t i = 0; i < (face ? 1u : 2u); ++i) {
            q.t0[i] += second - first;
            q.t1[i] += second - first;
        }
        return q;
    }

private:
    std::mt19937_64 random_;
};

Query transformed(Query q, double scale, const Vector3& offset) {
    for (geometry::PairVertices* x : {&q.t0, &q.t1})
        for (Vector3& v : *x) v = scale * (v + offset);
    return q;
}

void count(const Query& q, bool truth, const LinearCcdResult& r, Tally& tally) {
    tally.hits += truth;
    tally.false_negatives += truth && !r.hit;
    tally.false_positives += !truth && r.hit;
    if (!r.hit) return;
    if (r.toi == 0) {
        tally.early_zero += !exact_distance_at_most(q.type, q.t0, q.t1, 0, 0);
        return;
    }
    for (const double share : {0.25, 0.5, 0.9, 1 - 0x1p-50}) tally.late += exact_distance_at_most(q.type, q.t0, q.t1, share * r.toi, 0);
}

/// Advancement decides exactly on the grid; inclusion never misses.
void check_random(int queries, bool degenerate, unsigned seed) {
    Generator generator(seed);
    Tally a, b;
    for (int i = 0; i < queries; ++i) {
        const int range = 1 + i % 8;
        const Query q = degenerate ? generator.degenerate(range) : generator.grid(range);
        const bool truth = exact_linear_contact(q.type, q.t0, q.t1);
        count(q, truth, linear_ccd(q.type, q.t0, q.t1, 0), a);
        count(q, truth, by_inclusion(q, 0, 1e-3), b);
    }
    CAPTURE(queries, degenerate);
    CHECK(a.hits > queries / 20);
    CHECK(a.false_negatives == 0);
    CHECK(a.false_positives == 0);
    CHECK(a.early_zero == 0);
    CHECK(a.late == 0);
    CHECK(b.false_negatives == 0);
    CHECK(b.early_zero == 0);
    CHECK(b.late == 0);
    CHECK(b.false_positives < queries / 10);  // it does decide
}

/// All come within rounding of contact, many touch.
void check_slivers(int queries, unsigned seed) {
    Generator generator(seed);
    Tally a, b;
    for (int i = 0; i < queries; ++i) {
        const Query q = generator.nearly_degenerate();
        const bool truth = exact_linear_contact(q.type, q.t0, q.t1);
        count(q, truth, linear_ccd(q.type, q.t0, q.t1, 0), a);
        if (i % 3 == 0) count(q, truth, by_inclusion(q), b);
    }
    CHECK(a.hits > queries / 5);
    CHECK(a.false_positives + a.hits > queries - queries / 15);
    CHECK(a.false_negatives == 0);
    CHECK(a.late == 0);
    CHECK(b.false_negatives == 0);
    CHECK(b.late == 0);
}

}  // namespace

TEST_CASE("the exact oracle knows simple cases") {
    const geometry::PairVertices above{Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    geometry::PairVertices below = above;
    below[0].z() = -1;
    CHECK(exact_linear_contact(geometry::PairType::point_triangle, above, below));
    CHECK_FALSE(exact_linear_contact(geometry::PairType::point_triangle, above, above));
    below[0].x() = 2;  // crosses the plane at x = 1.125: beside the triangle
    CHECK_FALSE(exact_linear_contact(geometry::PairType::point_triangle, above, below));
    CHECK(exact_distance_at_most(geometry::PairType::point_triangle, above, above, 0.5, 1));
    CHECK_FALSE(exact_distance_at_most(geometry::PairType::point_triangle, above, above, 0.5, 1 - 1e-15));
    const geometry::PairVertices crossed{Vector3(-1, 0, 1), Vector3(1, 0, 1), Vector3(0, -1, 0), Vector3(0, 1, 0)};
    geometry::PairVertices through = crossed;
    through[0].z() = through[1].z() = -1;
    CHECK(exact_linear_contact(geometry::PairType::edge_edge, crossed, through));
    CHECK_FALSE(exact_linear_contact(geometry::PairType::edge_edge, crossed, crossed));
}

TEST_CASE("the exact oracle's filter and its algebra agree") {
    Generator generator(5);
    int different = 0, hits = 0;
    for (int i = 0; i < 1500; ++i) {
        const Query q = i % 2 ? generator.degenerate(1 + i % 8) : generator.grid(1 + i % 8);
        const bool truth = exact_linear_contact_by_algebra(q.type, q.t0, q.t1);
        hits += truth;
        different += exact_linear_contact(q.type, q.t0, q.t1) != truth;
        // Integers of another type, same contact.
        const Query far = transformed(q, 0x1p-40, Vector3(0x1p20, -0x1p30, 5));
        different += exact_linear_contact(far.type, far.t0, far.t1) != truth;
    }
    CHECK(hits > 300);
    CHECK(hits < 1200);
    CHECK(different == 0);
}

TEST_CASE("linear CCD decides random integer queries as exact arithmetic does") { check_random(1200, false, 11); }
TEST_CASE("linear CCD decides degenerate integer queries as exact arithmetic does") { check_random(1200, true, 12); }
TEST_CASE("linear CCD against exact truth: a million random queries", "[slow]") { check_random(1'000'000, false, 13); }
TEST_CASE("linear CCD against exact truth: a hundred thousand degenerate queries", "[slow]") { check_random(100'000, true, 14); }

TEST_CASE("linear CCD is the same at any scale and far from the origin") {
    Generator generator(21);
    long changed = 0;
    Tally tally;
    for (int i = 0; i < 600; ++i) {
        const Query q = i % 2 ? generator.grid(6) : generator.degenerate(6);
        const bool truth = exact_linear_contact(q.type, q.t0, q.t1);
        for (const double scale : {0x1p-20, 0x1p-10, 1.0, 0x1p20}) {
            // Offsets that keep every coordinate an exact double: the truth does not change.
            for (const double far : {0.0, 0x1p20, -0x1p40}) {
                const Query moved = transformed(q, scale, Vector3(far, -far, far / 2));
                const LinearCcdResult r = linear_ccd(moved.type, moved.t0, moved.t1, 0, {1e-9 * scale});
                tally.false_negatives += truth && !r.hit;
                changed += truth != r.hit;
                if (i % 3 == 0) tally.false_negatives += truth && !by_inclusion(moved, 0, 1e-3 * scale).hit;
            }
        }
    }
    CHECK(tally.false_negatives == 0);
    CHECK(changed == 0);
}

TEST_CASE("linear CCD never misses slivers, near-parallel edges and sizes from 1e-6 to 1e6 in one query") { check_slivers(1500, 25); }
TEST_CASE("linear CCD against exact truth: thirty thousand slivers and near-parallel edges", "[slow]") { check_slivers(30'000, 26); }

TEST_CASE("linear CCD survives motion of 1e8 times the size") {
    Generator generator(31);
    Tally tally;
    for (int i = 0; i < 400; ++i) {
        Query q = generator.grid(4);
        const Vector3 stride = 1e8 * generator.point(2);
        const std::size_t movers = q.type == geometry::PairType::point_triangle ? 1 : 2;
        // Through the other primitive, roughly half way.
        for (std::size_t j = 0; j < movers; ++j) {
            q.t0[j] -= stride;
            q.t1[j] += stride;
        }
        const bool truth = exact_linear_contact(q.type, q.t0, q.t1);
        count(q, truth, linear_ccd(q.type, q.t0, q.t1, 0), tally);
        count(q, truth, by_inclusion(q), tally);
    }
    CHECK(tally.hits > 20);
    CHECK(tally.false_negatives == 0);
    CHECK(tally.late == 0);
}

TEST_CASE("linear CCD with a minimum separation never reports it late") {
    Generator generator(41);
    long late = 0, loose = 0, missed = 0, hits = 0;
    for (int i = 0; i < 1500; ++i) {
        const Query q = i % 3 ? generator.grid(5) : generator.degenerate(5);
        const double dmin = std::ldexp(1.0, -generator.integer(1, 24));
        for (const bool advancing : {true, false}) {
            if (!advancing && i % 5 != 0) continue;
            const LinearCcdResult r = advancing ? linear_ccd(q.type, q.t0, q.t1, dmin) : by_inclusion(q, dmin);
            hits += r.hit;
            // What is proven to be clear: exact distances at samples, the end of the proven time included.
            for (int k = 0; k < 8; ++k) {
                const double t = r.toi * (k == 7 ? 1 - 0x1p-50 : k / 8.0);
                if (t < r.toi || !r.hit) (r.hit ? late : missed) += exact_distance_at_most(q.type, q.t0, q.t1, t, dmin);
            }
            // What is reported is as close as the tolerance says.
            if (advancing && r.hit)
                loose += !exact_distance_at_most(q.type, q.t0, q.t1, r.toi, dmin + LinearCcdOptions().tolerance * 1.0001);
        }
    }
    CHECK(hits > 100);
    CHECK(late == 0);
    CHECK(missed == 0);
    CHECK(loose == 0);
}

TEST_CASE("toi is positive when the primitives start apart, and the motion up to it is clear") {
    const geometry::PairVertices t0{Vector3(0.25, 0.25, 1e-9), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    geometry::PairVertices t1 = t0;
    t1[0].z() = -1;
    const LinearCcdResult r = linear_ccd(geometry::PairType::point_triangle, t0, t1, 0);
    CHECK(r.hit);
    CHECK(r.toi > 0.8e-9);
    CHECK(r.toi < 1e-9);
    // Starting closer than dmin is a hit at once.
    CHECK(linear_ccd(geometry::PairType::point_triangle, t0, t1, 1e-8).toi == 0);
    // At rest nearer than the tolerance is no hit: nothing comes closer.
    CHECK_FALSE(linear_ccd(geometry::PairType::point_triangle, t0, t0, 0).hit);
    CHECK_FALSE(linear_ccd(geometry::PairType::point_triangle, t0, t0, 0.9e-9).hit);
}

TEST_CASE("linear CCD treats what is not a number as a hit") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const geometry::PairVertices t0{Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    for (const double bad : {nan, infinity, -infinity, 1e200, -1e308}) {
        for (int k = 0; k < 3; ++k) {
            geometry::PairVertices t1 = t0;
            t1[0][k] = bad;
            if (std::isnan(bad)) {
                CHECK(linear_ccd(geometry::PairType::point_triangle, t0, t1, 0).hit);
                CHECK(by_inclusion({geometry::PairType::point_triangle, t0, t1}).hit);
            }
            CHECK(linear_ccd(geometry::PairType::point_triangle, t1, t0, 0).toi <= 1);
        }
    }
    CHECK_THROWS(linear_ccd(geometry::PairType::point_triangle, t0, t0, -1));
}

TEST_CASE("distance_lower_bound is below the exact distance and close to it") {
    Generator generator(51);
    long above = 0, loose = 0;
    for (int i = 0; i < 2000; ++i) {
        const Query q = i % 2 ? generator.grid(7) : generator.degenerate(7);
        const double bound = distance_lower_bound(q.type, q.t0);
        above += bound > 0 && exact_distance_at_most(q.type, q.t0, q.t0, 0, std::nextafter(bound, 0));
        loose += !exact_distance_at_most(q.type, q.t0, q.t0, 0, bound + 1e-13);
    }
    CHECK(above == 0);
    CHECK(loose == 0);
}

}  // namespace fettle::core::ccd::linear_ccd_test
