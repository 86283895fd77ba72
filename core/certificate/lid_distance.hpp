// SPDX-License-Identifier: MIT
/// Do the lids of an open mesh (geometry/closure.hpp) stay away from another body over a path? Proven by balls round pieces of both, or by
/// the plane of a lid's triangle, in interval arithmetic: over a span of time of half length e about its middle m,
///   |x_a(s) - x_b(s)| >= |c_a(m) - c_b(m)| - r_a - r_b - e (v_a + v_b),          v = |q'| + |w| |X|,
///   |x_a(s) - x_b(s)| >= |n.(c_a(m) - c_b(m))| - h_a - h_b - e (v_a + v_b),      |n| = 1,
/// c and r the balls' centres and radii, h how far the pieces reach from their centres along n. What is loosest is halved, time or a piece.
/// That is slow where they come near each other, and is given up after a while: then it is not known.
#pragma once

#include <vector>

#include "fettle/core/certificate/interval_motion.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"
#include "fettle/core/geometry/mesh.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::certificate {

/// A segment of a path; step -1 is the start pose, held.
struct Place {
    int step = -1, segment = 0;
};

struct LidPath {
    const stepper::Trajectory& trajectory;
    const std::vector<Place>& places;
    int body = 0, other = 0;  ///< whose lids they are, and what they are to stay away from
};

/// Triangles of a body, in its frame.
struct LidBody {
    Matrix3X vertices;
    std::vector<geometry::Triangle> triangles;
};

/// What lids are to stay away from: a mesh, and its own lids if it has some.
struct LidNeighbour {
    const geometry::Mesh& mesh;
    const geometry::BodyHierarchy& hierarchy;
    const LidBody& lids;
};

/// True: proven that they stay farther apart than `room` [m] at all places. False also where there is no place.
bool lids_stay_apart(const LidPath& path, const LidBody& lids, const LidNeighbour& other, double room);

}  // namespace fettle::core::certificate
