// SPDX-License-Identifier: MIT
// Newmark's rates, the start's acceleration and the chart's torque: values against core's, tangents against differences of core's, adjoints
// against tangents.
#include "adjoint/energy/time_integration_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/energy/start_history.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::energy::time_integration_adjoint_test {

namespace {

using core::kinematics::Pose;
using core::model::Body;
using core::model::Model;
using core::scene::Integrator;
using tests::support::box_mesh;
using tests::support::make_body;
using tests::support::make_pose;

constexpr double h = 0.05;

// A spinning brick whose reference point is not its centre of mass.
Model brick(int held) {
    Model model;
    model.integrator = Integrator::newmark;
    model.timestep = h;
    model.gravity = {0.3, -0.2, -9.81};
    model.bodies = {make_body("brick", box_mesh({-0.02, -0.05, 0.01}, {0.06, 0.03, 0.04}), make_pose({0.3, -0.4, 0.8}, {0, 0.1, 1}))};
    tests::support::set_velocity(model.bodies[0], {1, 0.5, 2}, {4, -3, 7});
    model.bodies[0].force = {0.3, 0.1, -0.2};
    model.bodies[0].torque = {0.01, -0.02, 0.015};
    if (held >= 0) tests::support::prescribe(model.bodies[0], held, 0.3);
    return model;
}

Pose pose_of(const Matrix34& p) { return {p.leftCols<3>(), p.col(3)}; }

Matrix4 symmetric_of(const VectorX& x) {
    Matrix4 m = x.reshaped(4, 4);
    return 0.5 * (m + m.transpose());
}

template <class... Parts>
VectorX packed(const Parts&... parts) {
    VectorX out((parts.size() + ...));
    Eigen::Index at = 0;
    const auto put = [&](const auto& part) {
        out.segment(at, part.size()) = VectorX(part.reshaped());
        at += part.size();
    };
    (put(parts), ...);
    return out;
}

VectorX random_vector(int n, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    return VectorX::NullaryExpr(n, [&] { return unit(random); });
}

// A step on from the start: P, V, A, P' one after the other, then the moments, scaled to what they are of.
struct StepInputs {
    Model model;
    Matrix34 before, velocity, acceleration, end;

    explicit StepInputs(int held) : model(brick(held)) {
        const core::energy::History history = core::energy::start_history(model);
        before = pose_matrix(history.poses[0]);
        velocity = history.velocities[0];
        acceleration = history.accelerations[0];
        const Pose next = make_pose({0.2, -0.25, 0.5}, {0.05, 0.02, 0.09});
        end = pose_matrix(Pose{next.rotation * history.poses[0].rotation, next.position + history.poses[0].position});
    }

    StepInputs moved(const VectorX& x) const {
        StepInputs out = *this;
        out.before += x.head(12).reshaped(3, 4);
        out.velocity += x.segment(12, 12).reshaped(3, 4);
        out.acceleration += x.segment(24, 12).reshaped(3, 4);
        out.end += x.segment(36, 12).reshaped(3, 4);
        out.model.bodies[0].moments += 0.01 * symmetric_of(x.tail(16));
        return out;
    }

    VectorX rates() const {
        const core::energy::History history{{pose_of(before)}, {velocity}, {}, {}, {acceleration}};
        const core::energy::History next = advanced(model, history, integration_step(model, history), {pose_of(end)});
        return packed(next.velocities[0], next.accelerations[0]);
    }

    NewmarkStep step() const { return {model.bodies[0], h, before, velocity, acceleration, pose_of(end)}; }
};

}  // namespace

TEST_CASE("Newmark's end rates: core's values, their changes and gradients", "[adjoint]") {
    std::mt19937_64 random(3);
    for (const int held : {-1, 1, 4}) {
        CAPTURE(held);
        const StepInputs inputs(held);
        const NewmarkRates rates = newmark_rates(inputs.step());
        CHECK((packed(rates.velocity, rates.acceleration) - inputs.rates()).norm() < 1e-13 * inputs.rates().norm());
        const auto tangent = [&](const VectorX& x) {
            const NewmarkRates dot = newmark_rates_tangent(
                inputs.step(), {x.head(12).reshaped(3, 4), x.segment(12, 12).reshaped(3, 4), x.segment(24, 12).reshaped(3, 4),
                                x.segment(36, 12).reshaped(3, 4), 0.01 * symmetric_of(x.tail(16))});
            return packed(dot.velocity, dot.acceleration);
        };
        const auto transposed = [&](const VectorX& w) {
            const NewmarkStepChange bar = newmark_rates_adjoint(inputs.step(), {w.head(12).reshaped(3, 4), w.tail(12).reshaped(3, 4)});
            return packed(bar.before, bar.velocity, bar.acceleration, bar.end, Matrix4(0.01 * bar.moments));
        };
        const VectorX along = random_vector(64, random), zero = VectorX::Zero(64);
        const auto value = [&](const VectorX& x) { return inputs.moved(x).rates(); };
        CHECK(tests::support::check_directional(value, zero, along, tangent(along), {1e-4, 0.25, 8}).relative_error < 1e-8);
        CHECK(tests::support::check_transpose(tangent, transposed, 64, 24) < 1e-13);
    }
}

TEST_CASE("the start's acceleration: its change and gradient", "[adjoint]") {
    std::mt19937_64 random(5);
    for (const double damping : {0.0, 3.0})
        for (const int held : {-1, 2, 5}) {
            Model model = brick(held);
            model.bodies[0].damping = {damping, 2 * damping};
            const StartOf start{model.bodies[0], model.gravity, core::energy::start_loads(model)[0]};
            const auto value = [&](const VectorX& x) {
                Model moved = model;
                Body& body = moved.bodies[0];
                body.velocity_start += x.head(12).reshaped(3, 4);
                body.pose_start.rotation += x.segment(12, 9).reshaped(3, 3);
                moved.gravity += x.segment(21, 3);
                body.force += x.segment(24, 3);
                body.torque += x.segment(27, 3);
                body.moments += 0.01 * symmetric_of(x.tail(16));
                return packed(core::energy::start_history(moved).accelerations[0]);
            };
            const auto tangent = [&](const VectorX& x) {
                return packed(start_acceleration_tangent(start, {x.head(12).reshaped(3, 4), x.segment(12, 9).reshaped(3, 3),
                                                                 x.segment(21, 3), x.segment(24, 6), 0.01 * symmetric_of(x.tail(16))}));
            };
            const auto transposed = [&](const VectorX& w) {
                const StartChange bar = start_acceleration_adjoint(start, w.reshaped(3, 4));
                return packed(bar.velocity, bar.rotation, bar.gravity, bar.loads, Matrix4(0.01 * bar.moments));
            };
            CAPTURE(held, damping);
            const VectorX along = random_vector(46, random), zero = VectorX::Zero(46);
            CHECK(tests::support::check_directional(value, zero, along, tangent(along), {1e-4, 0.25, 8}).relative_error < 1e-8);
            CHECK(tests::support::check_transpose(tangent, transposed, 46, 12) < 1e-13);
        }
}

TEST_CASE("the chart's torque: its change and gradient, for turns large and none", "[adjoint]") {
    std::mt19937_64 random(7);
    for (const double size : {0.0, 1e-6, 0.1, 1.0, 10.0}) {
        Model model = brick(-1);
        model.bodies[0].velocity_start *= size;
        const core::energy::History start = core::energy::start_history(model);
        const auto torque_of = [&](const Model& of, const core::energy::History& history) {
            return VectorX(integration_step(of, history).torque[0]);
        };
        // P_hat = P + h V + h^2/4 (A + a): its rotation changes with P and V.
        const auto value = [&](const VectorX& x) {
            Model moved = model;
            core::energy::History history = start;
            moved.bodies[0].torque += x.head(3);
            history.poses[0].rotation += x.segment(3, 9).reshaped(3, 3);
            history.velocities[0].leftCols<3>() += x.tail(9).reshaped(3, 3) / h;
            return torque_of(moved, history);
        };
        const Matrix34 hat = integration_step(model, start).pose_hat[0];
        const Matrix3& R = start.poses[0].rotation;
        const auto tangent = [&](const VectorX& x) {
            return VectorX(chart_torque_tangent(model.bodies[0].torque, R, hat,
                                                {x.head(3), x.segment(3, 9).reshaped(3, 3), (x.segment(3, 9) + x.tail(9)).reshaped(3, 3)}));
        };
        const auto transposed = [&](const VectorX& w) {
            const ChartTorqueChange bar = chart_torque_adjoint(model.bodies[0].torque, R, hat, w);
            return packed(bar.torque, Matrix3(bar.rotation + bar.hat), bar.hat);
        };
        CAPTURE(size);
        const VectorX along = random_vector(21, random), zero = VectorX::Zero(21);
        CHECK(tests::support::check_directional(value, zero, along, tangent(along), {1e-3, 0.25, 8}).relative_error < 1e-8);
        CHECK(tests::support::check_transpose(tangent, transposed, 21, 3) < 1e-14);
    }
}

}  // namespace fettle::adjoint::energy::time_integration_adjoint_test
