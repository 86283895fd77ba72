// SPDX-License-Identifier: MIT
/// How far along their paths all bodies may go together without any pair coming too close.
#pragma once

#include <vector>

#include "core/ccd/candidates.hpp"
#include "core/ccd/curved_ccd.hpp"

namespace fettle::core::ccd {

struct SafeStep {
    double fraction = 1;                   ///< proven: every pair stays farther apart than dmin on [0, fraction]
    int limiting_a = -1, limiting_b = -1;  ///< bodies of the pair that limits it; -1: nothing does
};

/// Longest safe fraction of the segments; 0 where a pair's path is not finite. A pair may lose at most nine tenths of its distance (or come
/// to a quarter of dhat, whichever is less), so that the barrier stays finite and the next step has room. Contract: the candidates cover
/// the segments (candidates.hpp).
/// @param start  distances of bodies where the segments start, sorted by (a, b), or null: bodies whose known distance is more than they can
///               lose need no closer look
SafeStep longest_safe_step(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments,
                           const std::vector<BodyDistance>* start = nullptr);

/// Is the whole of each segment free of pairs at or below dmin? Contract: as above.
bool is_path_clear(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments);

}  // namespace fettle::core::ccd
