// SPDX-License-Identifier: MIT
#include "adjoint/contact/friction_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "core/contact/friction.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::contact::friction_adjoint_test {

using namespace fettle::tests;

namespace {

using core::contact::ContactSet;
using core::geometry::PairType;
using core::kinematics::Pose;
using core::model::Model;

struct Scene {
    Model model;
    std::vector<Pose> lag_poses, poses;
    std::vector<Matrix34> slip_reference;
    double slip_time = 0.01;
    core::contact::BarrierParameters parameters() const {
        return core::contact::barrier_parameters(model.dhat, model.dmin, 1e4, slip_time * slip_time);
    }
};

ContactSet contacts_of(const Model& model, const std::vector<Pose>& poses) {
    return core::contact::find_contacts(model, core::ccd::find_candidates(model, poses, 0), poses);
}

// A box over another, near enough to touch; both turned together, so that no axis is special. It has slid by `slide` since the slip
// references, which are no rotations.
Scene two_boxes(const Vector3& turn, double x, double y, double slide) {
    Scene scene;
    Model& model = scene.model;
    model.dhat = 5e-3;
    model.dmin = 1e-3;
    model.friction.mu.setConstant(0.6);
    model.friction.eps_v = 0.1;  // e = 1 mm
    model.bodies.push_back(support::make_body("lower", support::box_mesh({-0.05, -0.06, -0.04}, {0.05, 0.04, 0}), {}));
    model.bodies.push_back(support::make_body("upper", support::box_mesh({-0.04, -0.04, 0.01}, {0.07, 0.05, 0.06}), {}));
    std::vector<Pose> poses{Pose{}, support::make_pose(turn, {x, y, 0.15})};
    while (!(contacts_of(model, poses).minimum_distance < model.dmin + 0.6 * model.dhat)) poses[1].position.z() -= 0.05 * model.dhat;
    const Pose frame = support::make_pose({0.1, 0.2, -0.1}, {0.01, 0, 0});
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (Pose& pose : poses) {
        pose = {frame.rotation * pose.rotation, world_position(frame, pose.position)};
        scene.slip_reference.push_back(pose_matrix(pose) + 1e-4 * Matrix34::NullaryExpr([&] { return uniform(random); }));
    }
    scene.lag_poses = scene.poses = poses;
    scene.poses[1].position += slide * Vector3(0.7, -0.5, 0.3);
    scene.poses[1].rotation = core::kinematics::rotation(Vector3(0.002, 0.001, -0.003)) * scene.poses[1].rotation;
    return scene;
}

// Coordinates: vertices of both bodies, lag poses (q, phi), slip references, the coefficient.
constexpr Eigen::Index vertices_at = 0, lag_at = 48, slip_at = 60, mu_at = 84, size = 85;

Scene moved(const Scene& scene, const VectorX& d) {
    Scene out = scene;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        out.model.bodies[k].mesh.vertices += d.segment<24>(vertices_at + 24 * i).reshaped(3, 8);
        support::refresh(out.model.bodies[k]);
        out.lag_poses[k].position += d.segment<3>(lag_at + 6 * i);
        out.lag_poses[k].rotation = core::kinematics::rotation(d.segment<3>(lag_at + 6 * i + 3)) * out.lag_poses[k].rotation;
        out.slip_reference[k] += d.segment<12>(slip_at + 12 * i).reshaped(3, 4);
    }
    out.model.friction.mu.array() += d[mu_at];
    return out;
}

// The potential's gradient along a motion, by core.
double residual_along(const Scene& scene, const std::vector<Vector6>& motion) {
    const auto set = lag_friction(scene.model, contacts_of(scene.model, scene.lag_poses), scene.lag_poses, scene.parameters(),
                                  scene.slip_reference, scene.slip_time);
    std::vector<core::kinematics::PoseGradient> gradients(2);
    core::kinematics::BlockHessian hessian;
    add_friction_derivatives(set, scene.poses, core::contact::HessianKind::none, gradients, hessian);
    return tangent_gradient(gradients[0]).dot(motion[0]) + tangent_gradient(gradients[1]).dot(motion[1]);
}

Matrix34 matrix_of(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 p;
    p << cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return p;
}

Vector6 lag_gradient(const Matrix34& bar, const Matrix3& rotation) {
    const Matrix3 s = bar.leftCols<3>() * rotation.transpose();
    Vector6 out;
    out << bar.col(3), s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1);
    return out;
}

struct Bars {
    std::vector<std::vector<Matrix34>> slip{{2, Matrix34::Zero()}}, lag{{2, Matrix34::Zero()}};
    std::vector<std::vector<AreaChange>> areas;
    std::vector<ModelGradient> model;
};

VectorX flat(const Scene& scene, const Bars& bars) {
    VectorX out(size);
    const ModelGradient& g = bars.model[0];
    out << g.bodies[0].vertices_bar.reshaped(), g.bodies[1].vertices_bar.reshaped(),
        lag_gradient(bars.lag[0][0], scene.lag_poses[0].rotation), lag_gradient(bars.lag[0][1], scene.lag_poses[1].rotation),
        bars.slip[0][0].reshaped(), bars.slip[0][1].reshaped(), g.friction_bar.at({0, 1});
    return -out;
}

double forward_along(const Scene& scene, const FrictionAtPose& at, const VectorX& d, const std::vector<Vector6>& motion) {
    ModelTangent direction = zero_model_tangent(scene.model, 0);
    std::vector<Matrix34> slip_dot, lag_dot;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        direction.bodies[k].vertices_dot = d.segment<24>(vertices_at + 24 * i).reshaped(3, 8);
        lag_dot.push_back(matrix_of(d.segment<6>(lag_at + 6 * i), scene.lag_poses[k].rotation));
        slip_dot.emplace_back(d.segment<12>(slip_at + 12 * i).reshaped(3, 4));
    }
    direction.friction_dot[{0, 1}] = d[mu_at];
    PoseGradientTangent out{{2, Matrix34::Zero()}, {2, Matrix34::Zero()}};
    add_friction_tangent(at, {{2, Matrix34::Zero()}, slip_dot, lag_dot, {}}, direction, out);
    double sum = 0;
    for (std::size_t k = 0; k < 2; ++k) sum += out.dot[k].cwiseProduct(matrix_of(motion[k], scene.poses[k].rotation)).sum();
    return sum;
}

struct Kinds {
    int vertex_face = 0, edge_edge = 0, mollified = 0;
};

Kinds kinds_of(const ContactSet& contacts) {
    Kinds kinds;
    for (const auto& list : contacts.pairs)
        for (const auto& pair : list.contacts)
            ++(pair.type == PairType::point_triangle ? kinds.vertex_face : is_mollified(pair) ? kinds.mollified : kinds.edge_edge);
    return kinds;
}

Kinds check_scene(const Scene& scene) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto number = [&] { return uniform(random); };
    const LaggedContacts lag{scene.lag_poses, contacts_of(scene.model, scene.lag_poses), {}};
    const core::contact::BarrierParameters parameters = scene.parameters();
    const FrictionAtPose at{scene.model, lag, scene.poses, scene.slip_reference, parameters, scene.model.friction.eps_v * scene.slip_time};
    std::vector<Vector6> motion(2);
    for (Vector6& m : motion) m << 0.05 * Vector3::NullaryExpr(number), Vector3::NullaryExpr(number);
    Bars bars;
    bars.model = {zero_model_gradient(scene.model, 0)};
    subtract_friction_adjoint(at, {motion}, {bars.slip, bars.lag, bars.areas, bars.model});
    const VectorX gradient = flat(scene, bars), zero = VectorX::Zero(size);
    const auto value = [&](const VectorX& d) { return VectorX::Constant(1, residual_along(moved(scene, d), motion)); };
    for (const auto& [first, count] : {std::pair{vertices_at, lag_at}, {lag_at, slip_at}, {slip_at, mu_at}, {mu_at, size}}) {
        const Eigen::Index length = count - first;
        VectorX along = zero, across = zero;
        along.segment(first, length) = gradient.segment(first, length).normalized();
        across.segment(first, length) = VectorX::NullaryExpr(length, number);
        for (const VectorX& d : {along, across}) {
            const double slope = gradient.dot(d);
            CAPTURE(first, slope);
            REQUIRE(slope != 0);
            CHECK(support::check_directional(value, zero, d, VectorX::Constant(1, slope), {1e-5, 0.25, 8}).relative_error < 1e-7);
            CHECK(forward_along(scene, at, d, motion) == Approx(slope).epsilon(1e-10));
        }
    }
    return kinds_of(lag.contacts);
}

}  // namespace

TEST_CASE("friction follows what it was taken from: vertex and face", "[adjoint][contact]") {
    for (const double slide : {2e-4, 5e-3}) CHECK(check_scene(two_boxes({0.4, 0.5, 0.3}, -0.06, 0.03, slide)).vertex_face > 0);
}

TEST_CASE("friction follows what it was taken from: crossing edges", "[adjoint][contact]") {
    for (const double slide : {2e-4, 5e-3}) CHECK(check_scene(two_boxes({0.785, 0.3, 0}, 0.03, 0, slide)).edge_edge > 0);
}

TEST_CASE("friction follows what it was taken from: nearly parallel edges", "[adjoint][contact]") {
    for (const double slide : {2e-4, 5e-3}) CHECK(check_scene(two_boxes({0.003, -0.002, 0.012}, -0.0195, 0, slide)).mollified > 0);
}

TEST_CASE("friction follows what it was taken from: at rest", "[adjoint][contact]") {
    Scene scene = two_boxes({0.4, 0.5, 0.3}, -0.06, 0.03, 0);
    scene.poses = scene.lag_poses;
    for (std::size_t k = 0; k < 2; ++k) scene.slip_reference[k] = pose_matrix(scene.poses[k]);
    const LaggedContacts lag{scene.lag_poses, contacts_of(scene.model, scene.lag_poses), {}};
    const core::contact::BarrierParameters parameters = scene.parameters();
    const std::vector<Vector6> motion{Vector6::Constant(0.1), Vector6::Constant(-0.2)};
    Bars bars;
    bars.model = {zero_model_gradient(scene.model, 0)};
    subtract_friction_adjoint({scene.model, lag, scene.poses, scene.slip_reference, parameters, 1e-3}, {motion},
                              {bars.slip, bars.lag, bars.areas, bars.model});
    const VectorX gradient = flat(scene, bars);
    CHECK(gradient.segment(lag_at, slip_at - lag_at).norm() == 0);  // no force: what it would be of changes nothing
    CHECK(gradient[mu_at] == 0);
    VectorX d = VectorX::Zero(size);
    d.segment(slip_at, mu_at - slip_at) = gradient.segment(slip_at, mu_at - slip_at).normalized();
    const auto value = [&](const VectorX& x) { return VectorX::Constant(1, residual_along(moved(scene, x), motion)); };
    CHECK(support::check_directional(value, VectorX::Zero(size), d, VectorX::Constant(1, gradient.dot(d)), {1e-6, 0.25, 8}).relative_error <
          1e-6);
}

}  // namespace fettle::adjoint::contact::friction_adjoint_test
