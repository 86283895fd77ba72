// SPDX-License-Identifier: MIT
#include "adjoint/scene/scene_gradient.hpp"

#include "core/scene/place.hpp"

namespace fettle::adjoint::scene {

core::scene::Scene zero_scene_gradient(const core::scene::Scene& scene) {
    core::scene::Scene out;
    for (const core::scene::Body& body : scene.bodies) {
        core::scene::Body& bar = out.bodies.emplace_back();
        bar.shape = body.shape;
        bar.prescribed = body.prescribed;
        bar.orientation = body.orientation;
        bar.mesh.vertices = Matrix3X::Zero(3, body.mesh.vertices.cols());
        bar.pose.rotation.setZero();
    }
    out.friction = scene.friction;
    out.mechanism = scene.mechanism;
    core::scene::clear_numbers(out);
    for (core::scene::Spring& spring : out.mechanism.springs) spring.a.axis = spring.b.axis = Vector3::Zero();  // which mean nothing
    return out;
}

}  // namespace fettle::adjoint::scene
