// SPDX-License-Identifier: MIT
/// Scenes whose gradients are tested, and the bookkeeping of directions: what reverse_sweep_test and tangent_sweep_test share.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::tests::adjoint {

using fettle::adjoint::ModelGradient;
using fettle::adjoint::ModelTangent;
using fettle::adjoint::TrajectoryGradient;

struct SweepScene {
    std::string name;
    core::model::Model model;
    int steps = 0;
};

/// Free flight of a spinning body whose reference point is not its centre of mass.
SweepScene free_flight();
/// Boxes fall onto each other and onto a plate: vertex-face, edge-edge, edge-edge nearly parallel.
SweepScene stack();
/// Two boxes of nearly the same size, one on the other with a slight twist: many nearly parallel edge pairs.
SweepScene twisted_pair();
/// A motor turns a paddle about z, whose other five coordinates are free; it strikes a box on the plate.
SweepScene tilting_motor();
/// A tilted block rocks on the plate: two rotations prescribed, the third free; a rider lies on it.
SweepScene double_motor();
/// A kinematic pusher (moves and turns) drives a box with fixed coordinates against a free one.
SweepScene pusher();
std::vector<SweepScene> all_scenes();
/// The same with friction, solved in two rounds: boxes that slide faster than eps_v, and some that hardly do.
SweepScene rubbed(SweepScene scene);

/// How many contacts of each sort a trajectory has at its stored configurations.
struct ContactCount {
    int vertex_face = 0, edge_edge = 0, mollified = 0;
};
ContactCount count_contacts(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

enum class ParameterKind { vertices, pose_start, velocity_start, density, gravity, force, torque, increments, friction, dmin };
/// Friction's coefficients where there is friction, dmin where it is above 0, all others always.
std::vector<ParameterKind> kinds_of(const SweepScene& scene);
const char* to_string(ParameterKind kind);

/// A random direction of one kind, scaled so that a unit step changes the scene about as much as it measures. Friction changes in all
/// coefficients alike, and in none where there is no friction.
ModelTangent random_direction(const SweepScene& scene, ParameterKind kind, std::mt19937_64& random);

/// The gradient's own direction in the vertices, largest entry 0.05 m.
ModelTangent vertex_gradient_direction(const SweepScene& scene, const ModelGradient& gradient);

/// Vertices that move by dX = A X + b, a matrix and a vector for each body: plane faces stay plane. At random, or the gradient in A (times
/// the body's radius) and b; largest entry as before.
ModelTangent affine_direction(const SweepScene& scene, std::mt19937_64& random);
ModelTangent affine_gradient_direction(const SweepScene& scene, const ModelGradient& gradient);

/// model + s * direction, poses moved on the manifold. Masses stay of their kind: solids, shells, wires, points.
core::model::Model moved(const SweepScene& scene, const ModelTangent& direction, double s);

/// <gradient, direction>.
double pairing(const SweepScene& scene, const ModelGradient& gradient, const ModelTangent& direction);

/// J = sum_t,i <weights, P_t,i>; its weights are the seed.
TrajectoryGradient random_seed(const SweepScene& scene, std::mt19937_64& random);
double objective(const TrajectoryGradient& weights, const core::stepper::Trajectory& trajectory);
/// The change of J from one trajectory to another, without the rounding of J.
double objective_change(const TrajectoryGradient& weights, const core::stepper::Trajectory& from, const core::stepper::Trajectory& to);

/// <weights, P_dot> for a tangent sweep's output.
double pairing(const TrajectoryGradient& weights, const core::stepper::Trajectory& trajectory,
               const std::vector<std::vector<Vector6>>& tangents);

}  // namespace fettle::tests::adjoint
