// SPDX-License-Identifier: MIT
// Motion without contact, by each integrator, against closed forms and against Euler's equations solved to rounding level.
#include <complex>

#include "tests/core/stepper/physics_models.hpp"

namespace fettle::core::stepper::free_motion_physics_test {

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using core::scene::Integrator;

namespace {

const double pi = std::acos(-1.0);
const std::vector<std::pair<Integrator, const char*>> integrators{
    {Integrator::implicit_euler, "implicit Euler"}, {Integrator::bdf2, "BDF2"}, {Integrator::newmark, "Newmark"}};

/// 0.1 x 0.2 x 0.3 m about its centre: three different moments of inertia, largest about x.
core::model::Body brick(const Vector3& spin, const Vector3& velocity = Vector3::Zero()) {
    core::model::Body body =
        make_body("brick", box_mesh({-0.05, -0.1, -0.15}, {0.05, 0.1, 0.15}), make_pose({0.3, -0.2, 0.5}, {0.1, 0.2, 0.3}));
    set_velocity(body, velocity, body.pose_start.rotation * spin);
    return body;
}

/// A rigid body about its centre of mass, under a constant torque in world axes: classical Runge-Kutta, small steps.
struct Gyroscope {
    Matrix3 inertia, rotation;
    Vector3 angular_momentum, torque;

    Gyroscope(const core::model::Body& body, const Vector3& spin)
        : inertia(physics_inertia(body)),
          rotation(body.pose_start.rotation),
          angular_momentum(rotation * (inertia * spin)),
          torque(body.torque) {}
    static Matrix3 physics_inertia(const core::model::Body& body) { return fettle::tests::physics::inertia(body); }

    void advance(double time, int steps) {
        const double h = time / steps;
        const auto rate = [&](const Matrix3& r, const Vector3& l) -> Matrix3 {
            return cross_matrix(r * inertia.inverse() * r.transpose() * l) * r;
        };
        for (int i = 0; i < steps; ++i) {
            const Vector3 middle = angular_momentum + h / 2 * torque, end = angular_momentum + h * torque;
            const Matrix3 k1 = rate(rotation, angular_momentum), k2 = rate(rotation + h / 2 * k1, middle),
                          k3 = rate(rotation + h / 2 * k2, middle), k4 = rate(rotation + h * k3, end);
            rotation += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
            angular_momentum = end;
        }
    }
};

/// Turning about a fixed principal axis: the step's minimum in the plane is P = P_hat / |P_hat|.
std::vector<double> planar_angles(Integrator integrator, double spin, double h, int steps) {
    using Complex = std::complex<double>;
    const Complex i(0, 1);
    Complex p = 1, v = i * spin, a = -spin * spin, p_before, v_before;
    std::vector<double> angles{0};
    double alpha = 0;
    for (int n = 0; n < steps; ++n) {
        Complex hat, slip;
        double slip_time = h;
        if (integrator == Integrator::newmark) {
            slip = p + h / 2 * v, slip_time = h / 2, hat = p + h * v + h * h / 4 * a;
        } else if (integrator == Integrator::bdf2 && n > 0) {
            slip = (4.0 * p - p_before) / 3.0, slip_time = 2 * h / 3, hat = slip + slip_time * (4.0 * v - v_before) / 3.0;
        } else {
            slip = p, hat = p + h * v;
        }
        const Complex next = hat / std::abs(hat);
        Complex v_next = (next - slip) / slip_time;
        a = (next - p - h * v) / (h * h / 4) - a;
        if (integrator == Integrator::newmark) {  // rigid: v = i w p, a = (i alpha - w^2) p, alpha from the balanced torque
            const double alpha_before = alpha, w_before = std::imag(std::conj(p) * v);
            alpha = std::imag(std::conj(next) * a);
            const double w = w_before + h / 2 * (alpha_before + alpha);
            v_next = i * w * next, a = (i * alpha - w * w) * next;
        }
        angles.push_back(angles.back() + std::arg(next / p));
        p_before = p, v_before = v;
        p = next, v = v_next;
    }
    return angles;
}

/// Errors at the end of 0.4 s, in rotation and position, with h halved again and again.
std::vector<double> free_flight_errors(Integrator integrator, const Vector3& torque) {
    const Vector3 spin(2, 5, 3), velocity(0.5, -1, 2);
    const double time = 0.4;
    core::model::Body body = brick(spin, velocity);
    body.torque = torque;
    Gyroscope exact(body, spin);
    exact.advance(time, 4000);
    const Vector3 end = body.pose_start.position + time * velocity + time * time / 2 * Vector3(0, 0, -gravity);
    std::vector<double> errors;
    for (int steps = 40; steps <= 320; steps *= 2) {
        core::model::Model model = world({body}, time / steps);
        model.integrator = integrator;
        const auto flight = run(model, steps, true);
        errors.push_back((rotation(flight, steps) - exact.rotation).norm() + (position(flight, steps) - end).norm());
    }
    return errors;
}

}  // namespace

TEST_CASE("Newmark's free fall is exact, BDF2's second order", "[physics]") {
    const core::model::Body body = brick(Vector3::Zero(), Vector3(0.5, 0, 2));
    std::vector<double> errors;
    for (const double h : {0.02, 0.01, 0.005}) {
        core::model::Model model = world({body}, h);
        const int steps = static_cast<int>(std::lround(1 / h));
        const Vector3 end = body.pose_start.position + Vector3(0.5, 0, 2 - gravity / 2);
        model.integrator = Integrator::newmark;
        CHECK((position(run(model, steps), steps) - end).norm() < 1e-11);
        model.integrator = Integrator::bdf2;
        errors.push_back((position(run(model, steps), steps) - end).norm());
    }
    CHECK(observed_order(errors) == Approx(2).margin(0.05));
}

TEST_CASE("integrators converge with their orders in free rotation and translation", "[physics]") {
    for (const auto& [integrator, name] : integrators) {
        const std::vector<double> errors = free_flight_errors(integrator, Vector3::Zero());
        INFO(name << ": errors " << errors[0] << " " << errors[1] << " " << errors[2] << " " << errors[3]);
        CHECK(observed_order(errors) > (integrator == Integrator::implicit_euler ? 0.9 : 1.9));
        CHECK(errors.back() < (integrator == Integrator::implicit_euler ? 0.1 : 2e-3));
    }
}

TEST_CASE("integrators converge with their orders under a torque", "[physics]") {
    for (const auto& [integrator, name] : integrators) {
        const std::vector<double> errors = free_flight_errors(integrator, Vector3(0.3, -0.2, 0.4));
        INFO(name << ": errors " << errors[0] << " " << errors[1] << " " << errors[2] << " " << errors[3]);
        CHECK(observed_order(errors) > (integrator == Integrator::implicit_euler ? 0.8 : 1.9));
    }
}

TEST_CASE("spin about a principal axis follows each integrator's recursion", "[physics]") {
    const double h = 0.01, spin = pi;
    for (const auto& [integrator, name] : integrators) {
        INFO(name);
        core::model::Body body = make_body("brick", box_mesh({-0.05, -0.1, -0.15}, {0.05, 0.1, 0.15}), {});
        set_velocity(body, Vector3::Zero(), Vector3(0, 0, spin));
        core::model::Model model = weightless({body}, h);
        model.integrator = integrator;
        const auto spinning = run(model, 200, true);
        const std::vector<double> angles = planar_angles(integrator, spin, h, 200);
        for (const int step : {1, 2, 50, 200})
            CHECK((rotation(spinning, step) - core::kinematics::rotation(Vector3(0, 0, angles[step]))).norm() < 1e-9);
    }
}

TEST_CASE("implicit Euler brakes a spin by h omega^2 per unit of time, the others to second order", "[physics]") {
    const double spin = pi, time = 1;
    for (const auto& [integrator, name] : integrators) {
        std::vector<double> losses;
        for (const double h : {0.02, 0.01, 0.005}) {
            core::model::Body body = make_body("brick", box_mesh({-0.05, -0.1, -0.15}, {0.05, 0.1, 0.15}), {});
            set_velocity(body, Vector3::Zero(), Vector3(0, 0, spin));
            core::model::Model model = weightless({body}, h);
            model.integrator = integrator;
            const int steps = static_cast<int>(std::lround(time / h));
            const auto spinning = run(model, steps, true);
            const Matrix3 turn = rotation(spinning, steps) * rotation(spinning, steps - 1).transpose();
            losses.push_back(1 - core::kinematics::rotation_vector(turn).z() / h / spin);
            if (integrator != Integrator::implicit_euler) continue;
            // After a step of angle phi comes one of phi - phi^3 + O(phi^5).
            CHECK(losses.back() == Approx(1 - 1 / std::sqrt(1 + 2 * h * spin * spin * time)).epsilon(h * spin));
        }
        INFO(name << ": relative losses " << losses[0] << " " << losses[1] << " " << losses[2]);
        CHECK(observed_order(losses) > (integrator == Integrator::implicit_euler ? 0.8 : 1.9));
        if (integrator != Integrator::implicit_euler) CHECK(losses.front() < 0.01);
    }
}

TEST_CASE("angular momentum is kept within the integrator's order", "[physics]") {
    const Vector3 spin(0.05, 6, 0.05);
    for (const auto& [integrator, name] : integrators) {
        std::vector<double> errors;
        for (const double h : {0.01, 0.005, 0.0025}) {
            core::model::Model model = weightless({brick(spin)}, h);
            model.integrator = integrator;
            const core::model::Body& body = model.bodies[0];
            const Vector3 start = body.pose_start.rotation * (inertia(body) * spin) +
                                  body.moments(3, 3) * body.pose_start.position.cross(body.velocity_start.col(3));
            const auto tumbling = run(model, static_cast<int>(std::lround(1 / h)), true);
            errors.push_back((tumbling.outputs.back().angular_momentum - start).norm() / start.norm());
        }
        INFO(name << ": relative errors " << errors[0] << " " << errors[1] << " " << errors[2]);
        CHECK(observed_order(errors) > (integrator == Integrator::implicit_euler ? 0.7 : 1.8));
        CHECK(errors.back() < (integrator == Integrator::implicit_euler ? 0.15 : 5e-3));
    }
}

TEST_CASE("Dzhanibekov's wing nut turns over when Euler's equations say", "[physics]") {
    // Spin about the middle axis (y: 1/12 m (0.1^2 + 0.3^2)), slightly off: it turns over again and again.
    const Vector3 spin(0.2, 2 * pi, 0.2);
    const core::model::Body body = brick(spin);
    core::model::Model model = weightless({body}, 0.0025);
    for (const auto& [integrator, tolerance] : {std::pair{Integrator::bdf2, 0.02}, std::pair{Integrator::newmark, 0.005}}) {
        model.integrator = integrator;
        const int steps = 3200;
        const auto tumbling = run(model, steps, true);
        const Vector3 axis = body.pose_start.rotation.col(1);
        std::vector<double> expected, found;
        Gyroscope exact(body, spin);
        double before_exact = 1, before = 1;
        for (int n = 1; n <= steps; ++n) {
            exact.advance(model.timestep, 10);
            const double now_exact = axis.dot(exact.rotation.col(1)), now = axis.dot(rotation(tumbling, n).col(1));
            if (now_exact * before_exact < 0) expected.push_back((n - now_exact / (now_exact - before_exact)) * model.timestep);
            if (now * before < 0) found.push_back((n - now / (now - before)) * model.timestep);
            before_exact = now_exact, before = now;
        }
        REQUIRE(expected.size() >= 3);
        REQUIRE(found.size() == expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(tolerance));
    }
}

TEST_CASE("energy: Newmark keeps it, BDF2 loses little, implicit Euler never gains any", "[physics]") {
    const Vector3 spin(2, 5, 3);
    for (const auto& [integrator, name] : integrators) {
        INFO(name);
        core::model::Model model = weightless({brick(spin)}, 0.005);
        model.integrator = integrator;
        const auto tumbling = run(model, 2000, true);
        const double start = 0.5 * spin.dot(inertia(model.bodies[0]) * spin);
        double lowest = start, highest = start, before = start;
        for (const auto& step : tumbling.outputs) {
            if (integrator == Integrator::implicit_euler) CHECK(step.kinetic_energy <= before * (1 + 1e-12));
            before = step.kinetic_energy;
            lowest = std::min(lowest, before), highest = std::max(highest, before);
        }
        if (integrator == Integrator::newmark) CHECK(highest - lowest < 1e-3 * start);
        if (integrator == Integrator::bdf2) CHECK(lowest > 0.9 * start);
    }
}

TEST_CASE("a torque about a held axis gives torque / inertia", "[physics]") {
    core::model::Body body = make_body("box", box_mesh({-0.5, -1, -1.5}, {0.5, 1, 1.5}), {});
    for (const int dof : {0, 1, 2, 3, 5}) prescribe(body, dof);
    body.torque = Vector3(0, 1000, 0);
    CHECK(inertia(body)(1, 1) == Approx(5000));
    core::model::Model model = weightless({body}, 0.01);
    const auto turning = run(model, 100, true);
    // theta_n = alpha h^2 n (n + 1) / 2 but for the chart's O(theta^2) of each step
    const double expected = 0.2 * 0.01 * 0.01 * 100 * 101 / 2;
    CHECK(core::kinematics::rotation_vector(rotation(turning, 100)).y() == Approx(expected).epsilon(2e-4));
}

TEST_CASE("a physical pendulum has its period", "[physics]") {
    const double amplitude = 0.2;
    core::model::Body body =
        make_body("rod", box_mesh({-0.01, -0.01, -0.4}, {0.01, 0.01, 0}), make_pose({0, amplitude, 0}, Vector3::Zero()));
    for (const int dof : {0, 1, 2, 3, 5}) prescribe(body, dof);
    // 2 pi sqrt(I / (m g d)), about the point of suspension, and the series for a finite amplitude
    const double period = 2 * pi * std::sqrt(inertia(body)(1, 1) / (body.moments(3, 3) * gravity * 0.2)) *
                          (1 + amplitude * amplitude / 16 + 11 * std::pow(amplitude, 4) / 3072);
    for (const auto& [integrator, name] : integrators) {
        INFO(name);
        core::model::Model model = world({body}, 0.0025);
        model.integrator = integrator;
        const int steps = static_cast<int>(3.3 * period / model.timestep);
        const auto swinging = run(model, steps, true);
        std::vector<double> zeros;
        double before = amplitude;
        for (int n = 1; n <= steps; ++n) {
            const double angle = core::kinematics::rotation_vector(rotation(swinging, n)).y();
            if (angle * before < 0) zeros.push_back((n - angle / (angle - before)) * model.timestep);
            before = angle;
        }
        REQUIRE(zeros.size() >= 5);
        const double error = integrator == Integrator::implicit_euler ? 5e-3 : 5e-4;
        CHECK(zeros[4] - zeros[0] == Approx(2 * period).epsilon(error));
    }
}

}  // namespace fettle::core::stepper::free_motion_physics_test
