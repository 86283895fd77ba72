// SPDX-License-Identifier: MIT
#include "tests/adjoint/stepper/sweep_scenes.hpp"

#include <functional>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "adjoint/model/body_mass_adjoint.hpp"
#include "core/contact/contact_set.hpp"
#include "core/model/body_mass.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::tests::adjoint {
namespace {

using core::kinematics::Pose;
using core::model::Body;
using core::model::Model;
using core::scene::BodyType;
using support::box_mesh;
using support::make_body;
using support::make_pose;
using support::prescribe;

constexpr double size = 0.05;  // of the parts in these scenes [m]

Model base_model() {
    Model model;
    model.gravity = {0.3, -0.2, -9.81};
    model.timestep = 0.01;
    model.dhat = 2e-3;
    model.kappa = 2e4;
    model.velocity_tolerance = 1e-6;
    model.diagonal = 1;
    return model;
}

Matrix34 velocity_matrix(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 p;
    p << cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return p;
}

// With an entry at each step, and where the curve itself has some; its increments over steps changed by these.
core::scene::MotionCurve moved_curve(const core::scene::MotionCurve& curve, double timestep, int steps,
                                     const std::function<double(int)>& increment) {
    core::scene::MotionCurve out;
    std::vector<double> inside = curve.times;
    if (curve.stop_time) inside.push_back(*curve.stop_time);
    double sum = 0;
    for (int t = 0; t <= steps; ++t) {
        const double time = t * timestep;
        out.times.push_back(time);
        out.values.push_back(core::scene::motion_value(curve, time) + sum);
        if (t == steps) break;
        for (const double at : inside) {
            const double share = (at - time) / timestep;
            if (!(share > 1e-6 && share < 1 - 1e-6)) continue;
            out.times.push_back(at);
            out.values.push_back(core::scene::motion_value(curve, at) + sum + share * increment(t));
        }
        sum += increment(t);
    }
    return out;
}

}  // namespace

SweepScene free_flight() {
    SweepScene scene{"free flight", base_model(), 12};
    scene.model.bodies.push_back(
        make_body("brick", box_mesh({-0.02, -0.05, 0.01}, {0.06, 0.03, 0.04}), make_pose({0.3, -0.4, 0.8}, {0, 0, 1})));
    support::set_velocity(scene.model.bodies[0], {1, 0.5, 2}, {4, -3, 7});
    scene.model.bodies[0].force = {0.3, 0.1, -0.2};
    return scene;
}

SweepScene stack() {
    SweepScene scene{"stack", base_model(), 16};
    auto& bodies = scene.model.bodies;
    bodies.push_back(support::ground_plate());
    bodies.push_back(make_body("lower", box_mesh({-0.05, -0.04, -0.03}, {0.05, 0.04, 0.05}), make_pose({0.02, 0.01, 0.1}, {0, 0, 0.035})));
    bodies.push_back(
        make_body("upper", box_mesh({-0.03, -0.05, -0.02}, {0.04, 0.03, 0.03}), make_pose({0.3, 0.5, 0.4}, {0.015, 0.01, 0.137})));
    bodies.push_back(
        make_body("side", box_mesh({-0.02, -0.03, -0.03}, {0.03, 0.03, 0.03}), make_pose({0.01, -0.02, 0.11}, {0.0885, 0.01, 0.034})));
    support::set_velocity(bodies[2], {0.2, 0.1, -0.4}, {1, -2, 0.5});
    support::set_velocity(bodies[3], {-0.3, 0, 0}, {0, 0, 0});
    bodies[2].force = {0.2, -0.1, 0.1};
    return scene;
}

SweepScene twisted_pair() {
    SweepScene scene{"twisted pair", base_model(), 15};
    auto& bodies = scene.model.bodies;
    bodies.push_back(make_body("lower", box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}), {}, BodyType::static_body));
    bodies.push_back(
        make_body("upper", box_mesh({-0.0503, -0.0496, 0.001}, {0.0494, 0.0505, 0.06}), make_pose({0.003, -0.002, 0.011}, {0, 0, 0.0008})));
    support::set_velocity(bodies[1], {0.01, -0.005, -0.05}, {0, 0, -0.15});
    return scene;
}

SweepScene tilting_motor() {
    SweepScene scene{"tilting motor", base_model(), 14};
    auto& bodies = scene.model.bodies;
    bodies.push_back(support::ground_plate());
    bodies.push_back(
        make_body("paddle", box_mesh({-0.02, -0.01, -0.02}, {0.12, 0.012, 0.02}), make_pose({0.05, -0.03, 0.2}, {0, 0, 0.032})));
    bodies.push_back(
        make_body("box", box_mesh({-0.02, -0.02, -0.021}, {0.02, 0.025, 0.03}), make_pose({0, 0, 0.3}, {0.07, 0.075, 0.0222})));
    prescribe(bodies[1], 5, 6.0);
    support::set_velocity(bodies[1], {0, 0, -0.1}, {0.5, 0.2, 6});
    return scene;
}

SweepScene double_motor() {
    SweepScene scene{"double motor", base_model(), 20};
    auto& bodies = scene.model.bodies;
    bodies.push_back(support::ground_plate());
    bodies.push_back(make_body("rocker", box_mesh({-0.06, -0.03, -0.02}, {0.08, 0.02, 0.03}), make_pose({0.1, 0.2, -0.3}, {0, 0, 0.0404})));
    bodies.push_back(
        make_body("rider", box_mesh({-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}), make_pose({0.1, 0.25, 0.3}, {0.01, 0, 0.0982})));
    prescribe(bodies[1], 3, -1.5);
    prescribe(bodies[1], 5, 4.0);
    return scene;
}

SweepScene pusher() {
    SweepScene scene{"pusher", base_model(), 20};
    auto& bodies = scene.model.bodies;
    bodies.push_back(make_body("pusher", box_mesh({-0.03, -0.04, -0.02}, {0.03, 0.04, 0.02}), make_pose({0, 0, 0.1}, {0, 0, 0.04}),
                               BodyType::kinematic_body));
    bodies.push_back(
        make_body("slider", box_mesh({-0.02, -0.03, -0.02}, {0.03, 0.03, 0.025}), make_pose({0.1, 0.05, -0.1}, {0.062, 0.005, 0.04})));
    bodies.push_back(
        make_body("last", box_mesh({-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}), make_pose({0.4, 0.3, 0.5}, {0.13, 0.01, 0.045})));
    prescribe(bodies[0], 0, 0.5);
    prescribe(bodies[0], 3, 1.0);
    prescribe(bodies[0], 5, 1.2);
    prescribe(bodies[1], 2);
    prescribe(bodies[1], 4);
    prescribe(bodies[2], 2, -0.02);
    return scene;
}

std::vector<SweepScene> all_scenes() { return {free_flight(), stack(), twisted_pair(), tilting_motor(), double_motor(), pusher()}; }

SweepScene rubbed(SweepScene scene) {
    scene.name += ", rubbed";
    scene.model.friction.mu.setConstant(0.4);
    scene.model.friction.eps_v = 0.05;
    scene.model.friction.rounds = 2;
    return scene;
}

std::vector<ParameterKind> kinds_of(const SweepScene& scene) {
    std::vector<ParameterKind> kinds{ParameterKind::vertices, ParameterKind::pose_start, ParameterKind::velocity_start,
                                     ParameterKind::density,  ParameterKind::gravity,    ParameterKind::force,
                                     ParameterKind::torque,   ParameterKind::increments};
    if (scene.model.friction.mu.maxCoeff() > 0) kinds.push_back(ParameterKind::friction);
    if (scene.model.dmin > 0) kinds.push_back(ParameterKind::dmin);
    return kinds;
}

ContactCount count_contacts(const Model& model, const core::stepper::Trajectory& trajectory) {
    ContactCount count;
    for (std::size_t t = 1; t < trajectory.poses.size(); ++t) {
        const auto candidates = core::ccd::find_candidates(model, trajectory.poses[t], 0);
        for (const auto& list : core::contact::find_contacts(model, candidates, trajectory.poses[t]).pairs)
            for (const core::contact::ContactPair& pair : list.contacts) {
                if (pair.type == core::geometry::PairType::point_triangle)
                    ++count.vertex_face;
                else if (fettle::adjoint::contact::is_mollified(pair))
                    ++count.mollified;
                else
                    ++count.edge_edge;
            }
    }
    return count;
}

const char* to_string(ParameterKind kind) {
    switch (kind) {
        case ParameterKind::vertices:
            return "vertices";
        case ParameterKind::pose_start:
            return "pose_start";
        case ParameterKind::velocity_start:
            return "velocity_start";
        case ParameterKind::density:
            return "density";
        case ParameterKind::gravity:
            return "gravity";
        case ParameterKind::force:
            return "force";
        case ParameterKind::torque:
            return "torque";
        case ParameterKind::increments:
            return "increments";
        case ParameterKind::friction:
            return "friction";
        case ParameterKind::dmin:
            return "dmin";
    }
    return "unknown";
}

ModelTangent random_direction(const SweepScene& scene, ParameterKind kind, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double scale) { return Vector3(scale * Vector3::NullaryExpr([&] { return uniform(random); })); };
    ModelTangent d = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    if (kind == ParameterKind::gravity) d.gravity_dot = vector(10);
    if (kind == ParameterKind::dmin) d.dmin_dot = scene.model.dmin * uniform(random);
    const int count = count_of(d.bodies);
    const bool is_friction = kind == ParameterKind::friction;
    const double mu_dot = is_friction ? uniform(random) : 0;
    for (int a = 0; a < count && is_friction; ++a)
        for (int b = a + 1; b < count; ++b) d.friction_dot[{a, b}] = mu_dot;
    for (std::size_t i = 0; i < d.bodies.size(); ++i) {
        const Body& body = scene.model.bodies[i];
        fettle::adjoint::BodyTangent& dot = d.bodies[i];
        if (kind == ParameterKind::vertices)
            for (Eigen::Index j = 0; j < dot.vertices_dot.cols(); ++j) dot.vertices_dot.col(j) = vector(size);
        if (kind == ParameterKind::pose_start) dot.pose_start_dot << vector(size), vector(1);
        if (kind == ParameterKind::velocity_start) {
            Vector6 velocity;
            velocity << vector(1), vector(10);
            dot.velocity_start_dot = velocity_matrix(velocity, body.pose_start.rotation);
        }
        if (kind == ParameterKind::density) dot.density_dot = body.density * uniform(random);
        if (kind == ParameterKind::force) dot.force_dot = vector(1);
        if (kind == ParameterKind::torque) dot.torque_dot = vector(size);
        if (kind != ParameterKind::increments) continue;
        for (Vector6& increment : dot.increment_dot)
            for (int k = 0; k < 6; ++k)
                if (!is_free(body, k)) increment[k] = (k < 3 ? 0.1 * size : 0.1) * uniform(random);
    }
    return d;
}

ModelTangent vertex_gradient_direction(const SweepScene& scene, const ModelGradient& gradient) {
    ModelTangent d = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    double largest = 0;
    for (const auto& body : gradient.bodies) largest = std::max(largest, body.vertices_bar.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < d.bodies.size(); ++i) d.bodies[i].vertices_dot = (size / largest) * gradient.bodies[i].vertices_bar;
    return d;
}

namespace {

// Largest entry: the size of the parts.
ModelTangent scaled(ModelTangent d) {
    double largest = 0;
    for (const auto& body : d.bodies) largest = std::max(largest, body.vertices_dot.cwiseAbs().maxCoeff());
    for (auto& body : d.bodies) body.vertices_dot *= size / largest;
    return d;
}

}  // namespace

ModelTangent affine_direction(const SweepScene& scene, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    ModelTangent d = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    for (std::size_t i = 0; i < d.bodies.size(); ++i) {
        const Matrix34 map = Matrix34::NullaryExpr([&] { return uniform(random); });
        const Body& body = scene.model.bodies[i];
        d.bodies[i].vertices_dot = map * (body.mesh.vertices / std::max(body.radius, size)).colwise().homogeneous();
    }
    return scaled(std::move(d));
}

ModelTangent affine_gradient_direction(const SweepScene& scene, const ModelGradient& gradient) {
    ModelTangent d = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    for (std::size_t i = 0; i < d.bodies.size(); ++i) {
        const Body& body = scene.model.bodies[i];
        const Eigen::Matrix<double, 4, Eigen::Dynamic> at = (body.mesh.vertices / std::max(body.radius, size)).colwise().homogeneous();
        const Matrix34 map = gradient.bodies[i].vertices_bar * at.transpose();
        d.bodies[i].vertices_dot = map * at;
    }
    return scaled(std::move(d));
}

Model moved(const SweepScene& scene, const ModelTangent& direction, double s) {
    Model model = scene.model;
    model.gravity += s * direction.gravity_dot;
    model.dmin += s * direction.dmin_dot;
    if (!direction.friction_dot.empty()) model.friction.mu.array() += s * direction.friction_dot.begin()->second;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        Body& body = model.bodies[i];
        const fettle::adjoint::BodyTangent& dot = direction.bodies[i];
        body.mesh.vertices += s * dot.vertices_dot;
        body.density += s * dot.density_dot;
        body.force += s * dot.force_dot;
        body.torque += s * dot.torque_dot;
        body.velocity_start += s * dot.velocity_start_dot;
        body.pose_start.position += s * dot.pose_start_dot.head<3>();
        body.pose_start.rotation = core::kinematics::rotation(s * dot.pose_start_dot.tail<3>()) * body.pose_start.rotation;
        support::refresh(body);
        if (body.given_mass) body.moments = scene.model.bodies[i].moments;
        if (!body.given_mass && scene.model.bodies[i].moments(3, 3) != 0 &&
            fettle::adjoint::model::has_moments_of_mesh(scene.model.bodies[i], model.dhat))
            body.moments = core::model::mass_moments(body, model.dhat);
        for (int k = 0; k < 6; ++k) {
            if (is_free(body, k)) continue;
            body.prescribed[k] = moved_curve(*scene.model.bodies[i].prescribed[k], model.timestep, scene.steps,
                                             [&](int t) { return s * dot.increment_dot[t][k]; });
        }
    }
    return model;
}

double pairing(const SweepScene& scene, const ModelGradient& gradient, const ModelTangent& direction) {
    double sum = gradient.gravity_bar.dot(direction.gravity_dot) + gradient.dmin_bar * direction.dmin_dot;
    for (const auto& [pair, dot] : direction.friction_dot)
        if (const auto bar = gradient.friction_bar.find(pair); bar != gradient.friction_bar.end()) sum += bar->second * dot;
    for (std::size_t i = 0; i < direction.bodies.size(); ++i) {
        const fettle::adjoint::BodyGradient& bar = gradient.bodies[i];
        const fettle::adjoint::BodyTangent& dot = direction.bodies[i];
        sum += bar.vertices_bar.cwiseProduct(dot.vertices_dot).sum() + bar.density_bar * dot.density_dot +
               bar.force_bar.dot(dot.force_dot) + bar.torque_bar.dot(dot.torque_dot);
        sum += bar.pose_start_bar.cwiseProduct(velocity_matrix(dot.pose_start_dot, scene.model.bodies[i].pose_start.rotation)).sum();
        sum += bar.velocity_start_bar.cwiseProduct(dot.velocity_start_dot).sum();
        for (int t = 0; t < scene.steps; ++t) sum += bar.increment_bar[t].dot(dot.increment_dot[t]);
    }
    return sum;
}

TrajectoryGradient random_seed(const SweepScene& scene, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    TrajectoryGradient seed = fettle::adjoint::zero_trajectory_gradient(scene.steps, count_of(scene.model.bodies));
    for (auto& bodies : seed.pose_bar)
        for (Matrix34& bar : bodies) {
            bar = Matrix34::NullaryExpr([&] { return uniform(random); });
            bar.col(3) /= size;
        }
    return seed;
}

double objective(const TrajectoryGradient& weights, const core::stepper::Trajectory& trajectory) {
    double sum = 0;
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
        for (std::size_t i = 0; i < trajectory.poses[t].size(); ++i)
            sum += weights.pose_bar[t][i].cwiseProduct(pose_matrix(trajectory.poses[t][i])).sum();
    return sum;
}

double objective_change(const TrajectoryGradient& weights, const core::stepper::Trajectory& from, const core::stepper::Trajectory& to) {
    double sum = 0;
    for (std::size_t t = 0; t < from.poses.size(); ++t)
        for (std::size_t i = 0; i < from.poses[t].size(); ++i)
            sum += weights.pose_bar[t][i].cwiseProduct(pose_matrix(to.poses[t][i]) - pose_matrix(from.poses[t][i])).sum();
    return sum;
}

double pairing(const TrajectoryGradient& weights, const core::stepper::Trajectory& trajectory,
               const std::vector<std::vector<Vector6>>& tangents) {
    double sum = 0;
    for (std::size_t t = 0; t < tangents.size(); ++t)
        for (std::size_t i = 0; i < tangents[t].size(); ++i)
            sum += weights.pose_bar[t][i].cwiseProduct(velocity_matrix(tangents[t][i], trajectory.poses[t][i].rotation)).sum();
    return sum;
}

}  // namespace fettle::tests::adjoint
