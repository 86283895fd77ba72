// SPDX-License-Identifier: MIT
/// From parameters to a scene and back. Forward: parameters -> a Scene, and the derivative of everything in it that moved. Backward: a
/// ModelGradient -> d/d(parameters). What a parameter moves: description/parameter.hpp.
#pragma once

#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/design/description/design.hpp"

namespace fettle::design::problem {

/// Derivative of one body's data with respect to one parameter.
struct BodyChange {
    int parameter = 0, body = 0;
    Matrix3X vertices_dot;                   ///< 3 x n in the file's frame; 0 columns: vertices do not move
    Matrix3 rotation_dot = Matrix3::Zero();  ///< of the file frame's start pose
    Vector3 position_dot = Vector3::Zero();
    double density_dot = 0;
    Vector6 rate_dot = Vector6::Zero();  ///< of the prescribed coordinates' rates
};

/// A move of what is linear in its parameter: numbers and vectors of joints, springs, motors and loads, velocities, forces, torques,
/// gravity, minimum separation, coefficients of friction.
struct LinearChange {
    int parameter = 0;
    description::Move move;
};

struct MovedScene {
    core::scene::Scene scene;
    std::vector<BodyChange> changes;  ///< at most one per parameter and body, in that order
    std::vector<LinearChange> linear_changes;
};

/// Without its derivative the vertices' changes are missing: shapes are asked for their meshes alone, which can be far cheaper.
enum class SceneDerivative { wanted, not_wanted };

/// The scene at parameter values p (SI, one per parameter), and its derivative there.
/// Errors: dimensions that make no valid part; `where` names the parameter's body and dimension. Springs, dampers and loads of 0
/// (mechanism_moves.hpp), and no friction (friction_moves.hpp).
/// Contract: check_design finds nothing.
Result<MovedScene> move_scene(const description::Design& design, const VectorX& p, SceneDerivative derivative = SceneDerivative::wanted);

/// dJ/dp from dJ/d(model data), exactly transposed to move_scene:
///   dJ/dp_k = sum over bodies <vertices_bar, dX/dp_k> + <R_bar, dR> + q_bar . (dR c + dx) + density_bar drho + sum_t increment_bar_t .
///   dincrement_t
/// with q = R c + x for the reference point c, and the increment of a prescribed coordinate linear in its rate. Of a model with joints the
/// gradient first goes back through the start's assembly to what was written (adjoint/model).
VectorX pull_back(const MovedScene& moved, const core::model::Model& model, const adjoint::ModelGradient& gradient, int parameter_count);

}  // namespace fettle::design::problem
