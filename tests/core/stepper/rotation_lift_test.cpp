// SPDX-License-Identifier: MIT
#include "core/stepper/rotation_lift.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/kinematics/rotation.hpp"

namespace fettle::core::stepper::rotation_lift_test {

namespace {

// Largest entry by which the polygon's rotations leave exp(s [turn]) exp([theta]).
double largest_deviation(const Vector3& theta, const Vector3& turn, const std::vector<RotationNode>& nodes) {
    double worst = 0, s0 = 0;
    Vector3 from = theta;
    for (const RotationNode& node : nodes) {
        for (int i = 0; i <= 20; ++i) {
            const double share = i / 20.0, s = s0 + share * (node.s - s0);
            const Matrix3 wanted = kinematics::rotation(s * turn) * kinematics::rotation(theta);
            worst = std::max(worst, (kinematics::rotation(from + share * (node.theta - from)) - wanted).cwiseAbs().maxCoeff());
        }
        s0 = node.s;
        from = node.theta;
    }
    return worst;
}

}  // namespace

TEST_CASE("A turn about the same axis is one node, however far it goes", "[stepper][lift]") {
    const auto nodes = lifted_turn({0, 0, 1.5}, {0, 0, 9});
    REQUIRE(nodes.size() == 1);
    CHECK(nodes[0].s == 1);
    CHECK((nodes[0].theta == Vector3(0, 0, 10.5)));
    CHECK(lifted_turn(Vector3::Zero(), {1, 2, 3}).size() == 1);
    CHECK(lifted_turn({1, 2, 3}, Vector3::Zero()).size() == 1);
}

TEST_CASE("A turn about another axis is followed to 1e-4 rad, through half turns and whole ones", "[stepper][lift]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto some = [&](double size) { return Vector3(size * Vector3(uniform(random), uniform(random), uniform(random))); };
    for (int i = 0; i < 40; ++i) {
        const Vector3 theta = some(4), turn = some(4);
        const auto nodes = lifted_turn(theta, turn);
        CHECK(nodes.back().s == 1);
        CHECK(largest_deviation(theta, turn, nodes) < 1.5e-4);
    }
}

TEST_CASE("A path that turns aside at a whole turn goes round its sphere", "[stepper][lift]") {
    for (const Vector3& theta : {Vector3(0, 0, 2 * M_PI), Vector3(0, 0, 2 * M_PI - 1e-5), Vector3(0, -4 * M_PI, 0)}) {
        const Vector3 turn(0.7, 0.1, 0);
        const auto nodes = lifted_turn(theta, turn);
        CHECK(nodes.back().s == 1);
        CHECK(nodes.size() < 3000);
        CHECK(largest_deviation(theta, turn, nodes) < 3e-4);
        for (std::size_t k = 1; k < nodes.size(); ++k) REQUIRE(nodes[k].s > nodes[k - 1].s);
    }
}

}  // namespace fettle::core::stepper::rotation_lift_test
