// SPDX-License-Identifier: MIT
#include "core/energy/body_terms.hpp"

#include <catch2/catch.hpp>

#include "core/energy/incremental_potential.hpp"
#include "core/energy/start_history.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/linear/factorisations.hpp"
#include "tests/core/stepper/physics_models.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::energy::body_terms_test {

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
    CHECK((kinematics::mass_matrix(Matrix3::Identity(), box.moments) - expected).norm() < 1e-12 * expected.norm());
    // Turned with the body; positive definite off centre too.
    const Matrix3 R = kinematics::rotation(Vector3(0.3, 1, -2));
    const Matrix6 turned = kinematics::mass_matrix(R, box.moments);
    CHECK((turned.bottomRightCorner<3, 3>() - R * expected.bottomRightCorner<3, 3>() * R.transpose()).norm() < 1e-12 * expected.norm());
    CHECK(linear::symmetric_eigenvalues<6>(kinematics::mass_matrix(R, brick().moments)).minCoeff() > 0);
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
    Matrix6 hessian = kinematics::mass_matrix(body.pose_start.rotation, body.moments);
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
        CouplingDerivatives d(2);
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

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using scene::Integrator;

namespace {

model::Body brick(const Vector3& shift) {
    model::Body body = make_body("brick", box_mesh(shift - Vector3(0.1, 0.05, 0.02), shift + Vector3(0.1, 0.05, 0.02)),
                                 make_pose(Vector3(0.2, -0.3, 0.4), Vector3(0, 0, 1)));
    body.damping = {3, 5};
    return body;
}

}  // namespace

TEST_CASE("damping's moments give the force at the centre of mass and the torque about it", "[damping]") {
    const model::Body body = brick({0.03, -0.02, 0.05});
    const Matrix4 c = energy::damping_moments(body);
    const double mass = body.moments(3, 3);
    const Vector3 centre = body.moments.col(3).head<3>() / mass, v(0.3, -1, 0.7), omega(2, -0.5, 1);
    const Matrix3 R = body.pose_start.rotation;
    // Velocities of the reference point and of the turn; the centre moves with v + omega x (R centre).
    Matrix34 velocity;
    velocity << cross_matrix(omega) * R, v;
    const Matrix34 g = velocity * c;
    const Vector6 resistance = kinematics::tangent_gradient({g.col(3), g.leftCols<3>() * R.transpose()});
    const Vector3 arm = R * centre, force = body.damping.linear * mass * (v + omega.cross(arm));
    const Matrix4 about =
        body.moments - mass * (Eigen::Vector4d() << centre, 1).finished() * (Eigen::Vector4d() << centre, 1).finished().transpose();
    const Matrix3 second = R * about.topLeftCorner<3, 3>() * R.transpose();
    const Vector3 torque = body.damping.angular * (second.trace() * Matrix3::Identity() - second) * omega + arm.cross(force);
    CHECK((resistance.head<3>() - force).norm() < 1e-12 * force.norm());
    CHECK((resistance.tail<3>() - torque).norm() < 1e-12 * torque.norm());
}

TEST_CASE("a damped body slows down as each integrator's recursion says", "[damping]") {
    const double c = 3, h = 0.01;
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark}) {
        model::Model model = weightless({brick({0.03, -0.02, 0.05})}, h);
        model.bodies[0].damping = {c, 0};
        for (const int dof : {3, 4, 5}) prescribe(model.bodies[0], dof);
        model.integrator = integrator;
        set_velocity(model.bodies[0], Vector3(1, -2, 0.5), Vector3::Zero());
        const auto glide = run(model, 50, true);
        const double factor = integrator == Integrator::newmark ? (1 - 0.5 * c * h) / (1 + 0.5 * c * h) : 1 / (1 + c * h);
        for (const int n : {1, 10, 50}) {
            const Vector3 v = glide.outputs[n - 1].linear_momentum / model.bodies[0].moments(3, 3);
            CHECK((v - std::pow(factor, n) * Vector3(1, -2, 0.5)).norm() < 1e-9);
        }
    }
}

TEST_CASE("damped motion tends to its exponential with the integrator's order", "[damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
        std::vector<double> turn, way;
        for (const double h : {0.02, 0.01, 0.005, 0.0025}) {
            model::Model model = weightless({brick(Vector3::Zero())}, h);
            model.integrator = integrator;
            const Vector3 axis = model.bodies[0].pose_start.rotation.col(0);  // a principal axis: it keeps its direction
            set_velocity(model.bodies[0], Vector3(1, 0, 0), 0.5 * axis);
            const int steps = static_cast<int>(std::lround(0.4 / h));
            const auto motion = run(model, steps, true);
            const Matrix3 turned = rotation(motion, steps) * rotation(motion, 0).transpose();
            turn.push_back(std::abs(kinematics::rotation_vector(turned).dot(axis) - 0.5 * (1 - std::exp(-5 * 0.4)) / 5));
            way.push_back(std::abs(position(motion, steps).x() - (1 - std::exp(-3 * 0.4)) / 3));
        }
        const double order = integrator == Integrator::implicit_euler ? 0.9 : 1.8;
        CAPTURE(static_cast<int>(integrator), turn, way);
        CHECK(observed_order(turn) > order);
        CHECK(observed_order(way) > order);
    }
}

TEST_CASE("damping's and gravity's derivatives agree with differences", "[damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark, Integrator::quasi_static}) {
        model::Model model = world({brick({0.03, -0.02, 0.05})}, 0.1);
        model.integrator = integrator;
        model.proximal_weight = 0.3;
        model.bodies[0].damping = {30, 50};
        set_velocity(model.bodies[0], Vector3(1, -2, 0.5), Vector3(2, 1, -1));
        energy::StepProblem problem = energy::step_problem(model, energy::start_history(model), model.kappa);
        const auto points_at = [&](const VectorX& y) {
            return std::vector<kinematics::ChartPoint>{{problem.poses_t0[0].position + y.head<3>(), y.tail<3>()}};
        };
        const ccd::Candidates none = ccd::find_candidates(model, problem.poses_t0, 0);
        const auto value = [&](const VectorX& y) {
            const auto points = points_at(y);
            return energy::incremental_potential(problem, points, poses_of(problem, points), {});
        };
        const auto derivatives = [&](const VectorX& y) {
            const auto points = points_at(y);
            const auto poses = poses_of(problem, points);
            return energy::chart_derivatives(problem, points, poses, contact::find_contacts(model, none, poses),
                                             contact::HessianKind::exact);
        };
        const VectorX y = (Vector6() << 0.02, -0.03, 0.01, 0.3, -0.2, 0.4).finished();
        CAPTURE(static_cast<int>(integrator));
        CHECK(check_gradient(value, y, derivatives(y).gradient[0]).relative_error < 1e-7);
        const auto gradient = [&](const VectorX& at) { return VectorX(derivatives(at).gradient[0]); };
        CHECK(check_jacobian(gradient, y, derivatives(y).hessian.diagonal[0]).relative_error < 1e-7);
    }
}

}  // namespace fettle::core::energy::body_terms_test
