// SPDX-License-Identifier: MIT
/// Branches of closed linkages: the ways in which the same bodies meet the same joints. A branch is said at a joint between two bodies of
/// the loop, by the joints at their other ends (scene/mechanism.hpp, Assemble); a motion passes from one branch to another only where the
/// linkage is at a dead centre, which is where `side_of` is 0. docs/method/joints.md#branches.
#pragma once

#include <optional>
#include <vector>

#include "core/linear/free_dofs.hpp"
#include "core/measure/measure.hpp"

namespace fettle::core::constraint {

/// Three joints, `from`, the middle one, `to`; the middle one joins the first body to the second.
struct Branch {
    enum class Slide { none, from, middle, to };  ///< which of the three is prismatic: 1/-1 are ahead and behind; none: left and right

    int from = -1, joint = -1, to = -1;  ///< the three joints, by their places; for messages
    double sign = 1;                     ///< of side_of where the linkage is to be
    Slide slide = Slide::none;
    int start = 0, first = 0;                  ///< frames on the first body, of `from` and of the middle joint
    int second = 0, end = 0;                   ///< frames on the second body, of the middle joint and of `to`
    std::vector<int> with_first, with_second;  ///< bodies that go with the first and with the second when it is turned, itself included
};

/// The side of the branch's two legs, in [-1, 1]; greater than 0 on the left, or ahead.
///   no slide:  the sine of the bend, n . (l1 x l2) / (|l1| |l2|), n the middle joint's axis, l1 = first - start and l2 = end - second
///   across n a slide:   v . s / |v|, s its axis; v = first - start (`to` slides), end - second (`from` slides) or end - start (the middle
///   one slides)
/// NaN where a leg has no length.
double side_of(const Branch& branch, const std::vector<measure::PlacedFrame>& frames);

/// Turns the branch's bodies over to its side: to the mirror image where the loop is closed and on the other side. Places that may not
/// change stay, so that joints may be left open: a start for assemble (assembly.hpp).
/// @param dofs  what may be moved.
/// @param bend  the angle to go to, in (0, pi): of the bend, or of the leg against the slide's axis, in (0, pi/2); none: the mirror image,
///              but not nearer than `least_bend` to where the sides meet.
void turn_over(const Branch& branch, const std::vector<measure::Frame>& frames, const linear::FreeDofs& dofs, std::optional<double> bend,
               std::vector<kinematics::Pose>& poses);

inline constexpr double least_bend = 0.2;  ///< [rad]

}  // namespace fettle::core::constraint
