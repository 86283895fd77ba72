// SPDX-License-Identifier: MIT
// The longest safe step against exact distances along the path: nothing comes within dmin on [0, fraction], and what stops the step is
// near.
#include "core/ccd/safe_step.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/contact/contact_set.hpp"
#include "tests/support/exact_ccd.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::ccd::safe_step_test {

using namespace fettle::tests::support;
using kinematics::PathSegment;
using kinematics::Pose;

namespace {

geometry::Mesh wire(const Vector3& from, const Vector3& to) {
    geometry::Mesh mesh;
    mesh.name = "wire";
    mesh.vertices.resize(3, 2);
    mesh.vertices << from, to;
    geometry::build_connectivity(mesh, {{0, 1}});
    return mesh;
}

model::Model model_of(const std::vector<geometry::Mesh>& meshes, double dhat = 1e-3, double dmin = 0) {
    model::Model model;
    model.dhat = dhat;
    model.dmin = dmin;
    for (const geometry::Mesh& mesh : meshes) {
        model.bodies.push_back(make_body("body", mesh, {}, scene::BodyType::dynamic_body));
    }
    return model;
}

PathSegment segment(const Vector3& position, const Vector3& step, const Vector3& turn = Vector3::Zero(),
                    const Matrix3& base = Matrix3::Identity()) {
    return {base, Vector3::Zero(), turn, position, step};
}

SafeStep step_of(const model::Model& model, const std::vector<PathSegment>& segments) {
    Candidates candidates;
    cover(model, segments, model.dhat, candidates);
    const SafeStep step = longest_safe_step(model, candidates, segments);
    std::vector<Pose> start;
    for (const PathSegment& s : segments) start.push_back(pose_at(s, 0));
    const contact::ContactSet contacts = contact::find_contacts(model, candidates, start);
    const SafeStep known =
        longest_safe_step(model, candidates, segments, &contacts.distances);  // what is known at the start changes nothing
    CHECK(known.fraction == step.fraction);
    CHECK(known.limiting_a == step.limiting_a);
    CHECK(known.limiting_b == step.limiting_b);
    return step;
}

/// Vertices of a pair of edges at s, by a path of its own: long enough expressions in extended precision, rounded once.
geometry::PairVertices edges_at(const model::Model& model, const std::vector<PathSegment>& segments, int edge_a, int edge_b, double s) {
    geometry::PairVertices x;
    for (int k = 0; k < 4; ++k) {
        const int body = k / 2;
        const geometry::Edge& e = model.bodies[body].mesh.edges[body == 0 ? edge_a : edge_b];
        x[k] = world_position(pose_at(segments[body], s), model.bodies[body].mesh.vertices.col(e[k % 2]));
    }
    return x;
}

/// Does any pair of edges of the two bodies come within `distance` at one of the samples of [0, until]?
bool comes_within(const model::Model& model, const std::vector<PathSegment>& segments, double until, double distance, int samples) {
    for (int i = 0; i <= samples; ++i)
        for (std::size_t a = 0; a < model.bodies[0].mesh.edges.size(); ++a)
            for (std::size_t b = 0; b < model.bodies[1].mesh.edges.size(); ++b) {
                const geometry::PairVertices x = edges_at(model, segments, static_cast<int>(a), static_cast<int>(b), until * i / samples);
                if (tests::exact_distance_at_most(geometry::PairType::edge_edge, x, x, 0, distance)) return true;
            }
    return false;
}

}  // namespace

TEST_CASE("two boxes that approach keep a tenth of their gap, or a quarter of dhat") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    for (const double gap : {0.5, 1e-3, 1e-6, 1e-9})
        for (const double dmin : {0.0, 1e-2}) {
            const model::Model model = model_of({box, box}, 1e-3, dmin);
            const double travel = 2;
            const SafeStep step = step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment({1 + dmin + gap, 0.1, 0.2}, {-travel, 0, 0})});
            const double left = gap - travel * step.fraction, kept = std::min(0.1 * gap, 0.25e-3);
            INFO("gap " << gap << " dmin " << dmin);
            CHECK(step.limiting_a == 0);
            CHECK(step.limiting_b == 1);
            CHECK(left > 0.999 * kept - 1e-14);
            CHECK(left < kept + 0.11 * gap + 1e-14);  // a hit is told within a tenth of what is left to lose
        }
}

TEST_CASE("what separates, slides past or travels together is free") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const model::Model model = model_of({box, box});
    const Vector3 away(1.0005, 0.1, 0.2);  // more than what a pair that comes near has to keep
    for (const Vector3& step : {Vector3(1, 0, 0), Vector3(0, 3, 1), Vector3(0, 0, 0)}) {
        const SafeStep safe = step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment(away, step)});
        CHECK(safe.fraction == 1);
        CHECK(safe.limiting_a == -1);
    }
    CHECK(step_of(model, {segment({0, 0, 0}, {5, 7, 1}), segment(away, {5, 7, 1})}).fraction == 1);
}

TEST_CASE("bodies in contact at the start do not move towards one another") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const model::Model model = model_of({box, box});
    CHECK(step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment({1, 0, 0}, {-1, 0, 0})}).fraction == 0);
    CHECK(step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment({0.7, 0, 0}, {-1, 0, 0})}).fraction == 0);
}

TEST_CASE("bodies whose distance at the start is known are free as long as they cannot lose it") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const model::Model model = model_of({box, box});
    const double gap = 0.6e-3, kept = 0.06e-3;
    for (const double share : {0.0, 0.5, 0.99, 0.9999999, 1.0000001, 1.01, 2.0})
        for (const Vector3& place : {Vector3(0, 0, 0), Vector3(30, -20, 10)}) {
            const double travel = share * (gap - kept);
            const SafeStep step = step_of(model, {segment(place, {0, 0, 0}), segment(place + Vector3(1 + gap, 0.1, 0.2), {-travel, 0, 0})});
            INFO("share " << share);
            CHECK((step.fraction == 1) == (share < 1));
        }
    // One that turns: corners go farther than the middle.
    const SafeStep turning = step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment({1 + gap, 0.1, 0.2}, {0, 0, 0}, {0, 0, 4e-3})});
    CHECK(turning.fraction < 1);
}

TEST_CASE("bodies of one group do not stop one another") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    model::Model model = model_of({box, box});
    model.bodies[0].group = model.bodies[1].group = 3;
    CHECK(step_of(model, {segment({0, 0, 0}, {0, 0, 0}), segment({1.1, 0, 0}, {-3, 0, 0})}).fraction == 1);
}

TEST_CASE("wires that slide along their own line stop end to end") {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 300; ++i) {
        const Matrix3 base =
            Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
        const Vector3 along = base.col(0), sideways = std::pow(10.0, -17 - 3 * uniform(random)) * base.col(1);
        model::Model model = model_of({wire({-0.5, 0, 0}, {0.5, 0, 0}), wire({-0.5, 0, 0}, {0.5, 0, 0})});
        const double gap = std::pow(10.0, -6 * uniform(random)), travel = (0.5 + uniform(random)) * (gap + 1);
        const std::vector<PathSegment> segments{segment({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, base),
                                                segment((1 + gap) * along + sideways, -travel * along, {0, 0, 0}, base)};
        const SafeStep step = step_of(model, segments);
        INFO("wire " << i << ", gap " << gap << ", travel " << travel);
        REQUIRE(travel * step.fraction < gap);
        REQUIRE(!comes_within(model, segments, step.fraction, 0, 20));
        Candidates candidates;
        cover(model, segments, model.dhat, candidates);
        REQUIRE(is_path_clear(model, candidates, segments) == (travel < gap));
    }
}

TEST_CASE("no pair of edges comes within dmin on the safe part of random paths") {
    std::mt19937_64 random(12);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
    int stopped = 0;
    for (int i = 0; i < 60; ++i) {
        const double dmin = i % 2 ? 0.02 : 0;
        const model::Model model =
            model_of({box_mesh({-0.3, -0.2, -0.1}, {0.3, 0.2, 0.1}), wire(0.5 * vector(), 0.5 * vector())}, 1e-2, dmin);
        const Vector3 start = 1.2 * vector().normalized();
        const std::vector<PathSegment> segments{segment({0, 0, 0}, 0.3 * vector(), 0.7 * vector()),
                                                segment(start, -2 * start + 0.3 * vector(), 0.7 * vector())};
        if (comes_within(model, segments, 0, dmin, 1)) continue;
        const SafeStep step = step_of(model, segments);
        REQUIRE(!comes_within(model, segments, step.fraction, dmin, 60));
        stopped += step.fraction < 1;
        // The obstacle is near there: the wire comes within a little more than what is kept, which is at most dmin + dhat / 4 and a tenth.
        if (step.fraction < 1) REQUIRE(step.limiting_a + step.limiting_b == 1);
    }
    CHECK(stopped > 15);
}

TEST_CASE("the search for pairs and the longest safe step end when that is asked for, whichever thread works on them") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const model::Model model = model_of({box, box, box});
    const std::vector<PathSegment> segments{segment({0, 0, 0}, {0, 0, 0}), segment({1.01, 0.1, 0.2}, {-0.5, 0, 0}, {0.1, 0.2, 0.3}),
                                            segment({-1.01, 0.1, 0.2}, {0.5, 0, 0}, {0.3, 0.1, 0.2})};
    for (const int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        Candidates candidates;
        cover(model, segments, model.dhat, candidates);
        REQUIRE(longest_safe_step(model, candidates, segments).fraction < 1);
        std::atomic<int> asked = 0;
        // Asked for at the k-th time of asking, until there are no more: it ends there.
        const auto times = [&](const auto& work) {
            for (int k = 0;; ++k) {
                asked = 0;
                const base::StopScope scope([&, k] { return asked++ >= k; });
                try {
                    work();
                    return k;
                } catch (const base::Stopped&) {
                }
            }
        };
        // More often than there are pieces of loops: within bodies, within pairs of primitives.
        CHECK(times([&] {
                  Candidates fresh;
                  cover(model, segments, model.dhat, fresh);
              }) > 2 * 3);
        CHECK(times([&] { longest_safe_step(model, candidates, segments); }) > 20);
    }
    const auto ccd = [&] {
        const geometry::PairVertices X{Vector3(0.5, 0, 0), Vector3(-0.5, -1, -1), Vector3(-0.5, 1, -1), Vector3(-0.5, 0, 1)};
        return curved_ccd(geometry::PairType::point_triangle, segments[0], segments[1], X, 0);
    };
    CHECK(ccd().hit);
    const base::StopScope scope([] { return true; });
    CHECK_THROWS_AS(ccd(), base::Stopped);
}

TEST_CASE("a path that is not finite is not safe") {
    const geometry::Mesh box = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    const model::Model model = model_of({box, box});
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200})
        for (int k = 0; k < 9; ++k) {
            std::vector<PathSegment> segments{segment({0, 0, 0}, {0, 0, 0}), segment({3, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0})};
            (k < 3 ? segments[1].position_t0 : k < 6 ? segments[1].position_step : segments[1].rotation_vector_step)[k % 3] = bad;
            if (bad == 1e200 && k < 6) continue;  // far away, or far off: true
            Candidates candidates;
            cover(model, segments, model.dhat, candidates);
            REQUIRE(candidates.pairs.size() == 1);
            INFO("value " << bad << " at " << k);
            CHECK(longest_safe_step(model, candidates, segments).fraction == 0);
            CHECK(!is_path_clear(model, candidates, segments));
        }
}

}  // namespace fettle::core::ccd::safe_step_test
