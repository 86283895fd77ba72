// SPDX-License-Identifier: MIT
/// Planes between the two primitives of a pair, and by how much for certain they separate it.
/// Why that is certain, rounding included: linear_ccd.hpp.
///
/// All works on the four differences of a vertex of the first primitive and one of the second at once, an array of four per axis: few
/// square roots and divisions, in a layout that compilers turn into vector instructions (of the same bits).
#pragma once

#include "core/geometry/primitive_pair.hpp"

namespace fettle::core::ccd {

/// One number per pair of vertices. edge_edge: a0 b0, a0 b1, a1 b0, a1 b1; point_triangle: p t0, p t1, p t2, p t2.
using Lanes = Eigen::Array4d;
/// x_i - x_j: a row per pair of vertices, a column per axis.
using Differences = Eigen::Array<double, 4, 3>;

Differences differences(geometry::PairType type, const geometry::PairVertices& x);

/// Straight motion of a pair from t = 0 to 1.
struct RelativeMotion {
    geometry::PairType type;
    Differences d, e;  ///< at t = 0, 1
    Vector3 largest;   ///< of |d|, |e| per axis: D_k of linear_ccd.hpp
    bool usable;       ///< nothing is NaN, nothing above 1e150: squares do not overflow

    Differences at(double t) const { return (1 - t) * d + t * e; }
};
RelativeMotion relative_motion(geometry::PairType type, const geometry::PairVertices& t0, const geometry::PairVertices& t1);

/// One axis separates the pair by more than dmin at both ends of the motion, and on the same side: the commonest way for candidates to
/// miss.
bool separated_along_axis(const RelativeMotion& motion, double dmin);

/// Along the vector n, of length 1 within 6u, oriented so that positive means apart.
struct SeparatingPlane {
    Vector3 n = Vector3::Zero();
    Lanes p = Lanes::Zero(), q = Lanes::Zero();  ///< n . d, n . e
    double limit = 0;  ///< dmin (1 + 16 u) + 1.01 E: where the computed values exceed it, the pair is farther apart than dmin
    double gap = -1;   ///< least value at the time asked for, less the limit; -1 if that is not positive

    Lanes values(double t) const { return (1 - t) * p + t * q; }
    double least(double t) const { return values(t).minCoeff(); }
};

/// Along `direction` (of any length, either sign) at time t.
SeparatingPlane separating_plane(const RelativeMotion& motion, const Vector3& direction, double dmin, double t);

/// The same for a pair at rest: q is left zero. `largest`: of |r| per axis.
SeparatingPlane separating_plane_at_rest(const Differences& r, const Vector3& largest, const Vector3& direction, double dmin);

struct ClosestDirection {
    Vector3 direction;        ///< of the closest points' difference: any length, either sign; zero where they coincide
    double distance_squared;  ///< computed: neither bound is proven; of slivers and nearly parallel edges that of their boundaries

    /// Is this separation nearly all that there is? If not, another direction may separate more.
    bool is_attained_by(double separation) const { return separation * separation >= 0.8 * distance_squared; }
};

/// Where the direction is normal to an edge or a face it is computed as such: the difference itself is off by u times the size of the pair,
/// which tilts it by much more than u when the distance is small.
ClosestDirection closest_direction(geometry::PairType type, const Differences& r);

/// All directions that could separate: for slivers and nearly parallel edges, where the closest points are unreliable. Normals are
/// perpendicular to what they are normal to up to rounding, however nearly parallel that is: a gap of 1e-12 of the size can be proven.
struct CandidateDirections {
    std::array<Vector3, 18> direction;
    int count = 0;
};
CandidateDirections candidate_directions(geometry::PairType type, const Differences& r);

}  // namespace fettle::core::ccd
