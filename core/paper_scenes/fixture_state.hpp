// SPDX-License-Identifier: MIT
/// Poses as the source paper's program writes them: world = exp([rotation]) R0^T (x - c) + position, where x is the body as placed at the
/// start, c its centre of mass and R0 the principal axes of its inertia there (eigenvalues ascending, determinant +1).
#pragma once

#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::paper_scenes {

/// Three numbers; two of them are a 2D scene, which is `unsupported`; more than three are cut.
std::optional<Vector3> fixture_vector(const files::JsonNode& node);

/// R0 of a placed body, as that program computes it with Eigen's eigenvectors; the identity where exactly two rotations are fixed.
/// Where moments are equal (a cube) no axes are preferred and that program's depend on rounding: here entries of the inertia tensor that
/// differ by less than 1e-9 of the largest are made equal first, so that axes of symmetry that lie along the world's stay there.
Matrix3 fixture_principal_axes(const scene::Body& body, int fixed_rotations);

/// `kinematic_poses` of a kinematic body whose pose, mesh and mass kind are known: one pose per time step, until `stop_time`.
scene::PoseScript read_kinematic_poses(const files::JsonNode& node, const scene::Body& body, int fixed_rotations, double timestep,
                                       std::optional<double> stop_time);

/// Puts every body where the last entry of `animation.state_sequence` left it, with its velocity, and takes the time that has passed off
/// scripts and off the end time. R0 and c are not needed: the first entry holds them. Faults go to the document.
void continue_from_last_state(const files::JsonNode& animation, scene::Scene& scene);

}  // namespace fettle::core::paper_scenes
