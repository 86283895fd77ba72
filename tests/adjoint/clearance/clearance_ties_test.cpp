// SPDX-License-Identifier: MIT
// Where several witnesses attain the least distance, it has a derivative on each side only.
#include <catch2/catch.hpp>

#include "tests/adjoint/clearance/clearance_cases.hpp"

namespace fettle::adjoint::clearance::clearance_ties_test {

using namespace fettle::tests::clearance_cases;

namespace {

// (d(x + h v) - d(x)) / h for small h > 0, extrapolated once.
double one_sided(const Case& c, const VectorX& v, double h) {
    const double d0 = c.certify().upper, d1 = moved(c, h * v).certify().upper, d2 = moved(c, 0.5 * h * v).certify().upper;
    return 2 * (d2 - d0) / (0.5 * h) - (d1 - d0) / h;
}

adjoint::clearance::ClearanceDirection direction_of(const Case& c, const VectorX& v) {
    adjoint::clearance::ClearanceDirection d;
    Eigen::Index at = 0;
    for (const auto& poses : c.poses) {
        d.pose_dot.emplace_back();
        for (std::size_t i = 0; i < poses.size(); ++i, at += 6) d.pose_dot.back().push_back(v.segment<6>(at));
    }
    for (const auto& body : c.model.bodies) {
        d.vertices_dot.push_back(v.segment(at, 3 * body.mesh.vertices.cols()).reshaped(3, body.mesh.vertices.cols()));
        at += 3 * body.mesh.vertices.cols();
    }
    return d;
}

void check_one_sided(const Case& c, int directions, int least_witnesses, double tolerance) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const PairClearance pair = c.certify();
    CAPTURE(pair.witnesses.size());
    CHECK(count_of(pair.witnesses) >= least_witnesses);
    int differ = 0;
    for (int i = 0; i < directions; ++i) {
        VectorX v(coordinate_count(c));
        for (double& x : v) x = normal(random);
        const auto along = [&](const VectorX& d) {
            return adjoint::clearance::clearance_derivative(c.model, c.trajectory(), pair, direction_of(c, d), 1e-9).value();
        };
        const double derivative = along(v);
        const double difference = one_sided(c, v, 1e-6);
        CAPTURE(i, derivative, difference);
        CHECK(std::abs(derivative - difference) < tolerance * std::abs(difference) + tolerance);
        differ += std::abs(derivative + along(-v)) > 1e-3;
    }
    CHECK(differ >= directions / 2);  // the two sides are not each other's negative: it is a tie
}

}  // namespace

TEST_CASE("Parallel faces tie: the one-sided derivative is the least over the witnesses", "[clearance][adjoint]") {
    Case c;
    c.model.bodies = {make_body(box({1, 1, 1})), make_body(box({0.5, 0.4, 0.5}))};
    c.poses = {{Pose{}, Pose{Matrix3::Identity(), {2, 0.1, 0.2}}}};
    c.witness_tolerance = 1e-9;
    check_one_sided(c, 6, 1, 1e-5);
    c.poses[0][1].position = {2, 1.2, 1.1};  // the faces overlap in a part only: edges cross
    check_one_sided(c, 6, 1, 1e-5);
}

TEST_CASE("The same gap at two times ties", "[clearance][adjoint]") {
    // A tip passes another on one way, and on the way back.
    Case c;
    std::mt19937 random(4);
    c.model.bodies = {make_body(tetrahedron(random, 1)), make_body(tetrahedron(random, 1))};
    c.motion = true;
    const Pose away{core::kinematics::rotation({0.3, 1, 0.2}), {4, -2, 0.3}},
        back{core::kinematics::rotation({0.5, -1, 0.1}), {4, 2, -0.2}};
    c.poses = {{Pose{}, away}, {Pose{}, back}, {Pose{}, away}};
    c.witness_tolerance = 1e-9;
    const PairClearance pair = c.certify();
    REQUIRE(pair.upper > 0.1);
    check_one_sided(c, 6, 2, 1e-5);
}

}  // namespace fettle::adjoint::clearance::clearance_ties_test
