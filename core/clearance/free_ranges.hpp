// SPDX-License-Identifier: MIT
/// From where to where a joint is proven free: each coordinate of a linkage by itself, from its start on either way, until two bodies come
/// closer than a minimum, or nothing is left to look at. Limits of the coordinate itself have no effect: this is how they are found.
///
/// For a coordinate q that starts at q0, and one way along it, the search keeps `free`, up to which every pair is proven at least the
/// minimum apart (certify over the interval), and `stop`, where a pair was found closer; it asks about the half between them until
/// they are as near as is wanted. Everything from q0 to `free` is proven, nothing is said of what lies beyond `stop`, where it may be free
/// again. docs/method/clearance.md#free-ranges.
///
///     const auto ranges = core::clearance::joint_ranges(model, model.diagonal);  // joints without limits, too
///     if (!ranges) return 3;
///     const std::vector<std::pair<int, int>> pairs{{0, 1}, {0, 2}};
///     for (const auto& range : core::clearance::free_ranges(model, *ranges, {0}, pairs, model.diagonal, {.minimum = 0.3e-3}))
///         std::printf("%s: free from %g to %g\n", ranges->linkage.coordinates[range.coordinate].joints.front().joint.c_str(),
///                     range.below.free, range.above.free);
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/joint_ranges.hpp"
#include "core/clearance/pair_clearance.hpp"

namespace fettle::core::clearance {

struct FreeRangeOptions {
    double minimum = 0;               ///< clearance that is kept [m]; 0: the surfaces do not meet
    double joined_minimum = 0;        ///< the same for bodies that a joint joins, which are always near each other; at most `minimum`
    double angle = 1.7e-4;            ///< how near the end of a turn is found [rad]
    double length = 1e-5;             ///< the same of a slide [m]
    bool above = true, below = true;  ///< which ways are looked along; the other end is then the start
    bool others_anywhere = false;     ///< the other coordinates anywhere within their limits; false: where they start
    std::function<bool()> should_stop = {};                                       ///< optional
    std::function<void(const std::string& joint, double free)> on_progress = {};  ///< optional; called after each question
};

/// What one way along a coordinate ends at.
struct RangeEnd {
    enum class Kind {
        open,       ///< nothing was met: the search ended at a turn, or at its reach
        blocked,    ///< the pair is closer than the minimum at `at`
        undecided,  ///< it could not be proven beyond `free`, nor was a place found where the pair is closer
    };
    Kind kind = Kind::open;
    double free = 0;                      ///< proven up to here, in the coordinate [rad or m]
    double at = 0;                        ///< of `blocked`
    std::optional<PairClearance> pair{};  ///< of `blocked`: over that position alone; of `undecided`: with the reason
};

/// A pair that the search had to leave out, because no interval from the start on can be free of it.
struct NotSearched {
    int a = 0, b = 0;
    std::string undecided{};  ///< why it is not known whether the two are apart as assembled; empty: they are closer than the minimum
    bool is_joined = false;   ///< by a joint, which may explain it; else the two meet as assembled, and the coordinate is free nowhere
};

struct FreeRange {
    int coordinate = 0;  ///< of the linkage
    double start = 0;    ///< [rad or m]
    RangeEnd below, above;
    bool turns_freely = false;                    ///< a whole turn is free; below is then the start
    std::vector<std::pair<int, int>> touching{};  ///< meet at the start alone, which the range then leaves out by the accuracy of its ends
    std::vector<NotSearched> not_searched{};
    /// Are both ends known, of all pairs that no joint joins?
    bool is_decided() const;
    /// A pair that no joint joins is closer than the minimum as assembled; null: none is.
    const NotSearched* clash_at_start() const;
};

/// The pairs that matter by default: all, but those of one group and those that the scene ignores; the lesser body first.
std::vector<std::pair<int, int>> searched_pairs(const model::Model& model);

/// The coordinate that a joint moves by itself or by gears; a cylindrical joint's is its slide. Errors (out_of_range, at no place): no
/// joint that moves is called so, with the nearest that is.
base::Result<int> coordinate_of(const JointRanges& ranges, const std::string& joint);

/// The linkage in which `coordinate` alone moves; a swing goes in every direction.
JointRanges alone(JointRanges ranges, int coordinate);

/// The ranges of some coordinates of `ranges`, in their order.
/// @param ranges  The model's (joint_ranges): starts and screws are taken from it, and with others_anywhere the limits.
/// @param pairs   Bodies to look at; those that a coordinate does not move against each other are left out. Joined pairs may be among them:
///                one that is closer than the minimum as assembled is told (FreeRange::not_searched).
/// @param reach   How far a slide is looked at, either way [m].
std::vector<FreeRange> free_ranges(const model::Model& model, const JointRanges& ranges, const std::vector<int>& coordinates,
                                   const std::vector<std::pair<int, int>>& pairs, double reach, const FreeRangeOptions& options = {});

}  // namespace fettle::core::clearance
