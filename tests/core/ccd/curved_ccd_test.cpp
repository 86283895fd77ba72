// SPDX-License-Identifier: MIT
// Oracle: paths built so that they touch at a known time, dense sampling, and motions with a closed form.
#include "core/ccd/curved_ccd.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/geometry/distance.hpp"

namespace fettle::core::ccd::curved_ccd_test {

using fettle::core::kinematics::PathSegment;
using fettle::core::kinematics::Pose;

namespace {

struct Query {
    geometry::PairType type = geometry::PairType::point_triangle;
    PathSegment a, b;
    geometry::PairVertices X;
};

geometry::PairVertices vertices_at(const Query& q, double s) {
    const Pose a = pose_at(q.a, s), b = pose_at(q.b, s);
    geometry::PairVertices x;
    const std::size_t first_count = q.type == geometry::PairType::point_triangle ? 1 : 2;
    for (std::size_t i = 0; i < 4; ++i) x[i] = world_position(i < first_count ? a : b, q.X[i]);
    return x;
}

core::geometry::ClosestPoints closest_at(const Query& q, double s) {
    const geometry::PairVertices x = vertices_at(q, s);
    return q.type == geometry::PairType::point_triangle ? core::geometry::point_triangle_closest(x[0], x[1], x[2], x[3])
                                                        : core::geometry::edge_edge_closest(x[0], x[1], x[2], x[3]);
}
double distance_at(const Query& q, double s) { return std::sqrt(closest_at(q, s).distance_squared); }

class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed) {}
    double uniform() { return std::uniform_real_distribution<double>()(random_); }
    Vector3 vector() {
        std::normal_distribution<double> n;
        return {n(random_), n(random_), n(random_)};
    }
    Query query() {
        Query q;
        q.type = uniform() < 0.5 ? geometry::PairType::point_triangle : geometry::PairType::edge_edge;
        for (PathSegment* p : {&q.a, &q.b}) {
            p->base = core::kinematics::rotation(vector());
            if (uniform() < 0.5) p->rotation_vector_t0 = 3 * vector();
            p->rotation_vector_step = vector() * std::pow(10.0, 3 * uniform() - 3);
            p->position_t0 = vector();
            p->position_step = vector() * std::pow(10.0, 2 * uniform() - 2);
        }
        for (Vector3& x : q.X) x = vector();
        return q;
    }
    /// Its closest points meet (to rounding) at s, unless they met before.
    Query touching(double s) {
        Query q = query();
        q.a.position_t0 -= closest_at(q, s).difference;
        return q;
    }

private:
    std::mt19937_64 random_;
};

CurvedCcdOptions with(DeviationBound bound) {
    CurvedCcdOptions options;
    options.deviation = bound;
    return options;
}

/// Samples of the path that come within dmin before what was proven to be clear.
int contradictions(const Query& q, double dmin, const CurvedCcdResult& r) {
    int n = 0;
    for (int k = 0; k <= 200; ++k) {
        const double s = k / 200.0;
        // Sampled in doubles: what is off by rounding is no contradiction.
        if (s < r.toi || !r.hit) n += distance_at(q, s) < dmin - 1e-13;
    }
    return n;
}

}  // namespace

TEST_CASE("curved CCD finds paths that touch, not late and not much too early") {
    Generator generator(1);
    int missed = 0, late = 0, wrong = 0, far = 0, hits = 0;
    for (int i = 0; i < 1500; ++i) {
        const double touch = generator.uniform(), dmin = i % 3 == 0 ? 0.01 : 0;
        const Query q = generator.touching(touch);
        if (distance_at(q, 0) <= dmin + 1e-9) continue;
        ++hits;
        const CurvedCcdResult r = curved_ccd(q.type, q.a, q.b, q.X, dmin);
        missed += !r.hit;
        late += r.toi > touch;
        wrong += contradictions(q, dmin, r);
        far += distance_at(q, r.toi) > dmin + 1.001e-6;
        CHECK(r.toi > 0);
    }
    CHECK(hits > 1000);
    CHECK(missed == 0);
    CHECK(late == 0);
    CHECK(wrong == 0);
    CHECK(far == 0);
}

TEST_CASE("curved CCD never contradicts samples, by either bound") {
    Generator generator(2);
    int wrong = 0, disagree = 0, hits = 0;
    for (int i = 0; i < 400; ++i) {
        const Query q = i % 2 ? generator.query() : generator.touching(generator.uniform());
        const double dmin = i % 3 == 0 ? 0.02 : 0;
        const CurvedCcdResult closed = curved_ccd(q.type, q.a, q.b, q.X, dmin);
        const CurvedCcdResult interval = curved_ccd(q.type, q.a, q.b, q.X, dmin, with(DeviationBound::interval));
        for (const CurvedCcdResult& r : {closed, interval}) wrong += contradictions(q, dmin, r);
        disagree += closed.hit != interval.hit;
        hits += closed.hit;
    }
    CHECK(hits > 50);
    CHECK(wrong == 0);
    CHECK(disagree < 8);  // the interval bound may run out of pieces
}

TEST_CASE("curved CCD of a turning arm meets a closed form") {
    // A point at radius 1 turns about z by 2 rad; the triangle lies in the plane y = sin(1).
    Query q;
    q.a.rotation_vector_step = Vector3(0, 0, 2);
    q.X = {Vector3(1, 0, 0), Vector3(-9, std::sin(1.0), -9), Vector3(9, std::sin(1.0), -9), Vector3(0, std::sin(1.0), 9)};
    const CurvedCcdResult r = curved_ccd(q.type, q.a, q.b, q.X, 0);
    CHECK(r.hit);
    CHECK(r.toi <= 0.5);
    CHECK(r.toi == Approx(0.5).epsilon(2e-6));
    // The chord would stay clear of a plane that the arc grazes: height 1 reached at a quarter turn only.
    for (const double height : {1 - 1e-9, 1 + 1e-5}) {
        for (std::size_t i = 1; i < 4; ++i) q.X[i].y() = height;
        CHECK(curved_ccd(q.type, q.a, q.b, q.X, 0).hit == (height < 1));
        CHECK(curved_ccd(q.type, q.a, q.b, q.X, 2e-5).hit);
    }
}

TEST_CASE("curved CCD does not see where the origin is") {
    Generator generator(3);
    for (int i = 0; i < 100; ++i) {
        Query q = i % 2 ? generator.query() : generator.touching(generator.uniform());
        for (PathSegment* p : {&q.a, &q.b}) {  // offsets below keep these exact
            p->position_t0 = (p->position_t0 * 0x1p20).array().round() * 0x1p-20;
        }
        const CurvedCcdResult here = curved_ccd(q.type, q.a, q.b, q.X, 0);
        for (PathSegment* p : {&q.a, &q.b}) p->position_t0 += Vector3(0x1p30, -0x1p31, 0x1p29);
        const CurvedCcdResult there = curved_ccd(q.type, q.a, q.b, q.X, 0);
        CHECK(here.hit == there.hit);
        CHECK(here.toi == there.toi);
    }
}

TEST_CASE("curved CCD stays conservative past its limits") {
    Query q;
    q.a.rotation_vector_step = Vector3(0, 0, 4e5);
    q.X = {Vector3(1, 0, 0), Vector3(-1, 1 + 1e-4, -1), Vector3(1, 1 + 1e-4, -1), Vector3(0, 1 + 1e-4, 1)};
    CurvedCcdOptions options;
    const CurvedCcdResult r = curved_ccd(q.type, q.a, q.b, q.X, 0, options);
    CHECK(r.hit);  // not true, but not provable in 1024 pieces
    CHECK(r.toi > 0);
    CHECK(r.toi < 1);
    options.max_pieces = 0;
    CHECK(curved_ccd(q.type, q.a, q.b, q.X, 0, options).toi == 0);
    // A circle that never gets there is proven clear without pieces.
    for (std::size_t i = 1; i < 4; ++i) q.X[i].y() = 5;
    q.a.rotation_vector_step.z() = 3;
    CHECK_FALSE(curved_ccd(q.type, q.a, q.b, q.X, 0, options).hit);
    CHECK_THROWS(curved_ccd(q.type, q.a, q.b, q.X, -1e-3));
}

TEST_CASE("curved CCD at rest or touching at the start") {
    Query q;
    q.X = {Vector3(0.2, 0.2, 1e-7), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    CHECK_FALSE(curved_ccd(q.type, q.a, q.b, q.X, 0).hit);
    CHECK_FALSE(curved_ccd(q.type, q.a, q.b, q.X, 0.9e-7).hit);
    CHECK(curved_ccd(q.type, q.a, q.b, q.X, 1.1e-7).hit);
    CHECK(curved_ccd(q.type, q.a, q.b, q.X, 1.1e-7).toi == 0);
    q.a.position_step = Vector3(0, 0, -1);
    const CurvedCcdResult r = curved_ccd(q.type, q.a, q.b, q.X, 0);
    CHECK(r.hit);
    CHECK(r.toi > 0.85e-7);
    CHECK(r.toi < 1e-7);
    q.a.position_step = Vector3(0, 0, 1);
    CHECK_FALSE(curved_ccd(q.type, q.a, q.b, q.X, 0).hit);
}

}  // namespace fettle::core::ccd::curved_ccd_test
