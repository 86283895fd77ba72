// SPDX-License-Identifier: MIT
/// Derivative of a certified clearance with respect to everything that moves it: shapes, and the path that the bodies take.
///
/// The upper bound is a distance d = n.(sum of w_i x_i) between two points at one time: closest points with weights w_i, their unit
/// direction n from b to a, x_i = R X_i + q. It is a minimum over time, features and points, so (envelope theorem) its derivative is the
/// partial one with all of those held: R^T n w_i on the vertices, and on each body's pose at that time a force f = sum w_i n and a torque
/// tau = sum R X_i x w_i n, dual to dq and to phi in dR = [phi] R.
/// Where several witnesses attain the minimum (parallel faces, the same gap twice), it is not differentiable, but it has a one-sided
/// derivative in every direction: the least of the witnesses' (Danskin). clearance_derivative() is that; clearance_adjoint() takes one.
///
/// Path. The segment from node k to node k + 1 of a step is R(s) = exp(theta(s)) R_t, theta and q linear between the nodes' coordinates:
///   phi = exp(theta(s)) phi_t + J(theta(s)) ((1 - s) dtheta_k + s dtheta_{k+1}),   dq = (1 - s) dq_k + s dq_{k+1},
/// J the left Jacobian. This is exact for the path as stored, its nodes taken as free: segment_gradient().
/// A step's first and last node are its start and end poses; theta_n = log(R_{t+1} R_t^T), so dtheta_n = J(theta_n)^-1 (phi_{t+1} -
/// exp(theta_n) phi_t). Nodes between them move by a share of the ends' motions where that is known (path_nodes.hpp):
///   dq_k = (1 - share) dq_t + share dq_{t+1},   dtheta_k = share dtheta_n   (entry by entry).
/// Where it is not known there is no derivative, and that is said with the step.
///
///     const auto& trajectory = simulation.trajectory;  // simulated with for_gradient
///     auto seeds = adjoint::zero_seeds(model, count_of(trajectory.steps));
///     const auto refusal = adjoint::clearance::clearance_adjoint(model, trajectory, pair, 1, seeds.trajectory_bar, seeds.model_bar);
///     auto gradients = adjoint::stepper::reverse_sweep(model, trajectory, {seeds.trajectory_bar});
///     if (!refusal.empty() || !gradients) return 2;
///     adjoint::ModelGradient gradient = std::move(gradients).value().front();
///     adjoint::add(gradient, seeds.model_bar);  // d clearance / d everything in the model
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adjoint/clearance/path_nodes.hpp"
#include "adjoint/model_gradient.hpp"
#include "core/clearance/clearance.hpp"

namespace fettle::adjoint::clearance {

/// Derivative of a witness's distance, sparse. Poses: (f, tau), dual to (dq, phi). Poses of one body and time may stand in several parts,
/// which add up.
struct ClearanceGradient {
    struct VertexPart {
        int body, vertex;
        Vector3 bar;
    };
    struct PosePart {
        int t, body;
        Vector6 bar;
    };
    std::vector<VertexPart> vertices;
    std::vector<PosePart> poses;
    std::string refusal;  ///< why there is no derivative, with the step (no_derivative_at); empty: there is one
};

/// At one witness of a pair (bodies a, b); empty if the distance there is 0, which has no direction, and but for `refusal` if it has no
/// derivative. A witness as assembled (step -1) moves with poses[0] alone.
/// Contract: |theta_n| is not a multiple of 2 pi other than 0 (there the end pose does not determine the path).
ClearanceGradient clearance_gradient(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int a, int b,
                                     const core::clearance::Witness& witness);

/// The same with respect to the stored path of one body: exact, whatever its nodes are.
struct SegmentGradient {
    Vector3 base_bar = Vector3::Zero();  ///< dual to phi_t in dR_t = [phi_t] R_t, the nodes' chart coordinates held
    std::array<Vector6, 2> node_bar{Vector6::Zero(), Vector6::Zero()};  ///< (position, rotation vector) of nodes `segment`, `segment` + 1
};
/// The derivative at a witness during the motion; nothing if the distance there is 0. Contract: witness.step >= 0, body is a or b.
std::optional<SegmentGradient> segment_gradient(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int a, int b,
                                                const core::clearance::Witness& witness, int body);

/// Adds scale * clearance_gradient at pair.witness: on poses to `trajectory_bar`, on vertices to `model_bar`.
/// @param trajectory_bar  entries G of pose_bar are those of the 3x4 matrix with <G, [[phi] R, dq]> = tau.phi + f.dq: defined for motions
///                        of a rigid body only, G = [[tau] R / 2, f].
/// @return                ClearanceGradient::refusal: if not empty, nothing was added.
[[nodiscard]] std::string clearance_adjoint(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                            const core::clearance::PairClearance& pair, double scale, TrajectoryGradient& trajectory_bar,
                                            ModelGradient& model_bar);

/// A direction: tangents (dq, phi) of each pose [t][body] (tangent_sweep.hpp makes them), and of the model's vertices.
struct ClearanceDirection {
    std::vector<std::vector<Vector6>> pose_dot;
    std::vector<Matrix3X> vertices_dot;  ///< [body]; empty: shapes held
};
/// Contract: there is a derivative.
double directional(const ClearanceGradient& gradient, const ClearanceDirection& direction);

/// lim (d(x + h direction) - d(x)) / h as h -> 0+: the least over all features (tied_features.hpp) that come within `tolerance` [m] of
/// the least distance at the instants of pair.witnesses (of pair.witness if there are none); 0 if the bodies touch.
/// Exact if those are all the instants that tie: certify with a witness_tolerance. Faces that slide along each other at one distance tie
/// at all times; then this is an upper bound. Nothing: one of them has no derivative (no_derivative_at).
std::optional<double> clearance_derivative(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                           const core::clearance::PairClearance& pair, const ClearanceDirection& direction,
                                           double tolerance);

}  // namespace fettle::adjoint::clearance
