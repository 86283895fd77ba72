// SPDX-License-Identifier: MIT
// Derivatives of the assembled poses against differences of assemblies.
#include "adjoint/constraint/assembly_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/support/mechanisms.hpp"

namespace fettle::adjoint::constraint::assembly_adjoint_test {

using namespace fettle::tests::mechanisms;
using core::constraint::Assembly;
using core::constraint::AssemblyProblem;
using core::kinematics::Pose;
using core::scene::JointKind;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

// A spatial four-bar that does not fit as it is written, free to go round; the model tells frames, measures and rows.
core::scene::Scene linkage() {
    core::scene::Scene scene =
        scene_of({bar("crank", 0.1), bar("coupler", 0.35, Vector3(0.1, 0.01, 0), Vector3(0.05, -0.1, 0.6)),
                  bar("rocker", 0.25, Vector3(0.35, -0.05, 0.06), Vector3(0, 0.02, 1.5)), bar("base", 0.1, Vector3(0.35, -0.05, 0.05))},
                 0.01);
    scene.bodies[3].type = core::scene::BodyType::static_body;
    for (auto& dof : scene.bodies[3].prescribed) dof = core::scene::MotionCurve{};
    scene.mechanism.joints = {
        joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("A", JointKind::ball, {"crank", Vector3(0.1, 0, 0), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
        joint("B", JointKind::ball, {"coupler", Vector3(0.33, 0, 0), z_axis}, {"rocker", Vector3(0.25, 0, 0), z_axis}),
        joint("C", JointKind::revolute, {"base", Vector3(0, 0, 0), Vector3(0.1, 0, 1)}, {"rocker", Vector3::Zero(), Vector3(0.1, 0, 1)})};
    return scene;
}

struct Start {
    core::model::Model model;  // assembled
    std::vector<Pose> written;
    VectorX targets;
    AssemblyProblem problem() const {
        AssemblyProblem out{model.mechanism.set, model.mechanism.rows, targets, {}, free_dofs(model), model.diagonal};
        for (const core::model::Body& body : model.bodies) out.moments.push_back(body.moments);
        return out;
    }
    Assembly assembled() const {
        Assembly out = assemble(problem(), written);
        REQUIRE(out.is_met);
        REQUIRE(out.dependent.empty());
        return out;
    }
};

Start start() {
    const core::scene::Scene scene = linkage();
    core::scene::Scene loose = scene;
    loose.mechanism = {};
    Start out{built(scene), {}, {}};
    for (const core::model::Body& body : built(loose).bodies) out.written.push_back(body.pose_start);
    out.targets.resize(out.model.mechanism.rows.size());
    for (std::size_t i = 0; i < out.model.mechanism.rows.size(); ++i) out.targets[i] = target_at(out.model.mechanism.rows[i], 0);
    return out;
}

}  // namespace

TEST_CASE("assembled poses have the derivatives of their joints, masses and written poses", "[adjoint][assembly]") {
    const Start base = start();
    const std::size_t n = base.written.size();
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto noise = [&](auto&& m, double size) {
        for (Eigen::Index k = 0; k < m.size(); ++k) m.reshaped()[k] = size * unit(random);
    };
    std::vector<Matrix34> weights(n);
    for (Matrix34& w : weights) noise(w, 1);
    const Assembly assembled = base.assembled();
    REQUIRE(assembled.has_moved);
    const core::constraint::AssemblyProblem problem = base.problem();
    const AssemblyGradient bar = AssemblyAdjoint(problem, assembled.dependent, base.written, assembled.poses).reverse(weights);

    for (int kind = 0; kind < 4; ++kind) {
        std::vector<Vector6> written_dot(n, Vector6::Zero());
        std::vector<core::measure::FrameGradient> frames_dot(base.model.mechanism.set.frames.size());
        VectorX targets_dot = VectorX::Zero(base.targets.size());
        std::vector<double> density_dot(n, 0.0);
        if (kind == 0)
            for (Vector6& d : written_dot) noise(d, 0.05);
        if (kind == 1)
            for (auto& f : frames_dot) {
                noise(f.point, 0.02);
                noise(f.axes, 0.05);
            }
        if (kind == 2) noise(targets_dot, 0.01);
        if (kind == 3)
            for (double& d : density_dot) d = 0.5 * unit(random);
        double derivative = bar.targets_bar.dot(targets_dot);
        for (std::size_t i = 0; i < n; ++i) {
            derivative += bar.written_bar[i].dot(written_dot[i]);
            derivative += density_dot[i] * bar.moments_bar[i].cwiseProduct(base.model.bodies[i].moments).sum();
        }
        for (std::size_t k = 0; k < frames_dot.size(); ++k)
            derivative += bar.frames[k].point.dot(frames_dot[k].point) + bar.frames[k].axes.cwiseProduct(frames_dot[k].axes).sum();
        const auto at = [&](double s) {
            Start moved = base;
            for (std::size_t i = 0; i < n; ++i) {
                moved.written[i].position += s * written_dot[i].head<3>();
                moved.written[i].rotation = core::kinematics::rotation(s * written_dot[i].tail<3>()) * moved.written[i].rotation;
                moved.model.bodies[i].moments *= 1 + s * density_dot[i];
            }
            for (std::size_t k = 0; k < frames_dot.size(); ++k) {
                moved.model.mechanism.set.frames[k].point += s * frames_dot[k].point;
                moved.model.mechanism.set.frames[k].axes += s * frames_dot[k].axes;
            }
            moved.targets += s * targets_dot;
            const Assembly there = moved.assembled();
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) sum += weights[i].cwiseProduct(pose_matrix(there.poses[i])).sum();
            return sum;
        };
        double error = INFINITY;
        for (const double s : {1e-2, 1e-3, 1e-4}) {
            const double difference = (at(s) - at(-s)) / (2 * s), finer = (at(s / 2) - at(-s / 2)) / s;
            error = std::min(error, std::abs((4 * finer - difference) / 3 - derivative));
        }
        CAPTURE(kind, derivative, error);
        CHECK(std::abs(derivative) > 1e-4);
        CHECK(error < 1e-7 * std::abs(derivative));
    }
}

}  // namespace fettle::adjoint::constraint::assembly_adjoint_test
