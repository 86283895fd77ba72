// SPDX-License-Identifier: MIT
#include "core/clearance/hull_direction.hpp"

#include <catch2/catch.hpp>

#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::core::clearance::hull_direction_test {

using namespace fettle::tests::clearance;

namespace {

RelativePose random_pose(std::mt19937& random, double distance) {
    return {kinematics::rotation(random_vector(random, 2)), random_vector(random, distance)};
}

/// Least distance of the two solids by brute force, b at rest.
double oracle_at(const Solid& a, const Solid& b, const RelativePose& pose) {
    kinematics::PathSegment held, rest;
    held.base = pose.rotation;
    held.position_t0 = pose.offset;
    return static_cast<double>(
        oracle_distance(a.mesh, oracle_vertices(held, a.mesh.vertices, 0), b.mesh, oracle_vertices(rest, b.mesh.vertices, 0)));
}

}  // namespace

TEST_CASE("The furthest corner of a tree is that of all corners", "[clearance]") {
    std::mt19937 random(1);
    for (const Solid& solid : {ring(40, 0.5, 1, 0.3), prism(7, 1, 2), tetrahedron(random, 1)}) {
        const PieceTree tree = solid.search();
        Support guess = any_support(tree);
        for (int i = 0; i < 200; ++i) {
            const Vector3 direction = i % 10 == 0 ? Vector3::Unit(i / 10 % 3).eval() : random_vector(random, 1);
            const Support found = support(tree, direction, guess);
            CHECK(found.value == direction.dot(found.point()));
            CHECK(found.value == Approx((direction.transpose() * solid.mesh.vertices).maxCoeff()).epsilon(1e-15).margin(1e-15));
            guess = found;  // wherever the search begins
        }
    }
}

TEST_CASE("Along the direction of convex bodies the bound is their distance", "[clearance]") {
    std::mt19937 random(2);
    int apart = 0;
    for (int i = 0; i < 100; ++i) {
        const Solid a = i % 2 == 0 ? prism(3 + i % 17, 1, 2) : tetrahedron(random, 1),
                    b = i % 3 == 0 ? box({1, 0.5, 0.1}) : prism(16, 0.2, 3);
        const PieceTree tree_a = a.search(), tree_b = b.search();
        HullDirection hulls(tree_a, tree_b);
        RelativePose pose = random_pose(random, 3);
        for (int step = 0; step < 4; ++step, pose.offset += random_vector(random, 0.05)) {  // from what is known of the pose before
            const HullDirection::Bound bound = hulls.at(pose, 1e-9);
            const double distance = oracle_at(a, b, pose);
            CAPTURE(i, step, distance);
            CHECK(bound.n.norm() <= 1);
            CHECK(bound.apart <= distance + 1e-14);
            if (bound.n.isZero(0)) continue;
            ++apart;
            CHECK(bound.apart >= distance - 2e-9);
        }
    }
    CHECK(apart > 230);
}

TEST_CASE("Looked for beyond a distance, a direction is found where there is one", "[clearance]") {
    std::mt19937 random(5);
    int beyond = 0, nearer = 0;
    for (int i = 0; i < 300; ++i) {
        const Solid a = i % 2 == 0 ? prism(3 + i % 17, 1, 2) : tetrahedron(random, 1),
                    b = i % 3 == 0 ? box({1, 0.5, 0.1}) : prism(16, 0.2, 3);
        const PieceTree tree_a = a.search(), tree_b = b.search();
        const RelativePose pose = random_pose(random, 4);
        const double distance = oracle_at(a, b, pose), wanted = distance + 0.2 * random_vector(random, 1).x();
        const Vector3 n = i % 5 == 0 ? Vector3::Zero().eval() : unit_direction(random_vector(random, 1));
        HullDirection hulls(tree_a, tree_b);
        const HullDirection::Bound bound = hulls.beyond(pose, n, wanted);
        CAPTURE(i, distance, wanted);
        CHECK(bound.n.norm() <= 1);
        CHECK(bound.apart <= distance + 1e-14);
        if (!(distance > 0 && wanted > 0)) continue;
        (wanted < distance ? beyond : nearer) += 1;
        if (wanted < distance - 1e-9) CHECK(bound.apart > wanted);
    }
    CHECK(beyond > 50);
    CHECK(nearer > 50);
}

TEST_CASE("Pieces of bodies have corners and hulls of their own", "[clearance]") {
    std::mt19937 random(6);
    const Solid solid = ring(40, 0.5, 1, 0.3);
    const PieceTree tree = solid.search();
    for (int i = 0; i < 300; ++i) {
        const int index = static_cast<int>(random() % tree.pieces.size());
        const Vector3 direction = random_vector(random, 1);
        double most = -1e300;
        for (const PieceElement& element : tree.elements_of(tree.pieces[index]))
            most = std::max(most, (direction.transpose() * element.corners.x).maxCoeff());
        const Support found = support(tree, direction, any_support(tree, index), index);
        CHECK(found.value == Approx(most).epsilon(1e-14).margin(1e-15));
        CHECK(found.value == direction.dot(found.point()));
    }
}

TEST_CASE("Of bodies that are not convex it is a bound, of hulls that meet none", "[clearance]") {
    std::mt19937 random(3);
    const Solid a = ring(12, 0.8, 1, 0.2), pin = prism(12, 0.3, 2);
    const PieceTree tree = a.search(), tree_of_pin = pin.search();
    HullDirection beside(tree, tree), around(tree, tree_of_pin);
    CHECK(around.at({Matrix3::Identity(), Vector3(0.1, 0, 0)}, 1e-9).n.isZero(0));
    for (int i = 0; i < 100; ++i) {
        const RelativePose pose = random_pose(random, 2.5);
        CHECK(beside.at(pose, 1e-9).apart <= oracle_at(a, a, pose) + 1e-14);
    }
}

TEST_CASE("Poses that are no numbers have no direction", "[clearance]") {
    const Solid solid = box({1, 1, 1});
    const PieceTree tree = solid.search();
    HullDirection hulls(tree, tree);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(hulls.at({Matrix3::Identity(), Vector3(3, nan, 0)}, 1e-9).n.isZero(0));
    CHECK(hulls.at({Matrix3::Constant(nan), Vector3(3, 0, 0)}, 1e-9).n.isZero(0));
    CHECK(hulls.at({Matrix3::Identity(), Vector3(3, 0, 0)}, 1e-9).apart == Approx(1));
    CHECK(std::isnan(support(tree, Vector3(1, nan, 0), any_support(tree)).value));
}

TEST_CASE("Flat and thin bodies have directions too", "[clearance]") {
    const Solid sheet = make_solid((Matrix3X(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished(), {{0, 1, 2}});
    const PieceTree tree = sheet.search();
    HullDirection hulls(tree, tree);
    for (const double gap : {1.0, 1e-3, 1e-7}) {
        const HullDirection::Bound bound = hulls.at({Matrix3::Identity(), Vector3(0, 0, gap)}, 0);
        CHECK(bound.apart == Approx(gap).epsilon(1e-9));
    }
    CHECK(hulls.at({Matrix3::Identity(), Vector3::Zero()}, 0).apart <= 0);
}

}  // namespace fettle::core::clearance::hull_direction_test
