// SPDX-License-Identifier: MIT
/// Exact truth of linear continuous collision detection in rational arithmetic, degenerate input included: slow, and sharing nothing with
/// core/contact.
///
/// The pair touches at time t if the point lies in the triangle, or the edges meet. For pairs that are not degenerate at t this is one
/// polynomial equation (coplanarity) and polynomial inequalities in t; degenerate pairs and boundaries add vertex on edge and vertex on
/// vertex. Such a system has a solution in [0, 1] exactly if it holds at 0, at 1, at a root of the equations, or, where these vanish
/// identically, at a root of one of the inequalities. Signs at algebraic numbers are decided by Sturm sequences and greatest common
/// divisors.
#pragma once

#include "fettle/core/contact/linear_ccd.hpp"

namespace fettle::tests {

/// Do the primitives touch at some t in [0, 1]? Any finite doubles; exact.
bool exact_linear_contact(core::contact::PairType type, const core::contact::PairVertices& t0, const core::contact::PairVertices& t1);

/// Is the distance at time t at most `distance` (both exact doubles)? Exact: squared distances are compared as rationals.
bool exact_distance_at_most(core::contact::PairType type, const core::contact::PairVertices& t0, const core::contact::PairVertices& t1,
                            double t, double distance);

}  // namespace fettle::tests
