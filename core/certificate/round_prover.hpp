// SPDX-License-Identifier: MIT
/// The checker's mathematics of leaves o (certificate.hpp), in interval arithmetic; part of RangeProver, nothing of it is the search's.
///
/// All screws between the two bodies turn about one axis z through p and slide along it, or turn about axes through one point p
/// (Revolution). Turns leave r(x) = |z x (x - p)|/|z|, or |x - p|, as it is, slides too; z(x) = z.(x - p)/|z| grows by what the screws
/// slide, sum slide_j |z| (u - start). The map x -> (r, z) takes no two points farther apart, so that for any m and all points of the two
/// bodies
///   |m| dist >= m_r (r_b - r_a) + m_z (z_b - z_a).
/// r is convex. Where its largest value over a triangle counts, a corner attains it; where its least does,
///   r(x) >= g.(z x (x - p))/(|g||z|), or g.(x - p)/|g|,   g any vector,
/// which is linear; g is chosen in doubles, so that this is large, and what holds does not depend on how well.
#pragma once

#include <map>
#include <optional>

#include "core/certificate/certified_body.hpp"
#include "core/certificate/linkage.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::certificate {

class RoundProver {
public:
    /// Contract: as RangeProver's.
    RoundProver(const Linkage& linkage, const LinkedPair& pair, const kinematics::Pose& start_a, const kinematics::Pose& start_b);

    /// Is m_r (r_b - r_a) + m_z (z_b - z_a) >= lower |m| proven of the two regions, for the part of the ranges? Their points are corners of
    /// triangles, three each.
    bool prove(const Region& a, const Region& b, const CoordinateBox& part, const Vector3& m, double lower);

private:
    struct Corner {
        Interval low, r, z;  // a lower bound of r over the triangle, linear between its corners
    };
    struct Side {
        kinematics::Pose start;
        std::map<const Vector3*, std::array<Corner, 3>> triangles;  // by their first corner
    };

    const std::array<Corner, 3>& profile(Side& side, const Vector3* triangle) const;
    Interval3 across_of(const Interval3& x) const;
    double least(Side& side, const Region& region, double m_r, double m_z) const;
    Interval slide(const CoordinateBox& part) const;

    std::optional<Revolution> about_;
    std::vector<Screw> slides_;   // of b, and backwards of a
    std::vector<double> starts_;  // of their coordinates
    Side a_, b_;
};

}  // namespace fettle::core::certificate
