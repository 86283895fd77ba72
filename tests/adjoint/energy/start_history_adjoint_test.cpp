// SPDX-License-Identifier: MIT
// Newmark's accelerations at the start: changes against differences of core's, gradients against changes.
#include "adjoint/energy/start_history_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/energy/start_history.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::adjoint::energy::start_history_adjoint_test {

using namespace fettle::tests::mechanisms;
using core::model::Model;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

// Two turning bars, with everything that acts along a distance between them. @param held  a coordinate of the first that is driven
Model bars(int held) {
    core::scene::Scene scene = loose_bars_scene();
    scene.integrator = core::scene::Integrator::newmark;
    scene.bodies[1].damping = {0.3, 0.2};
    Model model = built(scene);
    if (held >= 0) model.bodies[0].prescribed[held] = core::scene::MotionCurve{};
    return model;
}

// All that the accelerations follow from, at random.
struct Change {
    ModelTangent model;
    std::vector<Vector6> poses;  // (position, turn)
    std::vector<Matrix34> poses_dot;
    std::vector<Matrix4> moments_dot;

    Change(const Model& of, std::mt19937_64& random) : model(zero_model_tangent(of, 0)) {
        std::uniform_real_distribution<double> unit(-1, 1);
        const auto fill = [&](auto&& m, double size) {
            for (Eigen::Index k = 0; k < m.size(); ++k) m.reshaped()[k] = size * unit(random);
        };
        fill(model.gravity_dot, 1);
        for (std::size_t i = 0; i < of.bodies.size(); ++i) {
            BodyTangent& dot = model.bodies[i];
            fill(dot.velocity_start_dot, 1);
            fill(dot.force_dot, 1);
            fill(dot.torque_dot, 0.1);
            Vector6 pose;
            fill(pose, 0.1);
            const Matrix3& R = of.bodies[i].pose_start.rotation;
            poses_dot.emplace_back();
            poses_dot.back() << cross_matrix(pose.tail<3>()) * R, pose.head<3>();
            poses.push_back(pose);
            Matrix4 m;
            fill(m, 1);
            moments_dot.emplace_back(of.bodies[i].moments(3, 3) * 1e-3 * (m + m.transpose()));
        }
        MechanismTangent& m = model.mechanism;
        for (FrameGradient& frame : m.frames) {
            fill(frame.point, 0.02);
            fill(frame.axes, 0.05);
        }
        for (std::size_t k = 0; k < m.term_coefficient.size(); ++k) {
            const core::model::LawKind kind = of.mechanism.terms[k].kind;
            m.term_coefficient[k] = 0.3 * of.mechanism.terms[k].coefficient * unit(random);
            const bool has_reference = kind == core::model::LawKind::spring || kind == core::model::LawKind::stop;
            if (has_reference) m.term_reference[k] = 1e-3 * unit(random);
            for (double& v : m.term_values[k]) v = 0.3 * unit(random);
        }
    }

    Model moved(Model of, double s) const {
        of.gravity += s * model.gravity_dot;
        for (std::size_t i = 0; i < of.bodies.size(); ++i) {
            core::model::Body& body = of.bodies[i];
            const BodyTangent& dot = model.bodies[i];
            body.pose_start.position += s * poses[i].head<3>();
            body.pose_start.rotation = core::kinematics::rotation(s * poses[i].tail<3>()) * body.pose_start.rotation;
            body.velocity_start += s * dot.velocity_start_dot;
            body.force += s * dot.force_dot;
            body.torque += s * dot.torque_dot;
            body.moments += s * moments_dot[i];
        }
        for (std::size_t i = 0; i < of.mechanism.set.frames.size(); ++i) {
            of.mechanism.set.frames[i].point += s * model.mechanism.frames[i].point;
            of.mechanism.set.frames[i].axes += s * model.mechanism.frames[i].axes;
        }
        for (std::size_t k = 0; k < of.mechanism.terms.size(); ++k) {
            core::model::MeasureTerm& term = of.mechanism.terms[k];
            term.coefficient += s * model.mechanism.term_coefficient[k];
            term.reference += s * model.mechanism.term_reference[k];
            for (std::size_t i = 0; i < term.curve.values.size(); ++i) term.curve.values[i] += s * model.mechanism.term_values[k][i];
        }
        return of;
    }

private:
    using FrameGradient = core::measure::FrameGradient;
};

VectorX packed(const std::vector<Matrix34>& all) {
    VectorX out(12 * static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) out.segment<12>(12 * static_cast<Eigen::Index>(i)) = all[i].reshaped();
    return out;
}

double pairing(const Change& change, const std::vector<Matrix34>& poses_bar, const std::vector<Matrix4>& moments_bar,
               const ModelGradient& bar) {
    double sum = bar.gravity_bar.dot(change.model.gravity_dot);
    for (std::size_t i = 0; i < poses_bar.size(); ++i) {
        const BodyTangent& dot = change.model.bodies[i];
        sum += poses_bar[i].cwiseProduct(change.poses_dot[i]).sum() + moments_bar[i].cwiseProduct(change.moments_dot[i]).sum();
        sum += bar.bodies[i].velocity_start_bar.cwiseProduct(dot.velocity_start_dot).sum();
        sum += bar.bodies[i].force_bar.dot(dot.force_dot) + bar.bodies[i].torque_bar.dot(dot.torque_dot);
    }
    const MechanismTangent& dot = change.model.mechanism;
    for (std::size_t i = 0; i < dot.frames.size(); ++i)
        sum += bar.mechanism.frames[i].point.dot(dot.frames[i].point) + bar.mechanism.frames[i].axes.cwiseProduct(dot.frames[i].axes).sum();
    for (std::size_t k = 0; k < dot.term_coefficient.size(); ++k) {
        sum += bar.mechanism.term_coefficient[k] * dot.term_coefficient[k] + bar.mechanism.term_reference[k] * dot.term_reference[k];
        for (std::size_t i = 0; i < dot.term_values[k].size(); ++i) sum += bar.mechanism.term_values[k][i] * dot.term_values[k][i];
    }
    return sum;
}

}  // namespace

TEST_CASE("the start's accelerations with springs: their changes and gradients", "[adjoint][joints]") {
    std::mt19937_64 random(13);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const int held : {-1, 1, 5}) {
        const Model model = bars(held);
        const Change change(model, random);
        const std::vector<Matrix34> tangent = start_accelerations_tangent(model, {change.model, change.poses_dot, change.moments_dot});
        const auto along = [&](const VectorX& s) { return packed(core::energy::start_history(change.moved(model, s[0])).accelerations); };
        CAPTURE(held);
        CHECK(
            tests::support::check_directional(along, VectorX::Zero(1), VectorX::Ones(1), packed(tangent), {1e-3, 0.25, 8}).relative_error <
            1e-8);
        std::vector<std::vector<Matrix34>> bar(1), poses_bar(1, std::vector<Matrix34>(2, Matrix34::Zero()));
        for (int i = 0; i < 2; ++i) bar[0].push_back(Matrix34::NullaryExpr([&] { return unit(random); }));
        std::vector<std::vector<Matrix4>> moments_bar(1, std::vector<Matrix4>(2, Matrix4::Zero()));
        std::vector<ModelGradient> model_bar{zero_model_gradient(model, 0)};
        start_accelerations_adjoint(model, bar, {poses_bar, moments_bar, model_bar});
        const double forwards = packed(bar[0]).dot(packed(tangent));
        CHECK(pairing(change, poses_bar[0], moments_bar[0], model_bar[0]) == Approx(forwards).epsilon(1e-12));
    }
}

}  // namespace fettle::adjoint::energy::start_history_adjoint_test
