// SPDX-License-Identifier: MIT
/// Models made in memory, without files and without build_model: for tests of what works on a Model.
#pragma once

#include <string>

#include "core/model/model.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::tests::support {

/// Everything that follows from mesh, density and type: moments, radius, edge lengths, hierarchy. Call it after moving vertices.
void refresh(core::model::Body& body);

/// A body at the given pose, refreshed; static and kinematic bodies have all degrees of freedom prescribed (held).
core::model::Body make_body(std::string name, core::geometry::Mesh mesh, const core::kinematics::Pose& pose,
                            core::scene::BodyType type = core::scene::BodyType::dynamic_body, double density = 1000);

/// A static plate whose top is the plane z = 0, 4 x 4 m.
core::model::Body ground_plate();

/// Prescribes one coordinate as u(t) = rate t (rate 0: held).
void prescribe(core::model::Body& body, int dof, double rate = 0);

/// Pdot = [[omega] R, v].
void set_velocity(core::model::Body& body, const Vector3& linear, const Vector3& angular);

/// Rotation of a rotation vector, and a position.
core::kinematics::Pose make_pose(const Vector3& rotation_vector, const Vector3& position);

}  // namespace fettle::tests::support
