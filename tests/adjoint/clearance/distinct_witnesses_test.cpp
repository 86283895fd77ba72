// SPDX-License-Identifier: MIT
#include "adjoint/clearance/distinct_witnesses.hpp"

#include <catch2/catch.hpp>

#include "adjoint/clearance/tied_features.hpp"
#include "core/geometry/distance.hpp"
#include "tests/adjoint/clearance/clearance_cases.hpp"

namespace fettle::adjoint::clearance::distinct_witnesses_test {

using namespace fettle::tests::clearance_cases;
using core::clearance::Witness;

namespace {

core::model::Body sized_body(const Solid& solid) {
    core::model::Body body = make_body(solid);
    body.radius = solid.radius();
    return body;
}

// The distance of the two features named, at the instant named, whatever else comes near.
double own_distance(const Case& c, const Witness& w) {
    const auto trajectory = c.trajectory();
    const auto corners = [&](int body, core::clearance::Primitive kind, int index) {
        const core::geometry::Mesh& mesh = c.model.bodies[body].mesh;
        const Pose pose = pose_at(trajectory, w.step, w.segment, w.s, body);
        std::vector<Vector3> x;
        const auto add = [&](int v) { x.push_back(pose.rotation * mesh.vertices.col(v) + pose.position); };
        if (kind == core::clearance::Primitive::vertex) add(index);
        if (kind == core::clearance::Primitive::edge)
            for (const int v : mesh.edges[index]) add(v);
        if (kind == core::clearance::Primitive::triangle)
            for (const int v : mesh.triangles[index]) add(v);
        return x;
    };
    const auto a = corners(0, w.kind_a, w.primitive_a), b = corners(1, w.kind_b, w.primitive_b);
    if (w.edge_edge) return std::sqrt(core::geometry::edge_edge_distance_squared(a[0], a[1], b[0], b[1]));
    const auto &point = w.vertex_on_a ? a : b, &face = w.vertex_on_a ? b : a;
    return std::sqrt(core::geometry::point_triangle_distance_squared(point[0], face[0], face[1], face[2]));
}

// Each witness is as it says, and its derivative is that of its own features' distance.
void check_witnesses(const Case& c, const PairClearance& pair, const std::vector<Witness>& witnesses) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const Witness& w : witnesses) {
        CAPTURE(w.step, w.segment, w.s, w.primitive_a, w.primitive_b, w.edge_edge, w.distance);
        CHECK(own_distance(c, w) == Approx(w.distance).epsilon(1e-12));
        CHECK((w.point_a - w.point_b).norm() == Approx(w.distance).epsilon(1e-12));
        CHECK(w.distance >= pair.lower);
        PairClearance of_witness = pair;
        of_witness.witness = w;
        const VectorX gradient = gradient_of(c, of_witness, 1);
        for (int k = 0; k < 3; ++k) {
            VectorX v(coordinate_count(c));
            for (double& x : v) x = normal(random);
            const double h = 1e-6, difference = (own_distance(moved(c, h * v), w) - own_distance(moved(c, -h * v), w)) / (2 * h);
            CHECK(gradient.dot(v) == Approx(difference).epsilon(1e-6).margin(1e-7));
        }
    }
}

}  // namespace

TEST_CASE("Parallel faces: their extreme corners are the distinct witnesses", "[clearance][adjoint]") {
    Case c;
    c.model.bodies = {sized_body(box({1, 1, 1})), sized_body(box({0.5, 0.4, 0.45}))};
    c.poses = {{Pose{}, Pose{core::kinematics::rotation({0, 1e-3, 2e-3}), {2, 0.1, 0.2}}}};
    const PairClearance pair = c.certify();
    const auto near = tied_features(c.model, c.trajectory(), 0, 1, pair.witness, 0.05);
    const auto chosen = distinct_witnesses(c.model, c.trajectory(), {0, 1, 0}, near, 6);
    REQUIRE(chosen.size() >= 3);
    REQUIRE(chosen.size() <= 6);
    check_witnesses(c, pair, chosen);
    Vector3 low = pair.witness.point_b, high = low;
    for (const Witness& w : chosen) {
        low = low.cwiseMin(w.point_b);
        high = high.cwiseMax(w.point_b);
    }
    CHECK(high.y() - low.y() > 0.75);
    CHECK(high.z() - low.z() > 0.85);
    CHECK(distinct_witnesses(c.model, c.trajectory(), {0, 1, 0}, {pair.witness}, 6).empty());
    CHECK(distinct_witnesses(c.model, c.trajectory(), {0, 1, 0}, near, 2).size() == 2);
}

TEST_CASE("Each window's nearest instant is found, but none on a slope towards the next", "[clearance][adjoint]") {
    // There and back, a little farther away the second time.
    Case c;
    std::mt19937 random(4);
    c.model.bodies = {sized_body(tetrahedron(random, 1)), sized_body(tetrahedron(random, 1))};
    c.motion = true;
    const Pose away{core::kinematics::rotation({0.3, 1, 0.2}), {4, -2, 0.3}},
        back{core::kinematics::rotation({0.5, -1, 0.1}), {4, 2, -0.2}}, farther{core::kinematics::rotation({0.3, 1, 0.2}), {4.3, -2, 0.3}};
    c.poses = {{Pose{}, away}, {Pose{}, back}, {Pose{}, farther}};
    const PairClearance pair = c.certify();
    REQUIRE(pair.upper > 0.1);
    const auto trajectory = c.trajectory();
    const auto nearest = [&](int windows, double reach) {
        return core::clearance::nearest_by_window(c.model, trajectory, {0, 1, 0}, {0, 2, windows}, reach, 1e-9);
    };
    const auto both = nearest(2, 10);
    REQUIRE(both.size() == 2);
    CHECK(both[0].step == 0);
    CHECK(both[1].step == 1);
    CHECK(std::min(both[0].distance, both[1].distance) == Approx(pair.upper).epsilon(1e-8));
    for (int t = 0; t < 2; ++t) {
        Case part = c;
        part.poses = {c.poses[t], c.poses[static_cast<std::size_t>(t) + 1]};
        CHECK(both[t].distance == Approx(part.certify().upper).epsilon(1e-8));
    }
    CHECK(nearest(1, 10).size() == 1);
    CHECK(nearest(2, 0.99 * pair.upper).empty());
    const double farthest = std::max(both[0].distance, both[1].distance);
    CHECK(nearest(2, 0.5 * (pair.upper + farthest)).size() == 1);
    check_witnesses(c, pair, both);
    CHECK(distinct_witnesses(c.model, trajectory, {0, 1, 0}, both, 6).size() >= 1);

    // Straight towards each other for two steps: the first window's nearest instant is the second one's beginning.
    c.poses = {
        {Pose{}, {Matrix3::Identity(), {8, 0, 0}}}, {Pose{}, {Matrix3::Identity(), {6, 0, 0}}}, {Pose{}, {Matrix3::Identity(), {4, 0, 0}}}};
    const auto towards = core::clearance::nearest_by_window(c.model, c.trajectory(), {0, 1, 0}, {0, 2, 2}, 100, 1e-9);
    REQUIRE(towards.size() == 1);
    CHECK(towards[0].step == 1);
    CHECK(towards[0].s == 1);
}

}  // namespace fettle::adjoint::clearance::distinct_witnesses_test
