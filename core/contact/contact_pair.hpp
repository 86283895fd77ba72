// SPDX-License-Identifier: MIT
/// The barrier potential of one pair of primitives and its derivatives in the tangent coordinates of the two bodies.
///
/// Everything follows from the closest points' weights (geometry/distance.hpp). With r = sum w_i x_i, D = r.r, and interior
/// parameters beta_a with r_a = dr/dbeta_a, the envelope theorem gives
///   dD = 2 w (x) r,   d2D = 2 w w^T (x) I - 2 sum_ab A_a (K^-1)_ab A_b^T,   A_a = w (x) r_a + w'_a (x) r,   K_ab = r_a . r_b.
/// Each of these vectors is a rigid pattern on each body, so its pull-back to (dq, phi) is a cross product. A pair does not feel where
/// the two bodies are together: of (dq, phi) of both only (dq_first - dq_second, phi_first, phi_second) matters, nine coordinates in which
/// every part is a few outer products. The definite part has a closed form instead of an eigen-decomposition, also where the mollifier
/// acts.
#pragma once

#include <array>
#include <cmath>

#include "core/base/types.hpp"
#include "core/contact/barrier.hpp"
#include "core/geometry/distance.hpp"
#include "core/geometry/primitive_pair.hpp"
#include "core/kinematics/tangent_system.hpp"
#include "core/model/model.hpp"

namespace fettle::core::contact {

enum class HessianKind {
    exact,      ///< true second derivative
    projected,  ///< positive semi-definite approximation per pair
    none        ///< no second derivative is asked for: Hessians are left as they are
};

/// A contact of round surfaces (round_contacts.hpp): its vertices are on centre lines, or on a plane, and each body's surface is `reach`
/// from its closest point towards the other's. With d = |r| and R the sum of both the gap is
///   d - R outside, R - d inside,   reach = sign radius + side cover.
struct RoundGap {
    signed char side = 0;               ///< 1: outside, -1: inside; 0: no round surfaces, the gap is d
    bool has_far = false;               ///< inside: circles all round, which meet at R + d too
    std::array<signed char, 2> sign{};  ///< [first, second] 1, or -1 of what is inside of the other; 0: of a plane or sharp edge
    std::array<int, 2> centre{-1, -1};  ///< whose radius it is, into geometry::RoundSurfaces::radii; -1: none
    std::array<int, 2> cover{-1, -1};   ///< the centre whose corner's height is the body's cover; -1: it is 0
    std::array<double, 2> reach{};      ///< [m]
    double radius() const { return reach[0] + reach[1]; }
};

/// A contact's vertex that is no vertex of the mesh but centre k of the body's round surfaces.
inline int round_vertex(int k) { return -1 - k; }
/// A contact's vertex in its body's frame.
inline Vector3 undeformed_vertex(const model::Body& body, int vertex) {
    return vertex >= 0 ? Vector3(body.mesh.vertices.col(vertex)) : Vector3(body.round->centres.col(-1 - vertex));
}

/// One pair closer than the activation distance, in world coordinates.
struct ContactPair {
    geometry::PairType type = geometry::PairType::point_triangle;
    geometry::PairVertices x;     ///< world [m]; the first primitive's vertices are on body `first`
    std::array<int, 4> vertex{};  ///< indices into the bodies' meshes, or round_vertex
    int face = -1;                ///< point_triangle: index into BodyHierarchy::faces; -1: an edge or a vertex, corners coincide
    geometry::ClosestPoints closest;
    double mollifier_eps = 0;  ///< edge_edge: eps [m^4]
    double weight = 1;         ///< on the potential; if the barrier is area-weighted [m^2], half the vertex's area, or half the lesser of
                        ///< the edges' (they cannot share more). Times how often it counts (counted_contacts.hpp), which can be negative
    RoundGap round{};
};

/// The distance of the two surfaces, with its sign [m].
inline double gap_of(const ContactPair& pair) {
    const double d = std::sqrt(pair.closest.distance_squared);
    return pair.round.side == 0 ? d : pair.round.side * (d - pair.round.radius());
}

/// r/d, from the second body to the first; of centre lines that are one, any direction across them.
Vector3 contact_normal(const ContactPair& pair);

/// b of the pair, without its mollifier, and its derivatives in D = |r|^2. With s the gap of round surfaces, sigma their side and g = s^2 -
/// dmin^2:
///   db/dD = b' sigma s/d,   d2b/dD2 = (2 b'' s^2 + b' - b' sigma s/d)/(2 D),
/// and the same at s = R + d added where the far side meets too. There the sum is even in d: near d = 0 it is taken as quadratic.
ScalarDerivatives barrier_of(const ContactPair& pair, const BarrierParameters& parameters);

/// The same in d, of round surfaces, and what its slope changes by with R.
struct RoundBarrier {
    ScalarDerivatives in_distance;
    double slope_by_radius = 0;
};
RoundBarrier round_barrier(const ContactPair& pair, const BarrierParameters& parameters);

inline geometry::ClosestPoints closest_points(geometry::PairType type, const geometry::PairVertices& x) {
    return type == geometry::PairType::point_triangle ? geometry::point_triangle_closest(x[0], x[1], x[2], x[3])
                                                      : geometry::edge_edge_closest(x[0], x[1], x[2], x[3]);
}

/// |e1 x e2|^2 of an edge-edge pair.
inline double edge_cross_squared(const geometry::PairVertices& x) { return (x[1] - x[0]).cross(x[3] - x[2]).squaredNorm(); }

/// Does the mollifier act, so that the potential depends on how parallel the edges are?
inline bool is_mollified(const ContactPair& pair) {
    return pair.type == geometry::PairType::edge_edge && pair.round.side == 0 && edge_cross_squared(pair.x) < pair.mollifier_eps;
}

/// Potential [J x weight]; 0 beyond the activation distance. Contract: closest distance > dmin.
double pair_potential(const ContactPair& pair, const BarrierParameters& parameters);

/// Forces on the four vertices, d(potential)/dx_i (world).
std::array<Vector3, 4> pair_forces(const ContactPair& pair, const BarrierParameters& parameters);

/// (d2(potential)/dx dx) v for the true second derivative, v and result per vertex (world). For the adjoint.
std::array<Vector3, 4> pair_hessian_product(const ContactPair& pair, const BarrierParameters& parameters, const std::array<Vector3, 4>& v);

/// Magnitude of the force between the closest points, times the potentials' weight (a mollifier's torque is left out).
double normal_force(const ContactPair& pair, const BarrierParameters& parameters);

/// Coordinates of two bodies that a contact between them feels: (dq_first - dq_second, phi_first, phi_second).
using PairVector = Eigen::Matrix<double, 9, 1>;
using PairMatrix = Eigen::Matrix<double, 9, 9>;

/// hessian += factor v v^T in its lower triangle; what is above it is lost.
void add_outer_product(PairMatrix& hessian, double factor, const PairVector& v);

/// The nearest positive semi-definite matrix; reads the lower triangle.
PairMatrix positive_part(const PairMatrix& lower);

/// Sums over the contacts of one pair of bodies.
struct BodyPairSum {
    kinematics::PoseGradient first, second;
    PairMatrix hessian = PairMatrix::Zero();  ///< Gauss-Newton part, lower triangle only
};

/// The Hessian in (q, phi) of the first body, then of the second.
Matrix12 in_both_bodies(const PairMatrix& hessian);

/// Adds one pair's gradient and Hessian. `first_position`, `second_position`: the bodies' q.
void add_pair_derivatives(const ContactPair& pair, const BarrierParameters& parameters, HessianKind kind, const Vector3& first_position,
                          const Vector3& second_position, BodyPairSum& sum);

/// Adds stiffness * v v^T, v the pull-back of a unit displacement `direction` between two material points: the Hessian of
/// stiffness / 2 (direction . (x_first - x_second))^2 less the curvature of the rotations. `arm_*`: the points relative to the bodies' q.
void add_rigid_stiffness(PairMatrix& hessian, double stiffness, const Vector3& direction, const Vector3& arm_first,
                         const Vector3& arm_second);

}  // namespace fettle::core::contact
