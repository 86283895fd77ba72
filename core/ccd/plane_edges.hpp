// SPDX-License-Identifier: MIT
/// Edges within plane faces are marks of the triangulation. Collision detection leaves them out (of pairs of edges, not of faces): half of
/// all candidates of machine parts are theirs.
///
/// Why nothing is missed. Let two meshes be apart by D > 0, and let every pair of a vertex and a face, and every pair of edges that are not
/// plane, be K apart or more. Then D >= K - 2 (h_a + h_b), with h of geometry::FlatFeatures::plane_height. For let D be that of a point x
/// within a plane edge e of a and y within an edge f of b. Both triangles of e lie within h_a of a plane that they are tilted from by
/// little, one on each side of e; y is at most D + h_a above that plane. Follow f from y in the direction in which it does not rise. It
/// stays above the mesh, which it does not meet, and at most D + h_a above the plane, so at most D + 2 h_a above the triangle that is below
/// it. Where it leaves this triangle over another plane edge, the next one goes on beneath it. So either f ends above a triangle, whose
/// distance from that vertex is at most D + 2 h_a, or it passes over an edge of a that is not plane, D + 2 h_a away at most. If f is plane
/// itself, the same is said of that edge and the triangles of f, with 2 h_b. So where all others keep more than dmin + 2 (h_a + h_b), which
/// is dmin and the last digits, along a motion, all of the meshes keep more than dmin: D is continuous, and greater than 0 where the motion
/// starts.
#pragma once

#include "core/model/model.hpp"

namespace fettle::core::ccd {

/// What of the body is flat enough to be left out of contacts beside the activation distance; null: nothing.
const geometry::FlatFeatures* flat_features_of(const model::Model& model, const model::Body& body);

/// Whose plane edges are left out of candidates; null: none are. Such edges are in no contact (flat_features_of).
const geometry::FlatFeatures* plane_features_of(const model::Model& model, const model::Body& body);

/// 2 (h_a + h_b) of what is left out between these two [m]; 0: nothing is.
double lost_by_plane_edges(const model::Model& model, const model::Body& a, const model::Body& b);

}  // namespace fettle::core::ccd
