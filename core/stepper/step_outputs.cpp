// SPDX-License-Identifier: MIT
#include "core/stepper/step_outputs.hpp"

#include <algorithm>
#include <limits>

#include "core/energy/body_terms.hpp"
#include "core/solver/newton.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::Pose;

// The solver leaves out the inertia and loads of bodies that it does not solve for. (Quasi-static steps have no inertia.)
Vector6 inertia_if_held(const energy::StepProblem& problem, std::size_t i, const kinematics::ChartPoint& point, const Pose& pose) {
    const model::Body& body = problem.model->bodies[i];
    bool held = body.moments(3, 3) > 0;
    for (int k = 0; k < 6; ++k) held = held && !is_free(body, k);
    if (!held) return Vector6::Zero();
    kinematics::PoseGradient gradient;
    if (problem.model->integrator == scene::Integrator::quasi_static)
        energy::add_gravity_gradient(problem, i, pose, gradient);
    else
        energy::add_inertia_gradient(pose, problem.pose_hat[i], body.moments, gradient);
    Vector6 out = tangent_gradient(gradient);
    out.head<3>() -= problem.weight * body.force;
    out.tail<3>() = kinematics::left_jacobian(point.rotation_vector).transpose() * out.tail<3>();
    return out;
}

// A chart's generalised force as force and torque about the body's reference point, world.
Vector6 out_of_chart(const Vector6& force, const Vector3& theta) {
    Vector6 out = force;
    out.tail<3>() = kinematics::left_jacobian(theta).transpose().inverse() * force.tail<3>();
    return out;
}

// What joints, gears and motors that are rows do to each body, of the sign of a gradient: force and torque about its reference point,
// world.
std::vector<Vector6> row_forces(const energy::StepProblem& problem, const solver::NewtonResult& solved) {
    const model::Mechanism& mechanism = problem.model->mechanism;
    std::vector<Vector6> out(problem.model->bodies.size(), Vector6::Zero());
    if (solved.multipliers.size() == 0) return out;
    const auto rows = row_jacobian(mechanism.set, mechanism.rows, placed(mechanism.set.frames, solved.poses));
    add_transposed(rows, solved.multipliers / problem.weight, out);
    return out;
}

// The forces that the solve has left unbalanced on each body, in the chart: of the prescribed coordinates what the drive supplies.
std::vector<Vector6> unbalanced(const energy::StepProblem& problem, const solver::NewtonResult& solved) {
    const auto& points = solved.path.back();
    std::vector<Vector6> out =
        energy::chart_derivatives(problem, points, solved.poses, solved.contacts, contact::HessianKind::none).gradient;
    const std::vector<Vector6> rows = row_forces(problem, solved);
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = (out[i] + inertia_if_held(problem, i, points[i], solved.poses[i])) / problem.weight;
        out[i].head<3>() += rows[i].head<3>();
        out[i].tail<3>() += kinematics::left_jacobian(points[i].rotation_vector).transpose() * rows[i].tail<3>();
    }
    return out;
}

// In world axes, out of the chart's.
std::vector<DriveForce> drive_forces(const model::Model& model, const std::vector<Vector6>& unbalanced,
                                     const std::vector<kinematics::ChartPoint>& points) {
    std::vector<DriveForce> out;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        Vector6 supplied = unbalanced[i];
        for (int k = 0; k < 6; ++k)
            if (is_free(model.bodies[i], k)) supplied[k] = 0;
        if (supplied.isZero(0)) continue;
        const Vector6 force = out_of_chart(supplied, points[i].rotation_vector);
        out.push_back({static_cast<int>(i), force.head<3>(), force.tail<3>()});
    }
    return out;
}

double drive_power(const std::vector<DriveForce>& drives, const energy::History& end) {
    double power = 0;
    for (const DriveForce& d : drives) {
        const auto i = static_cast<std::size_t>(d.body);
        power +=
            d.force.dot(end.velocities[i].col(3)) + d.torque.dot(kinematics::angular_velocity(end.poses[i].rotation, end.velocities[i]));
    }
    return power;
}

// The power of motors that are constraints: their effort along the rate of their joint's coordinate.
double motor_power(const model::Mechanism& mechanism, const std::vector<JointForce>& joints, const energy::History& end) {
    const auto is_motor = [&](const JointForce& f) { return mechanism.joints[f.joint].is_motor; };
    if (std::none_of(joints.begin(), joints.end(), is_motor)) return 0;
    const std::vector<double> rates = energy::measure_rates(mechanism.set, end.poses, end.velocities);
    double power = 0;
    for (const JointForce& f : joints)
        if (is_motor(f)) power += f.effort * rates[mechanism.joints[f.joint].coordinate];
    return power;
}

bool jumps(double before, double after, double least) {
    const double larger = std::max(std::abs(before), std::abs(after));
    return larger > least && std::abs(after - before) > 0.5 * larger;
}

// StepOutputs::drive_jumps. Rates that move nothing to speak of in a step are rounding.
bool drives_jump(const model::Model& model, const std::vector<JointForce>& joints, const energy::History& start,
                 const energy::History& end) {
    const double least_turn = 1e-9 / model.timestep, least_way = least_turn * model.diagonal;  // [rad/s], [m/s]
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        Vector6 before, after;
        before << start.velocities[i].col(3), kinematics::angular_velocity(start.poses[i].rotation, start.velocities[i]);
        after << end.velocities[i].col(3), kinematics::angular_velocity(end.poses[i].rotation, end.velocities[i]);
        for (int k = 0; k < 6; ++k)
            if (!is_free(model.bodies[i], k) && jumps(before[k], after[k], k < 3 ? least_way : least_turn)) return true;
    }
    const model::Mechanism& mechanism = model.mechanism;
    const auto is_motor = [&](const JointForce& f) { return mechanism.joints[f.joint].is_motor; };
    if (std::none_of(joints.begin(), joints.end(), is_motor)) return false;
    const std::vector<double> before = energy::measure_rates(mechanism.set, start.poses, start.velocities),
                              after = energy::measure_rates(mechanism.set, end.poses, end.velocities);
    return std::any_of(joints.begin(), joints.end(), [&](const JointForce& f) {
        const int k = mechanism.joints[f.joint].coordinate;
        const bool is_angle = is_motor(f) && mechanism.set.measures[k].kind == measure::MeasureKind::angle;
        return is_motor(f) && jumps(before[k], after[k], is_angle ? least_turn : least_way);
    });
}

// Force and torque about the body's reference point, about the world's origin.
Vector6 about_origin(Vector6 force, const Vector3& position) {
    force.tail<3>() += position.cross(force.head<3>());
    return force;
}

// The forces on a body beside gravity show in its inertia, less what the solve has left unbalanced.
void add_momentum_defects(const energy::StepProblem& problem, const solver::NewtonResult& solved, const std::vector<Vector6>& unbalanced,
                          const StepState& start, const StepState& end, StepOutputs& out) {
    const model::Model& model = *problem.model;
    const auto& points = solved.path.back();
    const double h = model.timestep;
    double angular_at_start = 0, angular_at_end = 0;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const model::Body& body = model.bodies[i];
        bool solved_for = true;
        for (int k = 0; k < 6; ++k) solved_for = solved_for && is_free(body, k);
        if (!solved_for || !(body.moments(3, 3) > 0)) continue;
        kinematics::PoseGradient inertia;
        energy::add_inertia_gradient(solved.poses[i], problem.pose_hat[i], body.moments, inertia);
        const Vector3 position = solved.poses[i].position, arm = solved.poses[i].rotation * body.moments.topRightCorner<3, 1>();
        Vector6 force = tangent_gradient(inertia) / problem.weight - out_of_chart(unbalanced[i], points[i].rotation_vector);
        const double reach = position.norm() + body.radius;
        out.angular_impulse += h * (force.head<3>().norm() * reach + force.tail<3>().norm());
        constexpr double unit = std::numeric_limits<double>::epsilon();
        out.angular_momentum_rounding += 16 * unit * body.moments(3, 3) * reach * reach / h;  // of poses, which velocities are made of
        force.head<3>() += body.moments(3, 3) * model.gravity;
        force.tail<3>() += arm.cross(model.gravity);
        const Vector6 before = energy::momenta(start.history.poses[i], start.history.velocities[i], body.moments);
        const Vector6 after = energy::momenta(end.history.poses[i], end.history.velocities[i], body.moments);
        const Vector6 defect = after - before - h * about_origin(force, position);
        angular_at_start += before.tail<3>().norm();
        angular_at_end += after.tail<3>().norm();
        out.momentum_defect += defect.head<3>();
        out.angular_momentum_defect += defect.tail<3>();
        for (const ContactForce& c : out.contacts)
            if (c.a == static_cast<int>(i) || c.b == static_cast<int>(i)) out.angular_impulse += h * (c.normal + c.friction.norm()) * reach;
    }
    out.angular_momentum_size = std::max(angular_at_start, angular_at_end);
    // Springs, dampers, friction and stops of joints, each by itself: what holds against a load leaves nothing in the sum of forces.
    const model::Mechanism& mechanism = model.mechanism;
    for (std::size_t k = 0; k < out.measure_forces.size(); ++k) {
        const measure::Measure& m = mechanism.set.measures[mechanism.terms[k].measure];
        for (const int frame : {m.a, m.b}) {
            const int body = mechanism.set.frames[frame].body;
            if (body == measure::world) continue;
            const double reach = solved.poses[body].position.norm() + model.bodies[body].radius;
            out.angular_impulse += h * std::abs(out.measure_forces[k]) * (m.kind == measure::MeasureKind::angle ? 1 : reach);
        }
    }
}

}  // namespace

energy::TermReport start_report(const model::Model& model, const StepState& state) {
    const energy::StepProblem problem = energy::step_problem(model, state.history, state.kappa);
    const std::vector<Pose>& poses = state.history.poses;
    const contact::ContactSet contacts = contact::find_contacts(model, ccd::find_candidates(model, poses, 0), poses);
    energy::TermReport report = energy::term_report({problem, poses, contacts, state.history});
    report.contacts.clear();
    report.measure_forces.clear();
    report.supplied_power = report.dissipated_power = 0;
    return report;
}

StepOutputs step_outputs(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved,
                         const StepState& start, const StepState& end) {
    energy::StepProblem last = problem;
    last.friction = solved.friction;
    StepOutputs out;
    static_cast<energy::TermReport&>(out) = energy::term_report({last, solved.poses, solved.contacts, end.history});
    out.time = end.time;
    out.kappa = problem.kappa;
    const std::vector<Vector6> left = unbalanced(last, solved);
    out.drives = drive_forces(model, left, solved.path.back());
    if (!model.mechanism.empty()) out.joints = joint_forces(last, solved.poses, solved.multipliers, out.measure_forces);
    if (model.integrator == scene::Integrator::quasi_static) return out;
    out.supplied_power += drive_power(out.drives, end.history) + motor_power(model.mechanism, out.joints, end.history);
    out.drive_jumps = drives_jump(model, out.joints, start.history, end.history);
    add_momentum_defects(last, solved, left, start, end, out);
    return out;
}

}  // namespace fettle::core::stepper
