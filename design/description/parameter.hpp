// SPDX-License-Identifier: MIT
/// Design parameters and what they move: dimensions of shapes, start positions, densities, motor rates. How a scene is moved by them:
/// problem/moved_scene.hpp.
///
/// What a parameter moves is a sum over all moves of that target: dimension = sum (scale p + offset), and so for a density, a motor's rate
/// and each component of a position that has a nonzero coefficient. The scene's own value of a moved target is replaced, so that a
/// design says all by itself what its `value`s are. Targets are linear in p, meshes are not.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/core/base/units.hpp"

namespace fettle::design::description {

enum class MoveTarget { dimension, position, density, motor_rate };

/// One target of one parameter. SI throughout: target = scale * p + offset.
struct Move {
    MoveTarget target = MoveTarget::dimension;
    int body = 0;
    std::string dimension = {};  ///< of the body's shape (MoveTarget::dimension)
    int dof = 0;                 ///< 0 .. 5: px py pz rx ry rz (MoveTarget::motor_rate)
    double scale = 1, offset = 0;
    Vector3 direction = Vector3::Zero();        ///< coefficients of the file frame's origin (MoveTarget::position)
    Vector3 position_offset = Vector3::Zero();  ///< [m]; counts in components with a nonzero coefficient
};

struct Parameter {
    std::string name;
    double value = 0, lower = 0, upper = 0;  ///< SI
    Unit unit = {};                          ///< that people read it in; trial values are those that a file in it can hold exactly
    std::vector<Move> moves;
};

VectorX values_of(const std::vector<Parameter>& parameters);

/// The number of `unit`s that is `si`, or one of its neighbours: one that to_si (core/base/units.hpp) maps back to the same bits, if there
/// is one (not every SI value is some number of millimetres; representable() gives the nearest that is).
double from_si(double si, const Unit& unit);

/// The SI value nearest to `si`, to a few units of rounding, that a file in this unit can hold exactly: to_si(from_si(si)).
double representable(double si, const Unit& unit);

}  // namespace fettle::design::description
