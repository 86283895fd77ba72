// SPDX-License-Identifier: MIT
/// A robot description as a URDF file says it: links and joints as plain data, SI units. Reading: urdf_parser.hpp; what becomes of it:
/// urdf_scene.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::design::urdf {

enum class GeometryKind { box, cylinder, sphere, mesh, other };

struct Geometry {
    GeometryKind kind = GeometryKind::box;
    core::kinematics::Pose origin;    ///< in the link's frame
    Vector3 size = Vector3::Zero();   ///< of a box [m]
    double radius = 0, length = 0;    ///< of a cylinder (along z) or a sphere [m]
    std::string file;                 ///< of a mesh, as it is named: "package://robot/arm.stl"; of another geometry what it is called
    Vector3 scale = Vector3::Ones();  ///< of a mesh
};

/// Red, green, blue and opacity, 0 to 1.
using Rgba = std::array<double, 4>;

struct Link {
    std::string name;
    std::optional<double> mass;        ///< [kg]; 0 is said of links that do not move, or weigh next to nothing
    core::kinematics::Pose centre;     ///< of mass, and the axes of `inertia`, in the link's frame
    std::optional<Matrix3> inertia{};  ///< about the centre of mass, along its axes [kg m^2]
    std::vector<Geometry> collision{}, visual{};
    std::string material;  ///< of the first visual that names one
    std::optional<Rgba> colour{};

    /// What can touch: the collision geometry, of links without any the visual one.
    const std::vector<Geometry>& geometry() const { return collision.empty() ? visual : collision; }
    /// Does it have a mass above 0?
    bool has_mass() const { return mass && *mass > 0; }
};

struct Joint {
    std::string name, type, parent, child;
    core::kinematics::Pose origin;           ///< of the child's frame in the parent's, at coordinate 0
    Vector3 axis = Vector3::UnitX();         ///< in the child's frame; may be 0 where the type has no axis
    std::optional<double> lower, upper;      ///< [rad] or [m]
    std::optional<double> effort, velocity;  ///< most that its drive can do [N m], [rad/s]; [N], [m/s]
    double damping = 0, friction = 0;        ///< [N m s/rad], [N m]; [N s/m], [N]
    std::string mimics;                      ///< another joint; empty: none
    double multiplier = 1, offset = 0;       ///< coordinate = multiplier * that of the other + offset

    bool turns() const { return type == "revolute" || type == "continuous"; }
    bool slides() const { return type == "prismatic"; }
    bool has_coordinate() const { return turns() || slides(); }
    bool has_axis() const { return has_coordinate() || type == "planar"; }
    bool is_limited() const { return (type == "revolute" || slides()) && lower && upper && *lower < *upper; }
};

struct Robot {
    std::string name;
    std::vector<Link> links;
    std::vector<Joint> joints;
    std::vector<std::string> warnings;  ///< what was passed over
};

/// The pose of a frame in the world, from that of the outer one in the world and its own in the outer one.
inline core::kinematics::Pose composed(const core::kinematics::Pose& outer, const core::kinematics::Pose& inner) {
    return {outer.rotation * inner.rotation, core::kinematics::world_position(outer, inner.position)};
}
inline core::kinematics::Pose inverse(const core::kinematics::Pose& pose) {
    return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.position)};
}

/// What a joint's child does at this coordinate, in the child's frame at coordinate 0.
core::kinematics::Pose motion_of(bool slides, const Vector3& axis, double coordinate);

/// The rotation of `rpy`: about the fixed axes x, y, z, in this order.
Matrix3 rotation_of_rpy(const Vector3& rpy);
/// The same backwards; the pitch is within a quarter of a turn.
Vector3 rpy_of_rotation(const Matrix3& rotation);

/// "a", "b" and 7 more: for messages.
std::string some_of(const std::vector<std::string>& names);

}  // namespace fettle::design::urdf
