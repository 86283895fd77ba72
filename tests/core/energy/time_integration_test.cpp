// SPDX-License-Identifier: MIT
// P_hat, weights and rates of the integrators, against their formulas and against motions that they must reproduce exactly.
#include "core/energy/time_integration.hpp"

#include <catch2/catch.hpp>

#include "core/energy/start_history.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::energy::time_integration_test {

using namespace fettle::tests::support;
using kinematics::pose_matrix;
using scene::Integrator;

namespace {

constexpr double h = 0.02;
constexpr std::array integrators{Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark};

// A brick whose reference point is its centre of mass, moving and turning.
model::Model brick(Integrator integrator, const Vector3& gravity, const Vector3& velocity, const Vector3& spin) {
    model::Model model;
    model.bodies = {make_body("brick", box_mesh({-0.2, -0.1, -0.3}, {0.2, 0.1, 0.3}), make_pose({0.1, 0.2, -0.3}, {1, 2, 3}))};
    set_velocity(model.bodies[0], velocity, spin);
    model.gravity = gravity;
    model.timestep = h;
    model.integrator = integrator;
    return model;
}

// The history after n steps in which nothing but inertia and gravity acts on a body that does not turn: each ends at its P_hat.
History glide(const model::Model& model, int steps) {
    History history = start_history(model);
    for (int t = 0; t < steps; ++t) {
        const IntegrationStep step = integration_step(model, history);
        std::vector<kinematics::Pose> end = history.poses;
        for (std::size_t i = 0; i < end.size(); ++i) end[i].position = step.pose_hat[i].col(3);
        history = advanced(model, history, step, end);
    }
    return history;
}

}  // namespace

TEST_CASE("P_hat, weight and slip of each integrator", "[time_integration]") {
    const Vector3 gravity(0.1, 0, -9.8), velocity(1, -2, 0.5), spin(0.3, 1, -2);
    const model::Model euler = brick(Integrator::implicit_euler, gravity, velocity, spin);
    const Matrix34 P0 = pose_matrix(euler.bodies[0].pose_start), V0 = euler.bodies[0].velocity_start;
    Matrix34 fall = Matrix34::Zero();
    fall.col(3) = gravity;
    const IntegrationStep first = integration_step(euler, start_history(euler));
    CHECK(first.weight == Approx(h * h));
    CHECK(first.slip_time == h);
    CHECK((first.pose_hat[0] - (P0 + h * V0 + h * h * fall)).norm() < 1e-15);
    CHECK(first.slip_reference[0] == P0);

    const model::Model bdf2 = brick(Integrator::bdf2, gravity, velocity, spin);
    const IntegrationStep bdf2_first = integration_step(bdf2, start_history(bdf2));
    CHECK(bdf2_first.pose_hat[0] == first.pose_hat[0]);  // it starts with a step of implicit Euler
    CHECK(bdf2_first.weight == first.weight);
    History two = start_history(bdf2);
    two.poses_before = {Matrix34(P0 - 0.9 * h * V0)};
    two.velocities_before = {Matrix34(0.8 * V0)};
    const IntegrationStep second = integration_step(bdf2, two);
    const Matrix34 slip = (4 * P0 - two.poses_before[0]) / 3;
    CHECK(second.slip_time == Approx(2 * h / 3));
    CHECK(second.weight == Approx(4 * h * h / 9));
    CHECK((second.slip_reference[0] - slip).norm() < 1e-15);
    CHECK((second.pose_hat[0] - (slip + 2 * h / 9 * (4 * V0 - 0.8 * V0) + second.weight * fall)).norm() < 1e-15);

    const model::Model newmark = brick(Integrator::newmark, gravity, velocity, spin);
    const History start = start_history(newmark);
    const IntegrationStep step = integration_step(newmark, start);
    CHECK(step.weight == Approx(h * h / 4));
    CHECK(step.slip_time == h / 2);
    CHECK((step.pose_hat[0] - (P0 + h * V0 + h * h / 4 * (start.accelerations[0] + fall))).norm() < 1e-15);
}

TEST_CASE("a body that glides keeps its velocity, exactly, by every integrator", "[time_integration]") {
    for (const Integrator integrator : integrators) {
        const Vector3 velocity(1, -2, 0.5);
        const model::Model model = brick(integrator, Vector3::Zero(), velocity, Vector3::Zero());
        const History end = glide(model, 7);
        INFO("integrator " << static_cast<int>(integrator));
        CHECK((end.poses[0].position - Vector3(1, 2, 3) - 7 * h * velocity).norm() < 1e-14);
        CHECK((end.velocities[0].col(3) - velocity).norm() < 1e-12);
        CHECK(end.velocities[0].leftCols<3>().norm() < 1e-12);
    }
}

TEST_CASE("free fall has the velocity g t, and Newmark's position is exact", "[time_integration]") {
    const Vector3 g(0, 0, -9.8);
    for (const Integrator integrator : integrators) {
        const model::Model model = brick(integrator, g, Vector3::Zero(), Vector3::Zero());
        const History end = glide(model, 5);
        INFO("integrator " << static_cast<int>(integrator));
        CHECK((end.velocities[0].col(3) - 5 * h * g).norm() < 1e-12);
        const Vector3 fallen = end.poses[0].position - Vector3(1, 2, 3);
        if (integrator == Integrator::newmark) {
            CHECK((fallen - 0.5 * 25 * h * h * g).norm() < 1e-13);
            CHECK((end.accelerations[0].col(3) - g).norm() < 1e-11);
        }
        if (integrator == Integrator::implicit_euler) CHECK((fallen - 15 * h * h * g).norm() < 1e-13);  // 1 + 2 + ... + 5
    }
}

TEST_CASE("Newmark starts with the acceleration of each body on its own", "[time_integration]") {
    model::Model model = brick(Integrator::newmark, {0, 0, -9.8}, Vector3::Zero(), {0, 0, 3});
    model.bodies[0].force = {10, 0, 0};
    model.bodies[0].torque = {0, 2, 0};
    const model::Body& body = model.bodies[0];
    const Matrix34 A = start_history(model).accelerations[0];
    CHECK((A.col(3) - (model.gravity + body.force / body.moments(3, 3))).norm() < 1e-12);
    // Euler's equation, I alpha + omega x I omega = tau, in Rddot = ([alpha] + [omega]^2) R.
    const Matrix3 R = body.pose_start.rotation, second = R * body.moments.topLeftCorner<3, 3>() * R.transpose();
    const Matrix3 inertia = second.trace() * Matrix3::Identity() - second;
    const Vector3 omega(0, 0, 3);
    const Matrix3 alpha = A.leftCols<3>() * R.transpose() - cross_matrix(omega) * cross_matrix(omega);
    CHECK((alpha + alpha.transpose()).norm() < 1e-12 * alpha.norm());
    const Vector3 axis(alpha(2, 1), alpha(0, 2), alpha(1, 0));
    CHECK((inertia * axis + omega.cross(inertia * omega) - body.torque).norm() < 1e-12);
}

TEST_CASE("torque is handed on as it is, or turned back by the predicted rotation", "[time_integration]") {
    for (const Integrator integrator : integrators) {
        model::Model model = brick(integrator, Vector3::Zero(), Vector3::Zero(), {0, 0, 2});
        model.bodies[0].torque = {1, 4, -2};
        const Vector3 torque = integration_step(model, start_history(model)).torque[0];
        if (integrator == Integrator::implicit_euler)
            CHECK(torque == model.bodies[0].torque);
        else {
            CHECK(torque != model.bodies[0].torque);
            CHECK((torque - model.bodies[0].torque).norm() < 0.05 * model.bodies[0].torque.norm());  // half of 0.04 rad
            CHECK(torque.z() == Approx(-2).epsilon(1e-3));                                           // along the spin
        }
        model.bodies[0].torque.setZero();
        CHECK(integration_step(model, start_history(model)).torque[0] == Vector3::Zero());
    }
}

TEST_CASE("a body that is prescribed altogether has the velocity of its step", "[time_integration]") {
    for (const Integrator integrator : integrators) {
        model::Model model = brick(integrator, {0, 0, -9.8}, {1, 0, 0}, Vector3::Zero());
        for (int k = 0; k < 6; ++k) prescribe(model.bodies[0], k);
        const History start = start_history(model);
        std::vector<kinematics::Pose> end = start.poses;
        end[0].position += Vector3(0, 0.5, 0);
        const History next = advanced(model, start, integration_step(model, start), end);
        CHECK((next.velocities[0].col(3) - Vector3(0, 0.5 / h, 0)).norm() < 1e-12);
        if (integrator == Integrator::newmark) CHECK(next.accelerations[0] == Matrix34::Zero());
    }
}

}  // namespace fettle::core::energy::time_integration_test
