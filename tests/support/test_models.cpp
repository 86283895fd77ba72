// SPDX-License-Identifier: MIT
#include "tests/support/test_models.hpp"

#include <algorithm>

#include "core/geometry/mass_moments.hpp"
#include "core/model/body_geometry.hpp"

namespace fettle::tests::support {

using core::model::Body;
using core::scene::BodyType;

void refresh(Body& body) {
    body.moments.setZero();
    if (body.type == BodyType::dynamic_body)
        body.moments = body.density * core::geometry::solid_moments(body.mesh.vertices, body.mesh.triangles);
    core::model::complete_geometry(body);
}

Body make_body(std::string name, core::geometry::Mesh mesh, const core::kinematics::Pose& pose, BodyType type, double density) {
    Body body;
    body.name = std::move(name);
    body.type = type;
    body.mesh = std::move(mesh);
    body.density = density;
    body.pose_start = pose;
    refresh(body);
    if (type != BodyType::dynamic_body)
        for (int k = 0; k < 6; ++k) prescribe(body, k);
    return body;
}

Body ground_plate() { return make_body("ground", box_mesh({-2, -2, -0.1}, {2, 2, 0}), {}, BodyType::static_body); }

void prescribe(Body& body, int dof, double rate) {
    core::scene::MotionCurve curve;
    curve.rate = rate;
    body.prescribed[dof] = curve;
}

void set_velocity(Body& body, const Vector3& linear, const Vector3& angular) {
    body.velocity_start << cross_matrix(angular) * body.pose_start.rotation, linear;
}

core::kinematics::Pose make_pose(const Vector3& rotation_vector, const Vector3& position) {
    return {core::kinematics::rotation(rotation_vector), position};
}

}  // namespace fettle::tests::support
