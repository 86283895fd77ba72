// SPDX-License-Identifier: MIT
/// The barrier potential of one pair of primitives and its derivatives in the tangent coordinates of the two bodies.
///
/// Everything follows from the closest points' weights (geometry/distance.hpp). With r = sum w_i x_i, D = r.r, and interior
/// parameters beta_a with r_a = dr/dbeta_a, the envelope theorem gives
///   dD = 2 w (x) r,   d2D = 2 w w^T (x) I - 2 sum_ab A_a (K^-1)_ab A_b^T,   A_a = w (x) r_a + w'_a (x) r,   K_ab = r_a . r_b.
/// Each of these vectors is a rigid pattern on each body, so its pull-back to (dq, phi) is a cross product: no 12x12 products,
/// and the definite part has a closed form instead of an eigen-decomposition.
#pragma once

#include <array>

#include "fettle/core/base/types.hpp"
#include "fettle/core/contact/barrier.hpp"
#include "fettle/core/contact/primitive_pair.hpp"
#include "fettle/core/geometry/distance.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"

namespace fettle::core::contact {

enum class HessianKind {
    exact,     ///< true second derivative
    projected  ///< positive semi-definite approximation per pair
};

/// One pair closer than the activation distance, in world coordinates.
struct ContactPair {
    PairType type = PairType::point_triangle;
    PairVertices x;               ///< world [m]; the first primitive's vertices are on body `first`
    std::array<int, 4> vertex{};  ///< indices into the bodies' meshes
    std::array<int, 2> edge{};    ///< edge_edge: indices of the two edges
    geometry::ClosestPoints closest;
    double mollifier_eps = 0;  ///< edge_edge: eps [m^4]
    double weight = 1;         ///< on the potential; if the barrier is area-weighted [m^2], half the vertex's area, or half the lesser of
                               ///< the edges' (they cannot share more)
};

/// How many of the four vertices lie on the first body.
inline int first_count(PairType type) { return type == PairType::point_triangle ? 1 : 2; }

inline geometry::ClosestPoints closest_points(PairType type, const PairVertices& x) {
    return type == PairType::point_triangle ? geometry::point_triangle_closest(x[0], x[1], x[2], x[3])
                                            : geometry::edge_edge_closest(x[0], x[1], x[2], x[3]);
}

/// |e1 x e2|^2 of an edge-edge pair.
inline double edge_cross_squared(const PairVertices& x) { return (x[1] - x[0]).cross(x[3] - x[2]).squaredNorm(); }

/// Potential [J x weight]; 0 beyond the activation distance. Contract: closest distance > dmin.
double pair_potential(const ContactPair& pair, const BarrierParameters& parameters);

/// Forces on the four vertices, d(potential)/dx_i (world).
std::array<Vector3, 4> pair_forces(const ContactPair& pair, const BarrierParameters& parameters);

/// (d2(potential)/dx dx) v for the true second derivative, v and result per vertex (world). For the adjoint.
std::array<Vector3, 4> pair_hessian_product(const ContactPair& pair, const BarrierParameters& parameters, const std::array<Vector3, 4>& v);

/// Magnitude of the force between the closest points, times the potentials' weight (a mollifier's torque is left out).
double normal_force(const ContactPair& pair, const BarrierParameters& parameters);

/// The nearest positive semi-definite matrix. Both by their lower triangles.
Matrix12 positive_part(const Matrix12& lower);

/// Sums over the contacts of one pair of bodies.
struct BodyPairSum {
    kinematics::PoseGradient first, second;
    Matrix12 hessian = Matrix12::Zero();  ///< Gauss-Newton part, (q, phi) of first, then of second; lower triangle only
};

/// Adds one pair's gradient and Hessian. `first_position`, `second_position`: the bodies' q.
void add_pair_derivatives(const ContactPair& pair, const BarrierParameters& parameters, HessianKind kind, const Vector3& first_position,
                          const Vector3& second_position, BodyPairSum& sum);

/// Adds stiffness * v v^T, v the pull-back of a unit displacement `direction` between two material points: the Hessian of
/// stiffness / 2 (direction . (x_first - x_second))^2 less the curvature of the rotations. `arm_*`: the points relative to the bodies' q.
void add_rigid_stiffness(Matrix12& hessian, double stiffness, const Vector3& direction, const Vector3& arm_first,
                         const Vector3& arm_second);

}  // namespace fettle::core::contact
