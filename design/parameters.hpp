// SPDX-License-Identifier: MIT
/// Design parameters and what they move: dimensions of generated parts, start positions, densities, motor rates.
/// Forward: parameters -> a Scene, and the derivative of everything in it that moved. Backward: a ModelGradient -> d/d(parameters).
///
/// What a parameter moves is a sum over all moves of that target: dimension = sum (scale p + offset), and so for a density, a motor's rate
/// and each component of a position that has a nonzero coefficient. The scene's own value of a moved target is replaced, so that a
/// design says all by itself what its `value`s are. Targets are linear in p, meshes are not.
#pragma once

#include <string>
#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/parameter_units.hpp"

namespace fettle::design {

enum class MoveTarget { dimension, position, density, motor_rate };

/// One target of one parameter. SI throughout: target = scale * p + offset.
struct Move {
    MoveTarget target = MoveTarget::dimension;
    int body = 0;
    std::string dimension;  ///< of the body's shape (MoveTarget::dimension)
    int dof = 0;            ///< 0 .. 5: px py pz rx ry rz (MoveTarget::motor_rate)
    double scale = 1, offset = 0;
    Vector3 direction = Vector3::Zero();        ///< coefficients of the file frame's origin (MoveTarget::position)
    Vector3 position_offset = Vector3::Zero();  ///< [m]; counts in components with a nonzero coefficient
};

struct Parameter {
    std::string name, where;                 ///< `where`: file and JSON pointer
    double value = 0, lower = 0, upper = 0;  ///< SI
    ParameterUnit unit;                      ///< that the file uses
    std::vector<Move> moves;
};

/// Derivative of one body's data with respect to one parameter.
struct BodyChange {
    int parameter = 0, body = 0;
    Matrix3X vertices_dot;                   ///< 3 x n in the file's frame; 0 columns: vertices do not move
    Matrix3 rotation_dot = Matrix3::Zero();  ///< of the file frame's start pose
    Vector3 position_dot = Vector3::Zero();
    double density_dot = 0;
    Vector6 rate_dot = Vector6::Zero();  ///< of the prescribed coordinates' rates
};

struct MovedScene {
    core::scene::Scene scene;
    std::vector<BodyChange> changes;  ///< at most one per parameter and body, in that order
};

/// The scene at parameter values p (SI, one per parameter), and its derivative there.
/// Errors: dimensions that make no valid part; `where` names the parameter's body and dimension.
Result<MovedScene> move_scene(const core::scene::Scene& scene, const std::vector<Parameter>& parameters, const VectorX& p);

/// dJ/dp from dJ/d(model data), exactly transposed to move_scene:
///   dJ/dp_k = sum over bodies <vertices_bar, dX/dp_k> + <R_bar, dR> + q_bar . (dR c + dx) + density_bar drho + sum_t increment_bar_t .
///   dincrement_t
/// with q = R c + x for the reference point c, and the increment of a prescribed coordinate linear in its rate.
VectorX pull_back(const MovedScene& moved, const core::model::Model& model, const adjoint::ModelGradient& gradient, int parameter_count);

VectorX values_of(const std::vector<Parameter>& parameters);

}  // namespace fettle::design
