// SPDX-License-Identifier: MIT
#include "fettle/tests/support/test_models.hpp"

#include <algorithm>

#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/model/build_model.hpp"

namespace fettle::tests::support {

using core::model::Body;
using core::scene::BodyType;

core::geometry::Mesh box_mesh(const Vector3& low, const Vector3& high) {
    Matrix3X v(3, 8);
    for (int i = 0; i < 8; ++i) v.col(i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
    return core::geometry::make_mesh("box", v,
                                     {{0, 2, 3},
                                      {0, 3, 1},
                                      {4, 5, 7},
                                      {4, 7, 6},
                                      {0, 1, 5},
                                      {0, 5, 4},
                                      {2, 6, 7},
                                      {2, 7, 3},
                                      {0, 4, 6},
                                      {0, 6, 2},
                                      {1, 3, 7},
                                      {1, 7, 5}});
}

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
