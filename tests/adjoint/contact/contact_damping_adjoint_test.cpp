// SPDX-License-Identifier: MIT
// The damping of contacts along a motion of the bodies, as it depends on the shapes and on where the step started, against differences.
#include "adjoint/contact/contact_damping_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "core/energy/step_problem.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::contact::contact_damping_adjoint_test {

using namespace fettle::tests;

namespace {

using core::contact::ContactSet;
using core::kinematics::Pose;
using core::model::Model;

struct Step {
    Model model;
    std::vector<Pose> end;
    std::vector<Matrix34> start;
};

// @param parallel  an edge along an edge, so that pairs are mollified at the end, at the start or at both; else corner and edges on a face
Step step_of(bool parallel, double twist, double twist_before) {
    Step step;
    Model& model = step.model;
    model.dhat = 5e-3;
    model.timestep = 0.01;
    model.kappa = 1e4;
    model.contact_damping_time = 0.02;
    model.bodies = {support::make_body("lower", support::box_mesh({-0.05, -0.06, -0.04}, {0.05, 0.04, 0}), {}),
                    support::make_body("upper", support::box_mesh({-0.04, -0.04, 0}, {0.07, 0.05, 0.05}), {})};
    const double height = parallel ? 0.0034 : 0.0385;
    const auto upper = [&](double turn, double lift) {
        return parallel ? support::make_pose({0.003, -0.002, turn}, {-0.0195, 0, height + lift})
                        : support::make_pose({0.4, 0.5, turn}, {-0.02, 0.01, height + lift});
    };
    // Turned together, so that no axis is special.
    const Pose frame = support::make_pose({0.1, 0.2, -0.1}, {0.01, 0, 0});
    const auto placed = [&](const Pose& pose) { return Pose{frame.rotation * pose.rotation, world_position(frame, pose.position)}; };
    step.end = {placed({}), placed(upper(twist, 0))};
    step.start = {pose_matrix(placed(support::make_pose({0.002, 0.001, 0}, {1e-4, 0, -3e-4}))),
                  pose_matrix(placed(upper(twist_before, 4e-4)))};
    return step;
}

core::contact::ContactDamping damping_of(const Step& step) {
    core::contact::ContactDamping damping;
    damping.start = step.start;
    const double h = step.model.timestep;
    set_contact_damping(step.model.contact_damping_time / h,
                        core::contact::barrier_parameters(step.model.dhat, step.model.dmin, step.model.kappa, h * h), damping);
    return damping;
}

ContactSet contacts_of(const Step& step) {
    return core::contact::find_contacts(step.model, core::ccd::find_candidates(step.model, step.end, 0), step.end);
}

// Coordinates: the vertices of both bodies, then the entries of both start matrices.
int count(const Step& step) {
    return 3 * static_cast<int>(step.model.bodies[0].mesh.vertices.cols() + step.model.bodies[1].mesh.vertices.cols()) + 24;
}

Step moved(const Step& step, const VectorX& d) {
    Step out = step;
    Eigen::Index at = 0;
    for (auto& body : out.model.bodies)
        for (Eigen::Index j = 0; j < body.mesh.vertices.cols(); ++j, at += 3) body.mesh.vertices.col(j) += d.segment<3>(at);
    for (auto& body : out.model.bodies) support::refresh(body);
    for (Matrix34& start : out.start) {
        start += d.segment<12>(at).reshaped(3, 4);
        at += 12;
    }
    return out;
}

// r = sum a f_i . v_i, through the potential's pose gradients.
double residual_along(const Step& step, const std::vector<Vector6>& lambda) {
    std::vector<core::kinematics::PoseGradient> gradients(2);
    core::kinematics::BlockHessian hessian;
    hessian.diagonal.assign(2, Matrix6::Zero());
    add_contact_damping_derivatives({step.model, contacts_of(step), damping_of(step)}, step.end, core::contact::HessianKind::exact,
                                    gradients, hessian);
    return tangent_gradient(gradients[0]).dot(lambda[0]) + tangent_gradient(gradients[1]).dot(lambda[1]);
}

struct Mollified {
    int end = 0, start = 0;
};
Mollified mollified(const Step& step) {
    Mollified out;
    const auto damping = damping_of(step);
    for (const auto& list : contacts_of(step).pairs)
        for (const auto& pair : list.contacts) {
            const auto damped = damped_pair(step.model, damping, list, pair);
            out.end += is_mollified(damped.end);
            out.start += is_mollified(damped.start) && damped.start.closest.distance_squared < step.model.dhat * step.model.dhat;
        }
    return out;
}

void check_step(const Step& step) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto number = [&] { return uniform(random); };
    const ContactSet contacts = contacts_of(step);
    REQUIRE(contacts.count > 0);
    std::vector<std::vector<Vector6>> lambda(3, std::vector<Vector6>(2));
    for (auto& seed : lambda)
        for (Vector6& motion : seed) motion << 0.05 * Vector3::NullaryExpr(number), Vector3::NullaryExpr(number);
    const core::contact::ContactDamping damping = damping_of(step);
    const DampedContacts at{step.model, contacts, step.end, damping};
    std::vector<ModelGradient> bar(3, zero_model_gradient(step.model, 0));
    std::vector<std::vector<Matrix34>> start_bar(3, std::vector<Matrix34>(2, Matrix34::Zero()));
    std::vector<std::vector<AreaChange>> no_areas(3);
    subtract_contact_damping_adjoint(at, lambda, {start_bar, no_areas, bar});
    const VectorX zero = VectorX::Zero(count(step)), d = VectorX::NullaryExpr(count(step), number);
    ModelTangent direction = zero_model_tangent(step.model, 0);
    direction.bodies[0].vertices_dot = d.head(24).reshaped(3, 8);
    direction.bodies[1].vertices_dot = d.segment(24, 24).reshaped(3, 8);
    const std::vector<Matrix34> start_dot{d.segment<12>(48).reshaped(3, 4), d.segment<12>(60).reshaped(3, 4)};
    PoseGradientTangent tangent{{2, Matrix34::Zero()}, {2, Matrix34::Zero()}};
    const std::vector<Matrix34> still(2, Matrix34::Zero());
    add_contact_damping_tangent(at, {still, start_dot, {}}, direction, tangent);
    for (int s = 0; s < 3; ++s) {
        VectorX gradient(count(step));
        gradient << bar[s].bodies[0].vertices_bar.reshaped(), bar[s].bodies[1].vertices_bar.reshaped(), start_bar[s][0].reshaped(),
            start_bar[s][1].reshaped();
        gradient = -gradient;
        const auto value = [&](const VectorX& x) { return residual_along(moved(step, x), lambda[s]); };
        const support::StepSweep sweep{1e-5, 0.25, 8};
        CHECK(gradient.head(48).norm() > 0);
        CHECK(gradient.tail(24).norm() > 0);
        if (s == 0) CHECK(support::check_gradient(value, zero, gradient, sweep).relative_error < 1e-6);
        // Along the gradient's parts: a wrong part that is large cannot hide in an average.
        for (const bool starts : {false, true}) {
            VectorX along = gradient;
            starts ? along.head(48).setZero() : along.tail(24).setZero();
            const double slope = along.norm();
            along.normalize();
            const auto directional = [&](const VectorX& x) { return VectorX::Constant(1, value(x)); };
            CHECK(support::check_directional(directional, zero, along, VectorX::Constant(1, slope), sweep).relative_error < 1e-7);
        }
        double forward = 0;
        for (int i = 0; i < 2; ++i) {
            Matrix34 v;
            v << cross_matrix(lambda[s][i].tail<3>()) * step.end[i].rotation, lambda[s][i].head<3>();
            forward += tangent.dot[i].cwiseProduct(v).sum();
        }
        CHECK(forward == Approx(gradient.dot(d)).epsilon(1e-11));
    }
}

}  // namespace

TEST_CASE("contact damping follows vertices and start: corner, edges and face", "[adjoint][contact]") {
    const Step step = step_of(false, 0.3, 0.29);
    CHECK(mollified(step).end == 0);
    check_step(step);
}

TEST_CASE("contact damping follows vertices and start: nearly parallel edges", "[adjoint][contact]") {
    for (const auto& [twist, before] : {std::pair(0.012, 0.004), std::pair(0.02, 0.05), std::pair(0.05, 0.012)}) {
        CAPTURE(twist, before);
        const Step step = step_of(true, twist, before);
        const Mollified pairs = mollified(step);
        CHECK((pairs.end > 0 || twist > 0.03));
        CHECK((pairs.start > 0 || before > 0.03));
        check_step(step);
    }
}

}  // namespace fettle::adjoint::contact::contact_damping_adjoint_test
