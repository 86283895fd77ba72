// SPDX-License-Identifier: MIT
#include "core/clearance/overlap.hpp"

#include <catch2/catch.hpp>

#include "core/parts/common_part.hpp"
#include "tests/core/clearance/clearance_models.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::clearance::overlap_test {

using namespace fettle::tests::clearance;

namespace {

std::optional<Overlap> overlap_of(const Solid& a, const Solid& b, const core::kinematics::Pose& pose_b, int cells = 3000,
                                  decltype(overlap_at)* measure = overlap_at) {
    const PieceTree tree_a = make_piece_tree(a.mesh, *a.hierarchy), tree_b = make_piece_tree(b.mesh, *b.hierarchy);
    const auto solid_a = core::certificate::solid_mesh(a.mesh), solid_b = core::certificate::solid_mesh(b.mesh);
    core::kinematics::PathSegment path_a, path_b;
    path_b.base = pose_b.rotation;
    path_b.position_t0 = pose_b.position;
    return measure({tree_a, solid_a}, {tree_b, solid_b}, pair_segment(path_a, path_b, tree_a.radius(), tree_b.radius()), 0, cells);
}

// The area that two circles of radius r have in common, `apart` from each other.
double lens_area(double r, double apart) {
    const double half = std::acos(apart / (2 * r));
    return 2 * r * r * half - r * apart * std::sin(half);
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

TEST_CASE("Depth and volume of thin overlaps are one figure: what two have in common is cut exactly", "[clearance]") {
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const Solid disc = prism(400, 1, 0.5), plate = box({3, 3, 0.5});
    for (const double height : {1e-1, 1e-2, 1e-3}) {
        // Discs side by side, corner to corner, which share a lens.
        const auto round = overlap_of(disc, disc, {Matrix3::Identity(), Vector3(2 - height, 0, 0)}, 20000, measured_overlap);
        REQUIRE(round);
        const double area = lens_area(1, 2 - height);
        CAPTURE(height, round->depth_lower, round->depth_upper, round->volume_lower, round->volume_upper, area);
        CHECK(round->depth_upper <= 1.01 * round->depth_lower);
        CHECK(round->depth_lower <= height * (1 + 1e-9));
        CHECK(round->depth_upper >= height * std::cos(M_PI / 400) * (1 - 1e-9));
        if (height > 5e-3) CHECK(round->volume_upper == Approx(0.5 * area).epsilon(0.02));
        CHECK(round->volume_upper - round->volume_lower <= 1e-6 * round->volume_upper);
        // A block that stands in a plate by so much, flush with one side of it.
        const auto flush =
            overlap_of(plate, box({0.5, 0.25, 0.25}), {Matrix3::Identity(), Vector3(2.5, 0, 0.75 - height)}, 20000, measured_overlap);
        REQUIRE(flush);
        CHECK(flush->depth_lower == Approx(height).epsilon(1e-3));
        CHECK(flush->depth_upper == Approx(height).epsilon(1e-3));
        CHECK(flush->volume_lower <= 0.5 * height * (1 + 1e-9));
        CHECK(flush->volume_upper >= 0.5 * height * (1 - 1e-9));
        CHECK(flush->volume_upper == Approx(0.5 * height));
    }
}

TEST_CASE("A plate that is caught is told by the move that frees it, not by what it shares", "[clearance]") {
    if (!core::parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    // A pin through a plate: sideways or along, it takes more than what they share is thick.
    const auto found = overlap_of(prism(24, 0.2, 4), box({1, 1, 0.1}), {Matrix3::Identity(), Vector3::Zero()}, 20000, measured_overlap);
    REQUIRE(found);
    CHECK(found->depth_lower == Approx(0.2).epsilon(0.01));
    CHECK(found->depth_upper >= 1.19);
    CHECK(found->depth_upper <= 1.21);
    CHECK(found->volume_upper == Approx(0.2 * 12 * 0.04 * std::sin(M_PI / 12)));
}

TEST_CASE("What cannot be cut shares no more than the lesser body", "[clearance]") {
    // A ring with two faces of no area, which no cut takes, in a block.
    const Solid whole = ring(24, 0.9, 1, 0.1);
    const Eigen::Index count = whole.mesh.vertices.cols();
    Matrix3X vertices(3, count + 1);
    const auto [u, v, w] = whole.mesh.triangles.front();
    vertices << whole.mesh.vertices, 0.5 * (whole.mesh.vertices.col(u) + whole.mesh.vertices.col(v));
    auto triangles = whole.mesh.triangles;
    triangles.push_back({u, v, static_cast<int>(count)});
    triangles.push_back({v, u, static_cast<int>(count)});
    const Solid odd = make_solid(vertices, triangles);
    REQUIRE(!core::parts::common_part(odd.mesh, box({2, 2, 2}).mesh));
    const auto found = overlap_of(odd, box({2, 2, 2}), {Matrix3::Identity(), Vector3::Zero()}, 16, measured_overlap);
    REQUIRE(found);
    const double volume = 0.1 * 12 * std::sin(M_PI / 12) * (1 - 0.81);
    CHECK(found->volume_upper == Approx(volume));
    CHECK(found->volume_upper >= volume * (1 - 1e-12));
}

}  // namespace fettle::core::clearance::overlap_test
