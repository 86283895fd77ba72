// SPDX-License-Identifier: MIT
/// A plane figure: what is extruded and revolved. Loops with the material to their left: outlines counter-clockwise, holes clockwise, none
/// crossing another. May have several outlines, and outlines within holes. Curves are kept as they are: arcs stay arcs.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/parts/path.hpp"

namespace fettle::core::parts {

struct Profile {
    std::vector<Loop> loops;
};

/// What the loop encloses, whichever way it runs. Errors: faults_of.
Result<Profile> filled(const Loop& loop);
/// With a hole, which must lie in the material and leave a wall everywhere. What is to cut into the rim is a difference instead.
/// Errors: "hole `axle` breaks through `rim`: wall -0.2 mm at 37 deg".
Result<Profile> with_hole(const Profile& profile, const Loop& hole);
Result<Profile> with_holes(const Profile& profile, const std::vector<Loop>& holes);
/// Several figures that do not touch. Errors: two that do.
Result<Profile> together(const std::vector<Profile>& profiles);

/// Every fault, in the designer's words: a loop that crosses itself or another, without area, without points; where. Empty: none.
/// Curves are looked at through polygons of 1/1000 of their size, so what is nearer than that may be taken for touching.
Errors faults_of(const Profile& profile);

Loop moved(const Loop& loop, const Point2& by);
Loop turned(const Loop& loop, const Number& angle, const Point2& about = {});
/// In the line through `point` in `along`'s direction. Runs the other way round.
Loop mirrored(const Loop& loop, const Point2& point, const Point2& along);
Profile moved(const Profile& profile, const Point2& by);
Profile turned(const Profile& profile, const Number& angle, const Point2& about = {});
/// By the fraction k / n of a turn; n of them are symmetric.
Profile turned(const Profile& profile, int k, int n, const Point2& about);
Profile mirrored(const Profile& profile, const Point2& point, const Point2& along);

/// Copies 0 .. count-1, the k-th turned by k * step about a point (step: a full turn / count if not given), moved by k * step. Features of
/// copies are called "slot 1", "slot 2", ...
std::vector<Loop> polar_copies(const Loop& loop, int count, const Point2& about = {});
std::vector<Loop> polar_copies(const Loop& loop, int count, const Number& step, const Point2& about);
std::vector<Loop> linear_copies(const Loop& loop, int count, const Point2& step);

/// Area of the true figure [m^2]; of curves of a law by Gauss quadrature, to 1e-9.
Number area(const Profile& profile);

}  // namespace fettle::core::parts
