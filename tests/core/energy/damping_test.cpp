// SPDX-License-Identifier: MIT
#include "fettle/core/energy/damping.hpp"

#include "fettle/core/energy/incremental_potential.hpp"
#include "fettle/core/energy/start_history.hpp"
#include "fettle/tests/core/stepper/physics_models.hpp"
#include "fettle/tests/support/derivative_check.hpp"

namespace fettle::core::energy::damping_test {

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

}  // namespace fettle::core::energy::damping_test
