// SPDX-License-Identifier: MIT
/// Pairs that stay so far apart that nobody needs their least distance (PairRequest::far): proven by boxes round whole bodies that hold
/// them for a while (near_windows.hpp), and where these do not suffice by a search that ends as soon as it is known either way. The cost is
/// in proportion to the pairs that come near, not to all pairs.
#pragma once

#include <optional>
#include <vector>

#include "core/clearance/body_motions.hpp"
#include "core/clearance/pair_clearance.hpp"

namespace fettle::core::clearance {

/// For each request: its answer, if the bodies are proven to stay `far` apart and neither lies inside the other; nothing where they are
/// not, where that is not known (unusable numbers, budget, stop), and where `far` is infinite. `lower` is then at least `far`.
/// @param shapes  of all bodies of the requests.
std::vector<std::optional<PairClearance>> far_pairs(const model::Model& model, const stepper::Trajectory& trajectory,
                                                    const std::vector<PathPlace>& places, const std::vector<PairRequest>& pairs,
                                                    const std::vector<BodyShape>& shapes, const ClearanceOptions& options);

/// The answer about a pair of which nothing but `lower` >= far is known. Status: clear.
PairClearance far_pair(const PairRequest& request, double lower, Solids solids);

}  // namespace fettle::core::clearance
