// SPDX-License-Identifier: MIT
// Faces that lie on each other: neither a gap nor a clash. How much, how deep at most, and what is a clash all the same.
#include "core/clearance/touching.hpp"

#include <catch2/catch.hpp>

#include "tests/core/clearance/clearance_models.hpp"

namespace fettle::core::clearance::touching_test {

using namespace fettle::tests::clearance;

namespace {

const Vector3 zero = Vector3::Zero();

PairClearance judged(const model::Model& model, double minimum, bool may_touch, double depth = 0) {
    PairRequest request{0, 1, minimum};
    request.may_touch = may_touch;
    request.touch_depth = depth;
    return certify(model, as_assembled(model), {request}, options_with(1e-6))[0];
}

// In metres: a base of 60 x 40 x 10 mm and a lid of 30 x 8 x 5 mm on it, higher by `gap`.
model::Model lid_on_base(double gap) {
    return model_of({box({0.03, 0.02, 0.005}), box({0.015, 0.004, 0.0025})}, {{0.1, 0.2, 0.3}, {0.103, 0.202, 0.3075 + gap}});
}

// A tube of square section: `half` outside, with a hole of `hole`, both half widths, and half its length.
Solid tube(double half, double hole, double length) {
    Matrix3X x(3, 16);
    std::vector<geometry::Triangle> triangles;
    for (int ring = 0; ring < 4; ++ring) {
        const double r = ring % 2 == 0 ? half : hole, z = ring < 2 ? -length : length;
        for (int i = 0; i < 4; ++i) x.col(4 * ring + i) << (i == 0 || i == 3 ? r : -r), (i < 2 ? r : -r), z;
    }
    const auto quad = [&](int a, int b, int c, int d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    };
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4;
        quad(i, j, 8 + j, 8 + i);            // outside
        quad(4 + j, 4 + i, 12 + i, 12 + j);  // hole
        quad(j, i, 4 + i, 4 + j);            // below
        quad(8 + i, 8 + j, 12 + j, 12 + i);  // above
    }
    return make_solid(x, triangles);
}

}  // namespace

TEST_CASE("A lid on its base touches it: over which area, and how deep at most", "[clearance]") {
    for (const double gap : {0.0, 1e-17, -1e-17, 3e-9, -3e-9}) {  // the last are what the decimals of an STL do
        const auto model = lid_on_base(gap);
        const PairClearance unasked = judged(model, 0, false), refused = judged(model, 3e-4, false), accepted = judged(model, 0, true);
        CAPTURE(gap, refused.reason);
        if (gap < 1e-9) {
            for (const PairClearance& each : {unasked, refused, accepted}) {
                REQUIRE(each.touch);
                CHECK(each.touch->area == Approx(240e-6).epsilon(1e-9));
                CHECK(each.touch->depth > 1e-8);
                CHECK(each.touch->depth < 1e-6);
                CHECK(!each.is_clash());
                CHECK(each.lower == 0);
            }
            // By nanometres in each other: that they are not apart is proven then.
            CHECK(unasked.status == (gap < -1e-9 ? PairStatus::violated : PairStatus::undecided));
            CHECK(accepted.status == PairStatus::contact);
        }
        CHECK(refused.status == PairStatus::violated);
        CHECK(accepted.status != PairStatus::violated);
        CHECK(accepted.status != PairStatus::undecided);
    }
}

TEST_CASE("What is deeper than a touch is a clash, whoever allows a touch; a deeper one can be allowed", "[clearance]") {
    for (const double depth : {2e-6, 1e-5, 1e-3}) {
        const auto model = lid_on_base(-depth);
        CAPTURE(depth);
        const PairClearance found = judged(model, 0, true);
        CHECK(found.is_clash());
        CHECK(found.status == PairStatus::violated);
        CHECK(!found.touch);
        const PairClearance allowed = judged(model, 0, true, 6 * depth);
        REQUIRE(allowed.touch);
        CHECK(allowed.status == PairStatus::contact);
        CHECK(allowed.touch->depth == 6 * depth);
        CHECK(judged(model, 0, true, 0.5 * depth).status == PairStatus::violated);
        CHECK(judged(model, 0, true, 0.99 * depth).status == PairStatus::violated);
        CHECK(judged(model, 0, true, 1.01 * depth).status == PairStatus::contact);  // by the exact cut of what they share
    }
    const auto coincident = model_of({box({1, 1, 1}), box({1, 1, 1})}, {zero, zero});
    CHECK(judged(coincident, 0, true).status == PairStatus::violated);
    const auto inside = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {zero, {0.5, 0, 0}});  // from inside, on one face
    CHECK(judged(inside, 0, true).status == PairStatus::violated);
}

TEST_CASE("A plug touches all round the hole that it fills", "[clearance]") {
    const Vector3 place(0.4, -0.2, 0.3);
    auto model = model_of({tube(0.02, 0.01, 0.015), box({0.01, 0.01, 0.02})}, {place, place});
    const PairClearance found = judged(model, 0, true);
    REQUIRE(found.touch);
    CHECK(found.status == PairStatus::contact);
    CHECK(found.touch->area == Approx(4 * 0.02 * 0.03).epsilon(1e-9));
    model.bodies[1].pose_start.position.x() += 1e-5;  // in one wall
    CHECK(judged(model, 0, true).status == PairStatus::violated);
    const core::kinematics::Pose turned{core::kinematics::rotation(Vector3(0.3, -1, 0.7)), place};  // rounded places of corners
    for (auto& body : model.bodies) body.pose_start = turned;
    const PairClearance of_turned = judged(model, 0, true);
    REQUIRE(of_turned.touch);
    CHECK(of_turned.touch->area == Approx(4 * 0.02 * 0.03).epsilon(1e-6));
}

TEST_CASE("A slide that keeps touching its rail does so all along its path; one that dips into it does not", "[clearance]") {
    const auto model = lid_on_base(0);
    const Vector3 start = model.bodies[1].pose_start.position;
    PairRequest request{0, 1, 0};
    request.may_touch = true;
    const auto along = [&](const Vector3& middle) {
        const auto path = one_step(model, {{start, zero}, {start + middle, zero}, {start + Vector3(0.01, 0, 0), zero}});
        return certify(model, path, {request}, over_motion())[0];
    };
    const PairClearance slid = along({0.005, 0, 0});
    REQUIRE(slid.touch);
    CHECK(slid.status == PairStatus::contact);
    CHECK(slid.touch->area == Approx(240e-6).epsilon(1e-9));
    const PairClearance dipped = along({0.005, 0, -1e-4});
    CHECK(dipped.status == PairStatus::violated);
    CHECK(dipped.is_clash());
    const PairClearance lifted = along({0.005, 0, 1e-3});
    CHECK(lifted.status == PairStatus::contact);
}

TEST_CASE("Of parts that overlap within one body a touch is not proven; beside each other, or in a cavity, they do no harm",
          "[clearance]") {
    const auto together = [](const Solid& first, const Solid& second, const Vector3& shift, bool turned = false) {
        const auto count = static_cast<int>(first.mesh.vertices.cols());
        Matrix3X x(3, count + second.mesh.vertices.cols());
        x << first.mesh.vertices, second.mesh.vertices.colwise() + shift;
        auto triangles = first.mesh.triangles;
        for (const auto& t : second.mesh.triangles)
            triangles.push_back({t[0] + count, t[turned ? 2U : 1U] + count, t[turned ? 1U : 2U] + count});
        return make_solid(x, triangles);
    };
    const auto touch = [](const Solid& body) {
        const auto model = model_of({body, body}, {zero, {0, 0, 0.02}});
        return judged(model, 0, true).touch.has_value();
    };
    const Solid block = box({0.03, 0.02, 0.01}), small = box({0.02, 0.01, 0.005});
    CHECK(touch(block));
    CHECK(touch(together(block, small, {0.1, 0, 0})));
    CHECK(touch(together(block, small, zero, true)));
    CHECK(!touch(together(block, small, zero)));
    CHECK(!touch(together(block, block, {0.0301, 0.0102, 0})));
}

TEST_CASE("A pair that may touch is judged by no minimum, near or far", "[clearance]") {
    for (const double gap : {0.0, 1e-5, 5e-5, 2e-4, 1e-3}) {
        const PairClearance found = judged(lid_on_base(gap), 3e-4, true);
        CAPTURE(gap, found.reason);
        CHECK(found.minimum == 0);
        CHECK(found.status == (gap < 1e-4 ? PairStatus::contact : PairStatus::clear));
    }
}

TEST_CASE("Of too many faces the area that touches is told as a part of it", "[clearance]") {
    const auto sheet = [](int n) {
        Matrix3X x(3, n * n);
        std::vector<geometry::Triangle> triangles;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                x.col(i * n + j) << i, j, 0;
                if (i + 1 == n || j + 1 == n) continue;
                triangles.push_back({i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1});
                triangles.push_back({i * n + j, (i + 1) * n + j + 1, i * n + j + 1});
            }
        }
        return make_solid(x, triangles);
    };
    const auto area = [&](int n, double depth) {
        const auto model = model_of({sheet(n), sheet(n)}, {zero, zero});
        const auto trajectory = as_assembled(model);
        const PieceTree a = make_piece_tree(model.bodies[0].mesh, *model.bodies[0].hierarchy),
                        b = make_piece_tree(model.bodies[1].mesh, *model.bodies[1].hierarchy);
        const certificate::SolidMesh solid_a = certificate::solid_of(model.bodies[0]), solid_b = certificate::solid_of(model.bodies[1]);
        const PairMotion pair{a,          b,
                              trajectory, {pair_segment(kinematics::PathSegment{}, kinematics::PathSegment{}, a.radius(), b.radius())},
                              solid_a,    solid_b};
        return touching_area(pair, 0, 0, depth);
    };
    CHECK(area(4, 1e-6).is_whole);
    CHECK(!area(34, 1e3).is_whole);  // all of them are near each other
}

TEST_CASE("Edges and corners that meet touch without an area", "[clearance]") {
    const auto edge_on = model_of({box({1, 1, 1}), box({1, 1, 1})}, {zero, {2, 2, 0}});
    const PairClearance found = judged(edge_on, 0, true);
    REQUIRE(found.touch);
    CHECK(found.touch->area < 1e-9);
    CHECK(found.status == PairStatus::contact);
}

}  // namespace fettle::core::clearance::touching_test
