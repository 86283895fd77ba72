// SPDX-License-Identifier: MIT
/// The checker's mathematics of ranges of joints, in interval arithmetic; used by certificate_checker.cpp alone, nothing of it by the
/// search.
///
/// A leaf: box of half widths w about c, vectors n_i at its 2^n corners, n(u) their linear interpolant in each coordinate,
/// d = x_a - x_b, g(u) = n(u).d(u). The interpolant of g's own values at the corners is off by at most the sum over the coordinates k of
///   e_k = 1/2 w_k^2 max |d2g/du_k2|
/// (one coordinate after the other: interpolating in one loses at most that, and never magnifies what is lost in another), wherever the
/// mixed derivatives are. So, with L the longest n_i,
///   min over the corners of n_i.d  -  sum e_k  >=  lower L   proves   dist >= g/|n| >= lower.
/// As d2n/du_k2 = 0, |d2g| <= 2 |dn/du_k||dd/du_k| + |n.d2d|, and |dn/du_k| is at most the largest difference of two corners' vectors along
/// k over 2 w_k. For a point, with the screws j of coordinate k and r_j its distance from the screw's axis as the screws after it have put
/// it,
///   |dx| <= sum |turn_j| r_j + |slide_j|,
///   |n.d2x| <= sum turn_j^2 r_j |n x z_j(u)|  +  2 sum over i before j of L |turn_i| (|turn_j| r_j + |slide_j|),
/// z_j(u), the axis as the screws before it have turned it, is off z_j by at most 2 |z_i x z_j| for each of those; of parallel axes, by
/// nothing. r_j is at most that at c, and what the screws after j move the point from there:
///   sum over i > j of min(|turn_i| w, 2) r_i + |slide_i| w.
#pragma once

#include <map>
#include <span>
#include <utility>

#include "core/certificate/certified_body.hpp"
#include "core/certificate/linkage.hpp"
#include "core/certificate/round_prover.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::certificate {

/// Two bodies that move by screws, over the ranges of their coordinates. Its functions are those of PathProver (interval_motion.hpp).
class RangeProver {
public:
    /// Contract: at most most_coordinates; `pair` is of the linkage, which is checked.
    RangeProver(const Linkage& linkage, const LinkedPair& pair, const kinematics::Pose& start_a, const kinematics::Pose& start_b);

    int coordinates() const { return count_; }
    const CoordinateBox& box() const { return box_; }
    long prove(const Region& a, const Region& b, const CoordinateBox& part, std::span<const Vector3> normals, double lower, int halvings);
    /// The same by one vector of a leaf o. @return 1, or 0
    long prove_round(const Region& a, const Region& b, const CoordinateBox& part, const Vector3& m, double lower);
    Interval distance_at(const Interval3& X_a, const Interval3& X_b, const Coordinates& at);
    double witness_room(const Interval3& X_a, const Interval3& X_b) const;

private:
    struct Placement {
        IntervalMatrix rotation;
        Interval3 place;
    };
    struct Side {
        std::vector<Screw> screws;
        std::vector<double> starts;  // of the screws' coordinates
        std::vector<double> tilt;    // 2 sum over the screws before that turn of |z_i x z_j|
        kinematics::Pose start;
        std::map<std::pair<std::size_t, double>, Placement> moves;  // of a screw at a value
    };
    struct Losses {
        Coordinates along{};  // e_k
        double total = 0;
    };

    static Side side_of(const Linkage& linkage, const LinkedPair& pair, const std::vector<Screw>& screws, const kinematics::Pose& start);
    static const Placement& move(Side& side, std::size_t screw, double value);
    static Placement after(Side& side, std::size_t first, const Coordinates& at);
    static std::vector<double> radii(Side& side, const Region& region, const CoordinateBox& box);
    void add_losses(Side& side, const Region& region, const CoordinateBox& box, std::span<const Vector3> normals, Losses& losses) const;
    bool is_above(const Region& a, const Region& b, const CoordinateBox& box, std::span<const Vector3> normals, double wanted);
    bool is_usable(const Region& a, const Region& b) const;
    Losses losses(const Region& a, const Region& b, const CoordinateBox& box, std::span<const Vector3> normals);

    Side a_, b_;
    int count_ = 0;  // of coordinates
    CoordinateBox box_;
    double magnitude_ = 0;  // upper bound of all numbers, as BodyPath::magnitude
    RoundProver round_;
};

}  // namespace fettle::core::certificate
