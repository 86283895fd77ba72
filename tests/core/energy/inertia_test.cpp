// SPDX-License-Identifier: MIT
#include "fettle/core/energy/inertia.hpp"

#include <catch2/catch.hpp>

#include "fettle/core/energy/incremental_potential.hpp"
#include "fettle/core/energy/mass_matrix.hpp"
#include "fettle/core/energy/start_history.hpp"
#include "fettle/core/linear/factorisations.hpp"
#include "fettle/tests/support/derivative_check.hpp"
#include "fettle/tests/support/test_models.hpp"

namespace fettle::core::energy::inertia_test {

using namespace fettle::tests::support;
using kinematics::pose_matrix;

namespace {

// Off centre, so that the first moments couple position and rotation.
const model::Body& brick() {
    static const model::Body body = make_body("brick", box_mesh({-0.1, -0.2, 0}, {0.5, 0.3, 0.4}), make_pose({0.3, -0.5, 0.2}, {1, 2, 3}));
    return body;
}

Matrix34 hat() { return pose_matrix(make_pose({0.2, -0.4, 0.4}, {1.1, 1.9, 3.05})); }

kinematics::Pose plus(const kinematics::Pose& pose, const VectorX& d) {
    return {kinematics::rotation(d.tail<3>()) * pose.rotation, pose.position + d.head<3>()};
}

}  // namespace

TEST_CASE("inertia of a translation, and of nothing", "[inertia]") {
    const model::Body& body = brick();
    const Matrix34 P = pose_matrix(body.pose_start);
    Matrix34 target = P;
    target.col(3) -= Vector3(1, 2, -2);
    CHECK(inertia_potential(P, target, body.moments) == Approx(0.5 * body.moments(3, 3) * 9));
    CHECK(inertia_potential(P, P, body.moments) == 0);
    CHECK(inertia_potential(P, target, Matrix4::Zero()) == 0);
    kinematics::PoseGradient gradient;
    add_inertia_gradient(body.pose_start, target, body.moments, gradient);
    CHECK((gradient.force - body.moments(3, 3) * Vector3(1, 2, -2)).norm() < 1e-10);
}

TEST_CASE("the mass matrix of a box is the textbook's", "[inertia]") {
    const double a = 0.2, b = 0.4, c = 0.6, mass = 1000 * a * b * c;
    const model::Body box = make_body("box", box_mesh({-a / 2, -b / 2, -c / 2}, {a / 2, b / 2, c / 2}), {});
    Matrix6 expected = Matrix6::Zero();
    expected.diagonal() << mass, mass, mass, mass / 12 * (b * b + c * c), mass / 12 * (a * a + c * c), mass / 12 * (a * a + b * b);
    CHECK((mass_matrix(Matrix3::Identity(), box.moments) - expected).norm() < 1e-12 * expected.norm());
    // Turned with the body; positive definite off centre too.
    const Matrix3 R = kinematics::rotation(Vector3(0.3, 1, -2));
    const Matrix6 turned = mass_matrix(R, box.moments);
    CHECK((turned.bottomRightCorner<3, 3>() - R * expected.bottomRightCorner<3, 3>() * R.transpose()).norm() < 1e-12 * expected.norm());
    CHECK(linear::symmetric_eigenvalues<6>(mass_matrix(R, brick().moments)).minCoeff() > 0);
}

TEST_CASE("inertia's derivatives agree with differences", "[inertia]") {
    const model::Body& body = brick();
    const auto value = [&](const VectorX& d) { return inertia_potential(pose_matrix(plus(body.pose_start, d)), hat(), body.moments); };
    kinematics::PoseGradient gradient;
    add_inertia_gradient(body.pose_start, hat(), body.moments, gradient);
    CHECK(check_gradient(value, VectorX::Zero(6), tangent_gradient(gradient)).relative_error < 1e-8);
    CHECK(check_taylor(value, VectorX::Zero(6), tangent_gradient(gradient), VectorX::Ones(6)).ok());
    // In the chart at theta = 0 the Hessian is the mass matrix and the curvature of the rotation.
    const auto chart_gradient = [&](const VectorX& d) {
        kinematics::PoseGradient g;
        add_inertia_gradient(plus(body.pose_start, d), hat(), body.moments, g);
        Vector6 out = tangent_gradient(g);
        out.tail<3>() = kinematics::left_jacobian(d.tail<3>()).transpose() * out.tail<3>();
        return VectorX(out);
    };
    Matrix6 hessian = mass_matrix(body.pose_start.rotation, body.moments);
    hessian.bottomRightCorner<3, 3>() += kinematics::tangent_curvature(gradient.arm);
    CHECK(check_jacobian(chart_gradient, VectorX::Zero(6), hessian).relative_error < 1e-7);
}

TEST_CASE("inertia depends on nothing but the motion", "[inertia]") {
    const model::Body& body = brick();
    const Matrix3 Q = kinematics::rotation(Vector3(-1, 0.5, 2));
    const Vector3 shift(3, -1, 7);
    Matrix34 pose = Q * pose_matrix(body.pose_start), target = Q * hat();
    pose.col(3) += shift;
    target.col(3) += shift;
    const double here = inertia_potential(pose_matrix(body.pose_start), hat(), body.moments);
    CHECK(inertia_potential(pose, target, body.moments) == Approx(here).epsilon(1e-12));
}

TEST_CASE("each term's gradient is that of its value, and held bodies have none of their own", "[terms]") {
    model::Model model;
    model.bodies = {brick(), make_body("held", box_mesh({0, 0, 0}, {1, 1, 1}), make_pose(Vector3::Zero(), {5, 0, 0}))};
    for (int k = 0; k < 6; ++k) prescribe(model.bodies[1], k);
    model.gravity = {0, 0, -9.8};
    model.kappa = 1;
    for (model::Body& body : model.bodies) {
        body.force = {3, -2, 5};
        body.torque = {1, 4, -2};
    }
    const StepProblem problem = step_problem(model, start_history(model), model.kappa);
    const auto points_at = [&](const VectorX& d) {
        return std::vector<kinematics::ChartPoint>{{brick().pose_start.position + d.head<3>(), d.tail<3>()},
                                                   {model.bodies[1].pose_start.position, Vector3(Vector3::Zero())}};
    };
    const VectorX at = VectorX::LinSpaced(6, -0.2, 0.3);
    const auto poses = poses_of(problem, points_at(at));
    const auto check = [&](const char* name, const auto& value, Vector6 gradient, const Vector3& chart_gradient) {
        INFO(name);
        gradient.tail<3>() = kinematics::left_jacobian(at.tail<3>()).transpose() * gradient.tail<3>() + chart_gradient;
        CHECK(check_gradient(value, at, gradient).relative_error < 1e-7);
    };
    const DerivativesAt here{problem, poses, {}, contact::HessianKind::exact};
    for (const BodyTerm* term : body_terms()) {
        const auto value_of = [&](const VectorX& d, std::size_t body) {
            const auto points = points_at(d);
            double value = 0;
            term->add_value({problem, points, poses_of(problem, points), {}}, body, value);
            return value;
        };
        std::array<BodyDerivatives, 2> d;
        for (const std::size_t body : {0, 1}) term->add_derivatives(here, body, d[body]);
        check(
            term->name, [&](const VectorX& x) { return value_of(x, 0); }, tangent_gradient(d[0].gradient), d[0].chart_gradient);
        CHECK(value_of(at, 1) == 0);
        CHECK(d[1].gradient.force == Vector3::Zero());
        CHECK(d[1].magnitude == 0);
    }
    for (const CouplingTerm* term : coupling_terms()) {
        const auto value = [&](const VectorX& d) {
            const auto points = points_at(d);
            return term->value({problem, points, poses_of(problem, points), {}});
        };
        CouplingDerivatives d;
        d.gradient.resize(2);
        d.hessian.diagonal.assign(2, Matrix6::Zero());
        term->add_derivatives(here, d);
        check(term->name, value, tangent_gradient(d.gradient[0]), Vector3::Zero());
    }
}

TEST_CASE("the report has the energies and momenta of a moving body", "[terms]") {
    model::Model model;
    const double m = 1000 * 0.2 * 0.4 * 0.6;
    model.bodies = {make_body("box", box_mesh({-0.1, -0.2, -0.3}, {0.1, 0.2, 0.3}), make_pose(Vector3::Zero(), {0, 2, 5}))};
    set_velocity(model.bodies[0], {3, 0, 0}, {0, 0, 2});
    model.gravity = {0, 0, -10};
    model.bodies[0].force = {0, 1, 0};
    model.kappa = 1;
    const History start = start_history(model);
    const StepProblem problem = step_problem(model, start, model.kappa);
    const TermReport report = term_report({problem, start.poses, {}, start});
    const double about_z = m / 12 * (0.04 + 0.16);
    CHECK(report.kinetic_energy == Approx(0.5 * m * 9 + 0.5 * about_z * 4));
    CHECK(report.potential_energy == Approx(m * 10 * 5 - 2));
    CHECK(report.contact_energy == 0);
    CHECK((report.linear_momentum - Vector3(3 * m, 0, 0)).norm() < 1e-10);
    CHECK((report.angular_momentum - Vector3(0, 15 * m, 2 * about_z - 6 * m)).norm() < 1e-9);
    CHECK(report.contacts.empty());
}

TEST_CASE("forces between bodies are listed once for each pair, in order", "[terms]") {
    TermReport report;
    force_between(report, 4, 1).normal = 1;
    force_between(report, 0, 7).normal = 2;
    force_between(report, 1, 4).normal += 5;
    force_between(report, 1, 2).normal = 3;
    REQUIRE(report.contacts.size() == 3);
    CHECK((report.contacts[0].a == 0 && report.contacts[0].b == 7 && report.contacts[0].normal == 2));
    CHECK((report.contacts[1].a == 1 && report.contacts[1].b == 2 && report.contacts[1].normal == 3));
    CHECK((report.contacts[2].a == 1 && report.contacts[2].b == 4 && report.contacts[2].normal == 6));
}

}  // namespace fettle::core::energy::inertia_test
