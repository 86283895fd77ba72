// SPDX-License-Identifier: MIT
/// The numbers of a scene that a design may move: one table. For each its JSON pointer in a scene's file, its dimension, where it is in a
/// Scene, when there is none, and which values it must not have. A second Scene that holds derivatives (adjoint/scene/scene_gradient.hpp)
/// has them at the same places, so that setting a number and taking its derivative are one accessor, `at`.
///     /gravity/2                          /contact/dmin
///     /friction/mu                        /materials/steel/mu                /friction/pairs/0/mu
///     /bodies/1/position/0                /bodies/1/density                  /bodies/1/shape/dimensions/radius
///     /bodies/1/prescribed/rz/rate        /joints/0/point_a/2                /joints/0/limits/1
///     /springs/0/stiffness                /motors/0/angle/values/3           /loads/0/force/0
/// A body's pose follows from its `rotation` or `rotation_vector`, and its `turn`, which has no key in a file: a rotation vector, world
/// axes, that turns the body as written. Who sets one of them makes the pose's rotation anew (settle_rotation). Counts, names,
/// tolerances of solvers, dhat and kappa have no place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::scene {

/// A row of the table, which one of its bodies, joints, ..., and which entry (component of a vector, value of a curve, name in order).
struct Place {
    int row = 0, item = 0, entry = 0;
    auto operator<=>(const Place&) const = default;
};

/// What a place is to its scene. Who treats places by what they are switches over it without a default, so that a new kind is a new case.
enum class PlaceKind {
    gravity,
    minimum_separation,
    friction,  ///< the scene's, a material's, a pair's, a body's coefficient
    shape_dimension,
    position,
    rotation,  ///< angles, a rotation vector, or the turn
    density,
    start_velocity,  ///< linear and angular
    body_load,       ///< force and torque at a body's reference point
    prescribed_rate,
    joint_axis,
    joint_point,
    pitch,
    ratio,  ///< of a gear; the radius of a rack
    joint_limits,
    motor_values,
    motor_rate,
    spring_point,
    spring_limits,
    coordinate_force,  ///< stiffness, rest, preload, damping, friction of a joint or spring
    point_load         ///< its point and its force
};
PlaceKind kind_of(const Place& place);

/// What a pointer names. Bodies, joints, springs, dampers, motors and loads are named by their number in the file, from 0, or by their
/// name: "/bodies/pin/density". (A file's dampers stand after its springs in Mechanism::springs, which /springs counts through; a damper is
/// a spring without stiffness and limits.) A motor's curve is `angle`, `travel`, `torque` or `force`, as in its file, or just `curve`.
/// Errors, `where` the pointer: a row that is not there, with the nearest; nothing of that name or number; what the scene has no such
/// number for ("`hinge` is not a screw").
base::Result<Place> find_place(const Scene& scene, std::string_view pointer);
/// As the scene's file has it, with numbers.
std::string pointer_to(const Scene& scene, const Place& place);
/// A name in a pointer: "~" as "~0", "/" as "~1".
std::string escaped(std::string_view name);

/// All that the scene has.
std::vector<Place> places_of(const Scene& scene);
/// Rows of the table, for those who go through all of it.
int row_count();

base::Dimension dimension_at(const Scene& scene, const Place& place);

/// The number, to be read or set; one that the scene leaves to its defaults (a spring's rest, a body's mu) becomes 0 first.
/// Contract: a place of this scene, or of one that differs from it in numbers alone.
double& at(Scene& scene, const Place& place);
/// The number; NaN if the scene leaves it to its defaults.
double value_at(const Scene& scene, const Place& place);

/// Why the scene cannot be differentiated by the number as it is, or makes no sense with it: springs, dampers and coefficients of friction
/// of 0 or less (at 0 there is none), loads without force, limits out of order. Empty: nothing of the kind.
base::Errors faults_at(const Scene& scene, const Place& place);

/// The rotation of a body's pose from its orientation and turn.
void settle_rotation(Body& body);

/// Sets all numbers of the table to 0.
void clear_numbers(Scene& scene);

}  // namespace fettle::core::scene
