// SPDX-License-Identifier: MIT
// Derivatives of motions that start on a stop and are pressed on it, and of linkages whose independent rows change along the motion,
// against differences.
#include <algorithm>
#include <catch2/catch.hpp>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/row_multipliers.hpp"
#include "core/model/row_choice.hpp"
#include "tests/support/linkages.hpp"

namespace fettle::adjoint::stepper::limits_sweep_test {

using namespace fettle::tests::mechanisms;
using core::model::LawKind;
using core::model::Model;
using core::scene::Integrator;
using core::scene::JointKind;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

// A sum of all entries of the last pose of the last body, each with a weight of its own.
double objective(const std::vector<core::kinematics::Pose>& poses) {
    Matrix34 weights;
    weights << 0.3, -0.2, 0.5, 1.1, 0.7, 0.1, -0.4, 0.9, -0.6, 0.2, 0.8, 1.3;
    return weights.cwiseProduct(pose_matrix(poses.back())).sum();
}

TrajectoryGradient seed_of(const core::stepper::Trajectory& trajectory) {
    const int steps = count_of(trajectory.steps), bodies = count_of(trajectory.body_names);
    TrajectoryGradient out = zero_trajectory_gradient(steps, bodies);
    out.pose_bar.back().back() << 0.3, -0.2, 0.5, 1.1, 0.7, 0.1, -0.4, 0.9, -0.6, 0.2, 0.8, 1.3;
    return out;
}

double end_of(const Model& model, int steps) { return objective(run(model, steps, true).trajectory.poses.back()); }

template <class At>
double difference(const At& at, double step) {
    const double coarse = (at(step) - at(-step)) / (2 * step), fine = (at(step / 2) - at(-step / 2)) / step;
    return (4 * fine - coarse) / 3;
}

}  // namespace

TEST_CASE("a start on a stop: derivatives in limit, load and pose agree with differences", "[adjoint][limits]") {
    const JointKind kind = GENERATE(JointKind::revolute, JointKind::prismatic, JointKind::cylindrical, JointKind::screw);
    const Integrator integrator = GENERATE(Integrator::implicit_euler, Integrator::bdf2, Integrator::quasi_static);
    const bool is_lower = GENERATE(true, false);
    CAPTURE(static_cast<int>(kind), static_cast<int>(integrator), is_lower);
    core::scene::Scene scene = scene_of({bar("bar", 0.3)}, 0.01);
    scene.integrator = integrator;
    scene.mechanism.joints = {joint("j", kind, {"", Vector3::Zero(), z_axis}, {"bar", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].pitch = 0.02;
    scene.mechanism.joints[0].forces.limits = is_lower ? std::array{0.0, 0.5} : std::array{-0.5, 0.0};
    if (kind == JointKind::cylindrical) scene.bodies[0].prescribed[5] = core::scene::MotionCurve{};
    core::scene::Motor push = motor("push", "j", {});
    push.kind = core::scene::MotorKind::effort;
    push.curve.times = {0};
    push.curve.values = {is_lower ? -0.4 : 0.4};
    scene.mechanism.motors = {push};
    constexpr int steps = 8;
    const Model model = built(scene);
    const auto trajectory = run(model, steps, true).trajectory;
    const auto gradients = reverse_sweep(model, trajectory, {seed_of(trajectory)});
    REQUIRE(gradients);
    const MechanismGradient& bar = (*gradients)[0].mechanism;
    for (std::size_t k = 0; k < model.mechanism.terms.size(); ++k) {
        const core::model::MeasureTerm& term = model.mechanism.terms[k];
        if (term.kind == LawKind::stop && (term.sign > 0) == is_lower) {
            const double found = difference(
                [&](double s) {
                    Model moved = model;
                    moved.mechanism.terms[k].reference += s;
                    return end_of(moved, steps);
                },
                1e-2 * core::model::stop_give * model.dhat / term.length);
            CHECK(std::abs(found) > 1e-3);
            CHECK(bar.term_reference[k] == Approx(found).epsilon(1e-5));
        }
        if (term.kind == LawKind::force) {
            const double found = difference(
                [&](double s) {
                    Model moved = model;
                    moved.mechanism.terms[k].curve.values[0] += s;
                    return end_of(moved, steps);
                },
                2e-3);
            CHECK(bar.term_values[k][0] == Approx(found).epsilon(1e-5).margin(1e-9));
        }
    }
}

TEST_CASE("a bar that lies on the end of its swing: the derivative in the swing agrees with differences", "[adjoint][limits]") {
    core::scene::Scene scene = scene_of({bar("bar", 0.3)}, 0.01);
    scene.integrator = GENERATE(Integrator::implicit_euler, Integrator::quasi_static);
    scene.gravity = Vector3(0, 0, -gravity);
    const Vector3 x_axis = Vector3::UnitX();
    const double swing = 0.05;
    scene.mechanism.joints = {joint("j", JointKind::ball, {"", Vector3::Zero(), x_axis}, {"bar", Vector3::Zero(), x_axis})};
    scene.mechanism.joints[0].swing = swing;
    constexpr int steps = 40;
    const Model model = built(scene);
    const auto trajectory = run(model, steps, true).trajectory;
    const auto gradients = reverse_sweep(model, trajectory, {seed_of(trajectory)});
    REQUIRE(gradients);
    REQUIRE(model.mechanism.terms.size() == 1);
    const double found = difference(
        [&](double s) {
            Model moved = model;
            moved.mechanism.terms[0].reference += s;
            return end_of(moved, steps);
        },
        1e-2 * core::model::stop_give * model.dhat / model.mechanism.terms[0].length);
    CHECK(std::abs(found) > 1e-3);
    CHECK((*gradients)[0].mechanism.term_reference[0] == Approx(found).epsilon(1e-4));
}

TEST_CASE("a linkage whose independent rows change: derivatives agree with differences", "[adjoint][rows]") {
    const Integrator integrator = GENERATE(Integrator::implicit_euler, Integrator::bdf2, Integrator::quasi_static);
    const auto [from, to] = GENERATE(std::pair(30.0, 45.0), std::pair(30.0, 60.0), std::pair(45.0, 50.0));
    CAPTURE(static_cast<int>(integrator), from, to);
    core::scene::Scene scene = scissor_lift(3, from * M_PI / 180, to * M_PI / 180);
    scene.integrator = integrator;
    constexpr int steps = 10;
    const Model model = built(scene);
    REQUIRE(!model.mechanism.dependent.empty());
    const auto trajectory = run(model, steps, true).trajectory;
    const auto gradients = reverse_sweep(model, trajectory, {seed_of(trajectory)});
    if (!gradients) UNSCOPED_INFO(gradients.errors()[0].message);
    REQUIRE(gradients);
    // The motor's last value, in whichever place its row stands.
    const auto of_motor = [&](const core::constraint::Row& row) { return model.mechanism.joints[row.owner].is_motor; };
    const std::vector<core::constraint::Row> all = all_rows(model.mechanism);
    const auto row = std::find_if(all.begin(), all.end(), of_motor);
    const double found = difference(
        [&](double s) {
            core::scene::Scene moved = scene;
            moved.mechanism.motors[0].curve.values[1] += s;
            return end_of(built(moved), steps);
        },
        1e-5);
    CHECK(std::abs(found) > 0.1);
    CHECK((*gradients)[0].mechanism.row_values[row->number][1] == Approx(found).epsilon(1e-6));
    const auto multipliers = row_multipliers(model, trajectory);
    for (const VectorX& of_step : multipliers) CHECK(of_step.size() == count_of(all));
}

}  // namespace fettle::adjoint::stepper::limits_sweep_test
