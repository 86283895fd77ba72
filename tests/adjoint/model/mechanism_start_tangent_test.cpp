// SPDX-License-Identifier: MIT
// The start of a mechanism forwards, which shares nothing with the adjoint but the measures: they agree.
#include "tests/adjoint/model/mechanism_start_tangent.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "adjoint/model/mechanism_start_adjoint.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::adjoint::model::mechanism_start_tangent_test {

namespace {

using namespace fettle::tests::mechanisms;
using core::scene::JointKind;

// A spatial four-bar that is written a little apart, its bodies spinning as no joint lets them; a gear, and a motor that is in motion.
core::scene::Scene four_bar(bool has_driven_body) {
    const Vector3 z = Vector3::UnitZ(), a(0.1, 0, 0), b(0.35, 0.2, 0.05), o(0.35, -0.05, 0.05);
    core::scene::Scene scene =
        scene_of({bar("crank", 0.1, Vector3(0.004, -0.003, 0.002)), bar("coupler", 0.33, a, Vector3(0.05, -0.15, 0.68)),
                  bar("rocker", 0.25, o, Vector3(0.02, 0, 1.57)), bar("wheel", 0.1, Vector3(0, 0, 0.3))},
                 0.01);
    scene.gravity = Vector3(0.3, -9.81, 0.2);
    scene.bodies[1].angular_velocity = Vector3(1, 2, -3);
    scene.bodies[1].linear_velocity = Vector3(0.3, -0.1, 0.2);
    scene.bodies[2].angular_velocity = Vector3(0, 1, 4);
    const double coupler = (b - a).norm();
    scene.mechanism.joints = {joint("O", JointKind::revolute, {"", Vector3::Zero(), z}, {"crank", Vector3::Zero(), z}),
                              joint("A", JointKind::ball, {"crank", Vector3(0.1, 0, 0), z}, {"coupler", Vector3::Zero(), z}),
                              joint("B", JointKind::ball, {"coupler", Vector3(coupler, 0, 0), z}, {"rocker", Vector3(0.25, 0, 0), z}),
                              joint("C", JointKind::revolute, {"", o, Vector3(0.1, 0, 1)}, {"rocker", Vector3::Zero(), Vector3(0.1, 0, 1)}),
                              joint("W", JointKind::revolute, {"", Vector3(0, 0, 0.3), z}, {"wheel", Vector3::Zero(), z})};
    core::scene::Joint gear = joint("gear", JointKind::gear, {}, {});
    gear.of = {"O", "W"};
    gear.ratio = 0.7;
    scene.mechanism.joints.push_back(gear);
    core::scene::Curve curve;
    curve.kind = core::scene::CurveKind::cubic;
    curve.times = {0, 0.1, 0.2};
    curve.values = {0.02, 0.9, 2.2};
    scene.mechanism.motors = {motor("drive", "O", curve)};
    if (has_driven_body) scene.bodies[1].prescribed[3] = core::scene::MotionCurve{0.3, {}, {}, {}};
    return scene;
}

double pairing_of(const MechanismGradient& bar, const MechanismTangent& dot) {
    double sum = 0;
    for (std::size_t i = 0; i < dot.frames.size(); ++i)
        sum += bar.frames[i].point.dot(dot.frames[i].point) + bar.frames[i].axes.cwiseProduct(dot.frames[i].axes).sum();
    for (std::size_t i = 0; i < dot.row_constant.size(); ++i) {
        sum += bar.row_constant[i] * dot.row_constant[i] + bar.row_rate[i] * dot.row_rate[i];
        for (std::size_t k = 0; k < dot.row_factors[i].size(); ++k) sum += bar.row_factors[i][k] * dot.row_factors[i][k];
        for (std::size_t k = 0; k < dot.row_values[i].size(); ++k) sum += bar.row_values[i][k] * dot.row_values[i][k];
    }
    return sum;
}

}  // namespace

TEST_CASE("assembly and start velocities: forwards and backwards agree", "[adjoint][assembly]") {
    for (const bool has_driven_body : {false, true}) {
        const core::model::Model model = built(four_bar(has_driven_body));
        const std::size_t n = model.bodies.size();
        std::mt19937_64 random(9);
        std::uniform_real_distribution<double> unit(-1, 1);
        const auto noise = [&](auto&& m, double size) {
            for (Eigen::Index k = 0; k < m.size(); ++k) m.reshaped()[k] = size * unit(random);
        };
        REQUIRE(model.mechanism.dependent.empty());
        REQUIRE(std::count(model.mechanism.written.is_velocity_changed.begin(), model.mechanism.written.is_velocity_changed.end(), true) >
                1);
        for (int kind = 0; kind < 7; ++kind) {
            if (kind == 2 && has_driven_body) continue;  // as many conditions as coordinates: masses decide nothing
            WrittenStartTangent written{std::vector<Vector6>(n, Vector6::Zero()), {}, {}};
            written.velocity = written.rate = written.pose;
            ModelTangent direction = zero_model_tangent(model, 0);
            for (std::size_t i = 0; i < n; ++i) {
                if (kind == 0) noise(written.pose[i], 0.05);
                if (kind == 1) noise(written.velocity[i], 1);
                if (kind == 2) noise(direction.bodies[i].vertices_dot, 0.01);
                if (kind == 2) direction.bodies[i].density_dot = 500 * unit(random);
                for (int k = 0; k < 6; ++k)
                    if (kind == 1 && !is_free(model.bodies[i], k)) written.rate[i][k] = unit(random);
            }
            for (auto& frame : direction.mechanism.frames) {
                if (kind != 3) continue;
                noise(frame.point, 0.02);
                noise(frame.axes, 0.05);
            }
            for (std::size_t i = 0; i < direction.mechanism.row_constant.size(); ++i) {
                MechanismTangent& m = direction.mechanism;
                if (kind == 4) m.row_constant[i] = 0.01 * unit(random);
                for (double& v : m.row_values[i])
                    if (kind == 5) v = 0.1 * unit(random);
                if (kind == 5) m.row_rate[i] = 0.1 * unit(random);
                for (double& f : m.row_factors[i])
                    if (kind == 6) f = 0.1 * unit(random);
            }
            const StartTangent tangent = written_start_tangent(model, written, direction);
            ModelGradient gradient = zero_model_gradient(model, 0);
            double forwards = 0, backwards = 0;
            for (std::size_t i = 0; i < n; ++i) {
                BodyGradient& bar = gradient.bodies[i];
                noise(bar.pose_start_bar, 1);
                noise(bar.velocity_start_bar, 0.1);
                Matrix34 pose_dot;
                pose_dot << cross_matrix(tangent.pose[i].tail<3>()) * model.bodies[i].pose_start.rotation, tangent.pose[i].head<3>();
                forwards +=
                    bar.pose_start_bar.cwiseProduct(pose_dot).sum() + bar.velocity_start_bar.cwiseProduct(tangent.velocity[i]).sum();
            }
            const WrittenStartGradient bar = MechanismStartAdjoint(model).reverse(gradient);
            for (std::size_t i = 0; i < n; ++i) {
                backwards += bar.pose_bar[i].dot(written.pose[i]) + bar.velocity_bar[i].dot(written.velocity[i]) +
                             bar.rate_bar[i].dot(written.rate[i]);
                backwards += gradient.bodies[i].density_bar * direction.bodies[i].density_dot +
                             gradient.bodies[i].vertices_bar.cwiseProduct(direction.bodies[i].vertices_dot).sum();
            }
            backwards += pairing_of(gradient.mechanism, direction.mechanism);
            CAPTURE(has_driven_body, kind, forwards, backwards);
            CHECK(std::abs(forwards) > 1e-5);
            CHECK(std::abs(forwards - backwards) <= 1e-9 * std::abs(forwards));
        }
    }
}

TEST_CASE("a linkage assembled on the branch that is asked for has that branch's derivatives", "[adjoint][assembly]") {
    // A driven four-bar, all bars written on one another: poses that are nearest to the other branch or to none.
    const Vector3 z = Vector3::UnitZ(), origin = Vector3::Zero();
    const auto scene_at = [&](core::scene::AssembleSide side, double crank, double coupler, double angle) {
        core::scene::Scene scene = scene_of({bar("crank", 0.1), bar("coupler", 0.33), bar("rocker", 0.25)}, 0.01);
        scene.mechanism.joints = {
            joint("O", JointKind::revolute, {"", origin, z}, {"crank", origin, z}),
            joint("A", JointKind::revolute, {"crank", Vector3(crank, 0, 0), z}, {"coupler", origin, z}),
            joint("B", JointKind::revolute, {"coupler", Vector3(coupler, 0, 0), z}, {"rocker", Vector3(0.25, 0, 0), z}),
            joint("C", JointKind::revolute, {"", Vector3(0.35, -0.05, 0), z}, {"rocker", origin, z})};
        scene.mechanism.joints[2].assemble = core::scene::Assemble{side, "", ""};
        core::scene::Curve curve;
        curve.times = {0};
        curve.values = {angle};
        scene.mechanism.motors = {motor("drive", "O", curve)};
        return built(scene);
    };
    for (const auto side : {core::scene::AssembleSide::left, core::scene::AssembleSide::right}) {
        const core::model::Model model = scene_at(side, 0.1, 0.33, 0.7);
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> unit(-1, 1);
        ModelGradient gradient = zero_model_gradient(model, 0);
        std::vector<Matrix34> weights(3);
        for (std::size_t i = 0; i < 3; ++i) {
            for (int k = 0; k < 12; ++k) weights[i].reshaped()[k] = unit(random);
            gradient.bodies[i].pose_start_bar = weights[i];
        }
        const auto sum_at = [&](double crank, double coupler, double angle) {
            const core::model::Model there = scene_at(side, crank, coupler, angle);
            double sum = 0;
            for (std::size_t i = 0; i < 3; ++i) sum += weights[i].cwiseProduct(pose_matrix(there.bodies[i].pose_start)).sum();
            return sum;
        };
        const auto difference = [&](const Vector3& along) {
            const auto at = [&](double s) { return sum_at(0.1 + s * along[0], 0.33 + s * along[1], 0.7 + s * along[2]); };
            const auto central = [&](double h) { return (at(h) - at(-h)) / (2 * h); };
            return (4 * central(5e-5) - central(1e-4)) / 3;
        };
        MechanismStartAdjoint(model).reverse(gradient);
        const MechanismGradient& bar = gradient.mechanism;  // frames 2 k and 2 k + 1: the ends of joint k
        const double of_crank = bar.frames[2].point.x(), of_coupler = bar.frames[4].point.x();
        double of_angle = 0;
        for (const auto& values : bar.row_values)
            for (const double v : values) of_angle += v;
        CHECK(of_crank == Approx(difference(Vector3::UnitX())).epsilon(1e-7));
        CHECK(of_coupler == Approx(difference(Vector3::UnitY())).epsilon(1e-7));
        CHECK(of_angle == Approx(difference(Vector3::UnitZ())).epsilon(1e-7));
    }
}

}  // namespace fettle::adjoint::model::mechanism_start_tangent_test
