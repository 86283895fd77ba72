// SPDX-License-Identifier: MIT
/// Did a loose edge pass through a loose edge, or a loose point through a triangle? Such things intersect at single instants only, so that
/// looking at instants cannot tell. The path is halved until a plane separates the pair by more than the curve can leave its chord; where
/// none does down to the resolution, exact linear continuous collision detection (exact_ccd.hpp) on the last chord decides.
#pragma once

#include <functional>

#include "core/ccd/linear_ccd.hpp"

namespace fettle::tests::support {

/// World positions of a pair's vertices at s in [0, 1] of some segment of a path.
using MovingVertices = std::function<core::geometry::PairVertices(double s)>;

/// A time at which the pair touches, within `resolution` of s0 .. s1; negative if it does not.
/// @param curvature  how far chords fall short: over an interval ds the vertices of the one leave their chords, together with those of the
///                   other, by at most curvature ds^2 (|dtheta|^2 |X| / 8 each, docs/method/collision.md#curved-paths)
double find_passage(core::geometry::PairType type, const MovingVertices& vertices, double s0, double s1, double curvature,
                    double resolution = 1e-3);

/// Proof by a plane that the primitives stay more than `margin` apart while their vertices move straight from t0 to t1. False: not proven.
bool is_separated_by_plane(core::geometry::PairType type, const core::geometry::PairVertices& t0, const core::geometry::PairVertices& t1,
                           double margin = 0);

}  // namespace fettle::tests::support
