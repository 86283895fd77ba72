// SPDX-License-Identifier: MIT
/// Design parameters and what they move: dimensions of shapes, start poses and velocities, densities, gravity, forces, torques, rates, the
/// minimum separation, and the numbers of joints, springs, motors and loads. How a scene is moved by them: problem/moved_scene.hpp.
///
/// What a parameter moves is a sum over all moves of that target: dimension = sum (scale p + offset), and so for every number and for each
/// component of a vector that has a nonzero coefficient. The scene's own value of a moved target is replaced, so that a design says all by
/// itself what its `value`s are; a turn is added to the scene's rotation. Targets are linear in p, meshes are not.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"
#include "fettle/core/base/units.hpp"
#include "fettle/core/model/mechanism.hpp"

namespace fettle::design::description {

enum class MoveTarget {
    dimension,
    position,  ///< vector: of the file frame's origin at the start
    density,
    motor_rate,        ///< of a prescribed coordinate
    turn,              ///< vector: a rotation vector, world axes, applied to the body's rotation about its file frame's origin
    velocity,          ///< vector: linear_velocity
    angular_velocity,  ///< vector
    force,             ///< vector: on a body
    torque,            ///< vector: on a body, world axes
    gravity,           ///< vector: of the scene; `body` counts for nothing
    dmin,              ///< minimum separation, of the scene; `body` counts for nothing
    // Coefficients of friction:
    body_mu,      ///< a body's own
    material_mu,  ///< of materials[0]
    pair_mu,      ///< of the pair materials[0], materials[1]
    default_mu,   ///< of what has none of its own
    // Of `part`, one of the scene's mechanism:
    point_a,  ///< vector: of a joint or spring, in a's file frame (of the world: in the world)
    point_b,
    axis_a,  ///< vector: of a joint
    axis_b,
    stiffness,  ///< of a joint or spring, as those below
    rest,
    preload,
    damping,
    friction,
    lower_limit,
    upper_limit,
    pitch,        ///< of a screw
    ratio,        ///< of a gear, or a rack's radius
    curve_value,  ///< of a motor's curve: values[entry]
    curve_rate,
    load_point,  ///< vector: of a load, in the body's file frame
    load_force   ///< vector
};

/// Is it three numbers, whose components are moved by `direction`?
bool is_vector(MoveTarget target);
/// Is it of the scene as a whole?
bool is_of_scene(MoveTarget target);
/// Is it a coefficient of friction?
bool is_of_friction(MoveTarget target);
/// Is it a number or vector (those from point_a on) of one of the scene's joints, springs, motors and loads?
bool is_of_mechanism(MoveTarget target);

/// One target of one parameter. SI throughout: target = scale * p + offset.
struct Move {
    MoveTarget target = MoveTarget::dimension;
    int body = 0;
    std::string dimension = {};  ///< of the body's shape (MoveTarget::dimension)
    int dof = 0;                 ///< 0 .. 5: px py pz rx ry rz (MoveTarget::motor_rate)
    double scale = 1, offset = 0;
    Vector3 direction = Vector3::Zero();        ///< coefficients of a vector's components
    Vector3 position_offset = Vector3::Zero();  ///< of a vector, SI; counts in components with a nonzero coefficient
    core::model::Origin part = {};              ///< the joint, spring, motor or load
    int entry = 0;                              ///< of a curve's values
    std::vector<std::string> materials = {};    ///< whose coefficient of friction it is
};

struct Parameter {
    std::string name;
    double value = 0, lower = 0, upper = 0;  ///< SI
    Unit unit = {};                          ///< that people read it in; trial values are those that a file in it can hold exactly
    std::vector<Move> moves;
};

VectorX values_of(const std::vector<Parameter>& parameters);

/// What is wrong with p (SI) as values of these parameters, by name: not one finite number for each, or one that is farther beyond its
/// bounds than they are apart. Within that, differences and searches may look beyond a bound; farther out it is most often a number in
/// another unit. For what is given from outside: nothing here asks it of its own trials.
Errors check_values(const std::vector<Parameter>& parameters, const VectorX& p);

/// The number of `unit`s that is `si`, or one of its neighbours: one that to_si (core/base/units.hpp) maps back to the same bits, if there
/// is one (not every SI value is some number of millimetres; representable() gives the nearest that is).
double from_si(double si, const Unit& unit);

/// The SI value nearest to `si`, to a few units of rounding, that a file in this unit can hold exactly: to_si(from_si(si)).
double representable(double si, const Unit& unit);

}  // namespace fettle::design::description
