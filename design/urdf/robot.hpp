// SPDX-License-Identifier: MIT
/// A robot description as a URDF file says it: links and joints as plain data, SI units. Reading: urdf_parser.hpp; what becomes of it:
/// urdf_scene.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/kinematics/path.hpp"

namespace fettle::design::urdf {

enum class GeometryKind { box, cylinder, sphere, mesh };

struct Geometry {
    GeometryKind kind = GeometryKind::box;
    core::kinematics::Pose origin;    ///< in the link's frame
    Vector3 size = Vector3::Zero();   ///< of a box [m]
    double radius = 0, length = 0;    ///< of a cylinder (along z) or a sphere [m]
    std::string file;                 ///< of a mesh, as it is named: "package://robot/arm.stl"
    Vector3 scale = Vector3::Ones();  ///< of a mesh
};

struct Link {
    std::string name;
    std::optional<double> mass;        ///< [kg]
    core::kinematics::Pose centre;     ///< of mass, and the axes of `inertia`, in the link's frame
    std::optional<Matrix3> inertia{};  ///< about the centre of mass, along its axes [kg m^2]
    std::vector<Geometry> collision{}, visual{};

    /// What can touch: the collision geometry, of links without any the visual one.
    const std::vector<Geometry>& geometry() const { return collision.empty() ? visual : collision; }
};

struct Joint {
    std::string name, type, parent, child;
    core::kinematics::Pose origin;       ///< of the child's frame in the parent's, at coordinate 0
    Vector3 axis = Vector3::UnitX();     ///< in the child's frame
    std::optional<double> lower, upper;  ///< [rad] or [m]
    double damping = 0, friction = 0;    ///< [N m s/rad], [N m]; [N s/m], [N]
    std::string mimics;                  ///< another joint; empty: none
    double multiplier = 1, offset = 0;   ///< coordinate = multiplier * that of the other + offset
};

struct Robot {
    std::string name;
    std::vector<Link> links;
    std::vector<Joint> joints;
};

/// The pose of a frame in the world, from that of the outer one in the world and its own in the outer one.
inline core::kinematics::Pose composed(const core::kinematics::Pose& outer, const core::kinematics::Pose& inner) {
    return {outer.rotation * inner.rotation, core::kinematics::world_position(outer, inner.position)};
}

/// The rotation of `rpy`: about the fixed axes x, y, z, in this order.
Matrix3 rotation_of_rpy(const Vector3& rpy);
/// The same backwards; the pitch is within a quarter of a turn.
Vector3 rpy_of_rotation(const Matrix3& rotation);

}  // namespace fettle::design::urdf
