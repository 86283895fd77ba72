// SPDX-License-Identifier: MIT
/// Design parameters and the numbers of a scene that they move (core/scene/place.hpp has the table of those). How a scene is moved by them:
/// problem/moved_scene.hpp.
///
/// What a parameter moves is a sum over all moves of that place: number = sum (scale p + offset). The scene's own number there is replaced,
/// so that a design says all by itself what its `value`s are; a turn is added to the scene's rotation. Numbers are linear in p, meshes are
/// not.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"
#include "fettle/core/base/units.hpp"
#include "fettle/core/expression/parse_formula.hpp"

namespace fettle::design::description {

/// One number that a parameter moves. SI throughout: scale * p + offset.
struct Move {
    std::string place;  ///< "/bodies/1/position/2", "/bodies/pin/shape/dimensions/radius"
    double scale = 1, offset = 0;
};

/// Moves of a vector's components, those with a coefficient that is not 0: direction[i] scale p + offset[i].
/// @param place  Of the vector: "/bodies/1/position".
std::vector<Move> vector_moves(const std::string& place, const Vector3& direction, double scale = 1,
                               const Vector3& offset = Vector3::Zero());

struct Parameter {
    std::string name;
    double value = 0, lower = 0, upper = 0;  ///< SI
    Unit unit = {};                          ///< that people read it in; trial values are those that a file in it can hold exactly
    std::vector<Move> moves;
};

VectorX values_of(const std::vector<Parameter>& parameters);
std::vector<std::string> names_of(const std::vector<Parameter>& parameters);
/// The parameters as what formulas may name; numbers without a unit count in SI.
core::expression::Scope scope_of(const std::vector<Parameter>& parameters);

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
