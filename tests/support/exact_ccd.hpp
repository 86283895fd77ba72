// SPDX-License-Identifier: MIT
/// Exact truth of linear continuous collision detection, degenerate input included, sharing nothing with core/contact.
///
/// The pair touches at time t if the point lies in the triangle, or the edges meet. Where the normal n(t) of the triangle (of both edges)
/// does not vanish that is one polynomial equation (coplanarity) and polynomial inequalities in t; where it does, a vertex lies on an edge
/// or on a vertex: again polynomial equations and inequalities. exact_system.hpp decides them in whole numbers: coordinates are scaled by a
/// power of two to whole numbers, of 128 bits where those suffice (10 us a query on a small grid).
#pragma once

#include "core/ccd/linear_ccd.hpp"

namespace fettle::tests {

/// Do the primitives touch at some t in [0, 1]? Any finite doubles; exact.
bool exact_linear_contact(core::geometry::PairType type, const core::geometry::PairVertices& t0, const core::geometry::PairVertices& t1);

/// The same without the filter: slow, for the test of the other.
bool exact_linear_contact_by_algebra(core::geometry::PairType type, const core::geometry::PairVertices& t0,
                                     const core::geometry::PairVertices& t1);

/// Is the distance at time t at most `distance` (both exact doubles)? Exact: squared distances are compared as rationals.
bool exact_distance_at_most(core::geometry::PairType type, const core::geometry::PairVertices& t0, const core::geometry::PairVertices& t1,
                            double t, double distance);

}  // namespace fettle::tests
