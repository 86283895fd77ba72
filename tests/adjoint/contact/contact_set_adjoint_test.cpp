// SPDX-License-Identifier: MIT
#include "adjoint/contact/contact_set_adjoint.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::contact::contact_set_adjoint_test {

using namespace fettle::tests;

namespace {

using core::geometry::PairType;
using core::kinematics::Pose;
using core::model::Model;

struct Scene {
    Model model;
    std::vector<Pose> poses;
    core::contact::BarrierParameters parameters;
};

core::contact::ContactSet contacts_of(const Model& model, const std::vector<Pose>& poses) {
    const auto candidates = core::ccd::find_candidates(model, poses, 0);
    return core::contact::find_contacts(model, candidates, poses);
}

// Between the surfaces of the two bodies at the start, by all pairs of primitives.
double distance(const Model& model) {
    const core::model::Body &a = model.bodies[0], &b = model.bodies[1];
    const auto at = [](const core::model::Body& body, int v) { return world_position(body.pose_start, body.mesh.vertices.col(v)); };
    double least = std::numeric_limits<double>::infinity();
    const auto vertices_to_faces = [&](const core::model::Body& vb, const core::model::Body& tb) {
        for (int v = 0; v < vb.mesh.vertices.cols(); ++v)
            for (const auto& t : tb.mesh.triangles)
                least =
                    std::min(least, core::geometry::point_triangle_distance_squared(at(vb, v), at(tb, t[0]), at(tb, t[1]), at(tb, t[2])));
    };
    vertices_to_faces(a, b);
    vertices_to_faces(b, a);
    for (const auto& ea : a.mesh.edges)
        for (const auto& eb : b.mesh.edges)
            least = std::min(least, core::geometry::edge_edge_distance_squared(at(a, ea[0]), at(a, ea[1]), at(b, eb[0]), at(b, eb[1])));
    return std::sqrt(least);
}

// A box let down onto another until they are dmin + 0.6 dhat apart; the two are then turned together, so that no axis is special.
Scene two_boxes(const Vector3& turn, double x, double y, double dmin = 0) {
    Scene scene;
    Model& model = scene.model;
    model.dhat = 5e-3;
    model.dmin = dmin;
    model.bodies.push_back(support::make_body("lower", support::box_mesh({-0.05, -0.06, -0.04}, {0.05, 0.04, 0}), {}));
    model.bodies.push_back(
        support::make_body("upper", support::box_mesh({-0.04, -0.04, 0.01}, {0.07, 0.05, 0.06}), support::make_pose(turn, {x, y, 0.15})));
    const double target = dmin + 0.6 * model.dhat;
    for (double d = distance(model); d > 1.0001 * target; d = distance(model)) model.bodies[1].pose_start.position.z() -= d - target;
    const Pose frame = support::make_pose({0.1, 0.2, -0.1}, {0.01, 0, 0});
    for (auto& body : model.bodies) {
        body.pose_start = {frame.rotation * body.pose_start.rotation, world_position(frame, body.pose_start.position)};
        scene.poses.push_back(body.pose_start);
    }
    scene.parameters = core::contact::barrier_parameters(model.dhat, dmin, 1e4, 1e-4);
    return scene;
}

// Coordinates: the vertices of both bodies.
int size(const Model& model) { return 3 * static_cast<int>(model.bodies[0].mesh.vertices.cols() + model.bodies[1].mesh.vertices.cols()); }

Model moved(const Model& model, const VectorX& d) {
    Model out = model;
    Eigen::Index at = 0;
    for (auto& body : out.bodies)
        for (Eigen::Index j = 0; j < body.mesh.vertices.cols(); ++j, at += 3) body.mesh.vertices.col(j) += d.segment<3>(at);
    for (auto& body : out.bodies) support::refresh(body);
    return out;
}

VectorX flat(const Model& model, const adjoint::ModelGradient& g) {
    VectorX out(size(model));
    out << g.bodies[0].vertices_bar.reshaped(), g.bodies[1].vertices_bar.reshaped();
    return out;
}

// r = sum f_i . v_i, evaluated independently through dE/dphi of the potential's pose gradients.
double residual_along(const Scene& scene, const Model& model, const std::vector<Vector6>& lambda) {
    std::vector<core::kinematics::PoseGradient> gradients(2);
    core::kinematics::BlockHessian hessian;
    hessian.diagonal.assign(2, Matrix6::Zero());
    add_barrier_derivatives(contacts_of(model, scene.poses), scene.poses, scene.parameters, core::contact::HessianKind::exact, gradients,
                            hessian);
    return tangent_gradient(gradients[0]).dot(lambda[0]) + tangent_gradient(gradients[1]).dot(lambda[1]);
}

struct Kinds {
    int vertex_face = 0, edge_edge = 0, mollified = 0;
};

Kinds kinds_of(const core::contact::ContactSet& contacts) {
    Kinds kinds;
    for (const auto& list : contacts.pairs)
        for (const auto& pair : list.contacts) {
            if (pair.type == PairType::point_triangle)
                ++kinds.vertex_face;
            else if (adjoint::contact::is_mollified(pair))
                ++kinds.mollified;
            else
                ++kinds.edge_edge;
        }
    return kinds;
}

void check_scene(const Scene& scene) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const core::contact::ContactSet contacts = contacts_of(scene.model, scene.poses);
    std::vector<std::vector<Vector6>> lambda(3, std::vector<Vector6>(2));
    for (auto& seed : lambda)
        for (Vector6& motion : seed)
            motion << 0.05 * Vector3::NullaryExpr([&] { return uniform(random); }), Vector3::NullaryExpr([&] { return uniform(random); });
    std::vector<adjoint::ModelGradient> bar(3, adjoint::zero_model_gradient(scene.model, 0));
    const adjoint::contact::ContactsAtPose at{scene.model, contacts, scene.poses, scene.parameters};
    std::vector<std::vector<adjoint::contact::AreaChange>> no_areas(3);
    subtract_contact_vertices_adjoint(at, lambda, bar, no_areas);
    for (int s = 0; s < 3; ++s) {
        const VectorX gradient = -flat(scene.model, bar[s]);
        REQUIRE(gradient.norm() > 0);
        const auto value = [&](const VectorX& d) { return residual_along(scene, moved(scene.model, d), lambda[s]); };
        const VectorX zero = VectorX::Zero(gradient.size());
        const support::StepSweep sweep{1e-5, 0.25, 8};
        if (s == 0) CHECK(support::check_gradient(value, zero, gradient, sweep).relative_error < 1e-6);
        // Along the gradient itself: a wrong part that is large cannot hide in an average.
        const VectorX along = gradient.normalized();
        const auto directional = [&](const VectorX& d) { return VectorX::Constant(1, value(d)); };
        CHECK(support::check_directional(directional, zero, along, VectorX::Constant(1, gradient.norm()), sweep).relative_error < 1e-8);
    }
    // Forward against reverse: sum of dE/dP_dot . v + dE/dP . v_dot over bodies, v = [[phi] R, dq] held.
    const VectorX d = VectorX::NullaryExpr(size(scene.model), [&] { return uniform(random); });
    adjoint::ModelTangent direction = adjoint::zero_model_tangent(scene.model, 0);
    direction.bodies[0].vertices_dot = d.head(24).reshaped(3, 8);
    direction.bodies[1].vertices_dot = d.tail(24).reshaped(3, 8);
    adjoint::contact::PoseGradientTangent tangent{{2, Matrix34::Zero()}, {2, Matrix34::Zero()}};
    add_contact_gradient_tangent(at, {2, Matrix34::Zero()}, direction, {}, tangent);
    for (int s = 0; s < 3; ++s) {
        double forward = 0;
        for (int i = 0; i < 2; ++i) {
            Matrix34 v;
            v << cross_matrix(lambda[s][i].tail<3>()) * scene.poses[i].rotation, lambda[s][i].head<3>();
            forward += tangent.dot[i].cwiseProduct(v).sum();
        }
        CHECK(forward == Approx(-flat(scene.model, bar[s]).dot(d)).epsilon(1e-12));
    }
}

}  // namespace

TEST_CASE("contact residual follows the vertices: vertex and face", "[adjoint][contact]") {
    const Scene scene = two_boxes({0.4, 0.5, 0.3}, -0.06, 0.03);
    const Kinds kinds = kinds_of(contacts_of(scene.model, scene.poses));
    REQUIRE(kinds.vertex_face > 0);
    check_scene(scene);
}

TEST_CASE("contact residual follows the vertices: crossing edges", "[adjoint][contact]") {
    // The upper box stands on an edge that crosses the lower one's rim and leans outwards.
    const Scene scene = two_boxes({0.785, 0.3, 0}, 0.03, 0);
    const Kinds kinds = kinds_of(contacts_of(scene.model, scene.poses));
    REQUIRE(kinds.edge_edge > 0);
    check_scene(scene);
}

TEST_CASE("contact residual follows the vertices: nearly parallel edges", "[adjoint][contact]") {
    for (const double dmin : {0.0, 1e-3})
        for (const double twist : {0.004, 0.012, 0.02}) {
            CAPTURE(dmin, twist);
            // The upper box's side edge runs along the lower one's rim.
            const Scene scene = two_boxes({0.003, -0.002, twist}, -0.0195, 0, dmin);
            const Kinds kinds = kinds_of(contacts_of(scene.model, scene.poses));
            REQUIRE(kinds.mollified > 0);
            check_scene(scene);
        }
}

}  // namespace fettle::adjoint::contact::contact_set_adjoint_test
