// SPDX-License-Identifier: MIT
/// Joints, springs, dampers, motors and loads at points, as a scene describes them: SI units, bodies by name. What they become:
/// model/mechanism.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/scene/curve.hpp"

namespace fettle::core::scene {

enum class JointKind { ball, revolute, prismatic, cylindrical, planar, fixed, screw, gear, rack };
/// Does it couple two joints, without bodies of its own?
inline bool couples_joints(JointKind kind) { return kind == JointKind::gear || kind == JointKind::rack; }

/// One end: a point and a direction, both in the file's frame of the body; of the world in the world's.
struct Attachment {
    std::string body;                 ///< empty: the world
    Vector3 point = Vector3::Zero();  ///< [m]
    Vector3 axis = Vector3::UnitZ();  ///< any length > 0
};

/// What acts along one coordinate: of a joint its angle or slide, of a spring its length or its joint's coordinate.
/// Units: of a coordinate that is an angle rad, N m, N m/rad, N m s/rad; of a length m, N, N/m, N s/m.
struct CoordinateForces {
    double stiffness = 0;
    std::optional<double> rest;  ///< coordinate without force; default: that of the start as written, less preload/stiffness
    double preload = 0;          ///< force at the start as written against growth
    double damping = 0;
    double friction = 0;                          ///< Coulomb: the force or torque of sliding
    std::optional<std::array<double, 2>> limits;  ///< stops, with the stiffness of contact
};

/// On which side a closed linkage has a joint; see Assemble.
enum class AssembleSide { left, right, ahead, behind };

/// Which of its assemblies a closed linkage takes, said at the joint between its two bodies that no motor drives:
///   left, right    the way from joint `from` to this one, and on to joint `to`, turns so, seen with this joint's axis towards the viewer
///   ahead, behind  one of the three joints is prismatic: of the other two, in that order, the second lies so along the slide's axis
/// `from` joins one of this joint's bodies to something else, `to` the other.
struct Assemble {
    AssembleSide side = AssembleSide::left;
    std::string from, to;  ///< empty: the only other joint of this one's body a; of b
};

/// Two bodies, or one and the world. The joint's coordinate: the angle about the axis from a to b (revolute, screw), 0 at the start as
/// written, or the slide of b's point from a's along the axis (prismatic, cylindrical). Which way b is turned about the axis against a
/// where the joint fixes it (prismatic, fixed) is how the start has it.
struct Joint {
    std::string name, where;
    JointKind kind = JointKind::revolute;
    Attachment a, b;
    double pitch = 0;               ///< screw: slide per turn [m]
    std::optional<double> swing;    ///< ball: how far apart the two axes may be [rad]; a stop, with the stiffness of contact
    std::array<std::string, 2> of;  ///< gear, rack: names of two joints
    double ratio = 1;               ///< gear: angle of the second joint per angle of the first; rack: slide per angle [m/rad]
    CoordinateForces forces;
    bool collide = false;  ///< do the two bodies feel contact with each other?
    std::optional<Assemble> assemble;
};

/// Between two points, or about or along a joint's coordinate; a damper is one without stiffness.
struct Spring {
    std::string name, where;
    std::string joint;  ///< empty: from point to point
    Attachment a, b;
    CoordinateForces forces;
};

enum class MotorKind {
    motion,  ///< the joint's coordinate is that of the start as written and the curve
    effort   ///< the curve is the force or torque along the coordinate
};

struct Motor {
    std::string name, where;
    std::string joint;
    MotorKind kind = MotorKind::motion;
    Curve curve;
};

/// A force at a point of a body, constant in the world.
struct PointLoad {
    std::string name, where;
    std::string body;
    Vector3 point = Vector3::Zero();  ///< in the body's file frame [m]
    Vector3 force = Vector3::Zero();  ///< [N]
};

struct Mechanism {
    std::vector<Joint> joints;
    std::vector<Spring> springs;
    std::vector<Motor> motors;
    std::vector<PointLoad> loads;
    bool empty() const { return joints.empty() && springs.empty() && motors.empty() && loads.empty(); }
};

}  // namespace fettle::core::scene
