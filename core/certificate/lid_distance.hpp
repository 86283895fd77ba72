// SPDX-License-Identifier: MIT
/// Do the lids of an open mesh (solids/closure.hpp) stay away from another body over a path? Proven for pieces of both (boxes of their
/// hierarchies, triangles and their halves) by separating directions, the way between their centres or a lid's normal, in interval
/// arithmetic: over a span of time of half length e about its middle m, with any n,
///   |x_a(s) - x_b(s)| >= (|n.(c_a(m) - c_b(m))| - h_a - h_b) / |n| - e (|q_a' - q_b'| + |w_a| |X_a| + |w_b| |X_b|),
/// c the pieces' centres in the world, h how far they reach from them along n, q the bodies' reference points, w_a, w_b their turns over
/// the segment (rotation vectors), |X_a|, |X_b| how far the pieces' points are from them at most. What is loosest is halved, time or a
/// piece. That is slow where they come near each other, and is given up after a while: then it is not known.
#pragma once

#include <vector>

#include "core/certificate/interval_motion.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/mesh.hpp"
#include "core/stepper/trajectory.hpp"

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

/// A surface of a body, in its frame.
struct LidSurface {
    const geometry::Mesh& mesh;
    const geometry::BodyHierarchy& hierarchy;
};

/// True: proven that the lids stay farther apart than `room` [m] from all of the others at all places. False also where there is no place.
bool lids_stay_apart(const LidPath& path, const LidSurface& lids, const std::vector<const LidSurface*>& others, double room);

}  // namespace fettle::core::certificate
