// SPDX-License-Identifier: MIT
/// From parameters to a scene and back. Forward: parameters -> a Scene, and the derivative of everything in it that moved. Backward: a
/// ModelGradient -> d/d(parameters). What follows from parameters: description/design.hpp, Design::numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "core/scene/place.hpp"
#include "design/description/design.hpp"

namespace fettle::design::problem {

/// A number of the scene, and its derivative in one of the parameters that it follows from.
struct MovedNumber {
    int parameter = 0;
    core::scene::Place place;
    double slope = 0;
};

struct MovedScene {
    core::scene::Scene scene;
    std::vector<MovedNumber> numbers;  ///< a place is there once for each of its parameters
    /// [body]: d(vertices)/d(dimension) of the dimensions that are moved, by name.
    std::vector<std::map<std::string, Matrix3X>> jacobians;
};

/// Without its derivative the Jacobians are missing: shapes are asked for their meshes alone, which can be far cheaper.
enum class SceneDerivative { wanted, not_wanted };

/// The scene at parameter values p (SI, one per parameter), and its derivative there.
/// Errors: dimensions that make no valid part; `where` names the parameter's body and dimension. Numbers that have no derivative
/// (core/scene/place.hpp, faults_at).
/// Contract: check_design finds nothing.
Result<MovedScene> move_scene(const description::Design& design, const VectorX& p, SceneDerivative derivative = SceneDerivative::wanted);

/// dJ/dp from dJ/d(model data), exactly transposed to move_scene: with x_bar of the numbers x of the scene (adjoint/model/
/// build_model_adjoint.hpp; of a dimension <dJ/d(vertices), d(vertices)/dx>, of a turn theta J(theta)^T times that of the rotation),
///   dJ/dp_k = sum x_bar dx/dp_k          with x = f(p), the number's formula
/// @return  a row per gradient.
MatrixX pull_back(const MovedScene& moved, const core::model::Model& model, const std::vector<adjoint::ModelGradient>& gradients,
                  int parameter_count);

}  // namespace fettle::design::problem
