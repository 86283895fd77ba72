// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/overlap.hpp"

#include <catch2/catch.hpp>

#include "fettle/tests/core/clearance/clearance_models.hpp"

namespace fettle::core::clearance::overlap_test {

using namespace fettle::tests::clearance;

namespace {

std::optional<Overlap> overlap_of(const Solid& a, const Solid& b, const core::kinematics::Pose& pose_b, int cells = 3000) {
    const PieceTree tree_a = make_piece_tree(a.mesh, *a.hierarchy), tree_b = make_piece_tree(b.mesh, *b.hierarchy);
    const auto solid_a = core::certificate::solid_mesh(a.mesh), solid_b = core::certificate::solid_mesh(b.mesh);
    core::kinematics::PathSegment path_a, path_b;
    path_b.base = pose_b.rotation;
    path_b.position_t0 = pose_b.position;
    return overlap_at({tree_a, solid_a}, {tree_b, solid_b}, pair_segment(path_a, path_b, tree_a.radius(), tree_b.radius()), 0, cells);
}

}  // namespace

TEST_CASE("Overlap of boxes: depth and volume lie between the bounds", "[clearance]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(0.05, 1);
    for (int trial = 0; trial < 20; ++trial) {
        const Vector3 half(u(random), u(random), u(random)), other(u(random), u(random), u(random));
        const Vector3 gap = (half + other).cwiseProduct(Vector3(u(random), u(random), u(random)));
        const auto found = overlap_of(box(half), box(other), {Matrix3::Identity(), gap});
        const Vector3 shared = (half + other - gap).cwiseMin(2 * half).cwiseMin(2 * other);
        const double depth = (half + other - gap).minCoeff(), volume = shared.prod();
        CAPTURE(trial, depth, volume);
        REQUIRE(found);
        CAPTURE(found->depth_lower, found->depth_upper, found->volume_lower, found->volume_upper);
        CHECK(found->depth_lower <= depth * (1 + 1e-12));
        CHECK(found->depth_upper >= depth * (1 - 1e-12));
        CHECK(found->depth_upper == Approx(depth).epsilon(1e-9));
        CHECK(found->depth_lower > 0.9 * std::min(depth, shared.minCoeff()));
        CHECK(found->volume_lower <= volume * (1 + 1e-12));
        CHECK(found->volume_upper >= volume * (1 - 1e-12));
        CHECK(found->volume_upper - found->volume_lower <= volume * (1 + 1e-9));  // of thin ones no cell may lie within
    }
}

TEST_CASE("Overlap of turned prisms in steps of size: the bounds hold in every unit", "[clearance]") {
    for (const double size : {1e-6, 1e-3, 1.0, 1e4}) {
        const Solid a = prism(60, size, 2 * size);  // nearly a cylinder of height 2 size, along z
        const core::kinematics::Pose pose{core::kinematics::rotation(Vector3(0, 0, 0.3)), Vector3(0, 0, 1.5) * size};
        const auto found = overlap_of(a, a, pose);
        REQUIRE(found);
        const double area = M_PI * size * size,
                     height = (a.mesh.vertices.row(2).maxCoeff() - a.mesh.vertices.row(2).minCoeff()) - 1.5 * size;
        CAPTURE(size, height, found->depth_lower, found->depth_upper, found->volume_lower, found->volume_upper);
        CHECK(found->depth_lower <= height * (1 + 1e-12));
        CHECK(found->depth_upper >= height * (1 - 1e-12));
        CHECK(found->depth_lower > 0.95 * height);
        CHECK(found->volume_lower <= area * height);
        CHECK(found->volume_upper >= 0.97 * area * height);
    }
}

TEST_CASE("Nothing is told of the overlap of what is apart or has no inside", "[clearance]") {
    const auto apart = overlap_of(box({1, 1, 1}), box({1, 1, 1}), {Matrix3::Identity(), Vector3(2.5, 0, 0)});
    CHECK(!apart);
    const auto beside = overlap_of(prism(3, 1, 1), prism(3, 1, 1), {core::kinematics::rotation(Vector3(0, 0, M_PI)), Vector3(0.9, 1.3, 0)});
    if (beside) CHECK(beside->depth_lower == 0);  // boxes overlap, triangles do not
    Solid open = box({1, 1, 1});
    auto triangles = open.mesh.triangles;
    triangles.pop_back();
    CHECK(!overlap_of(make_solid(open.mesh.vertices, triangles), box({1, 1, 1}), {Matrix3::Identity(), Vector3(1, 0, 0)}));
}

}  // namespace fettle::core::clearance::overlap_test
