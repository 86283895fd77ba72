// SPDX-License-Identifier: MIT
/// The proof that a simulated path is free of contact: what `simulate` needs before it says "ok".
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fettle/core/stepper/simulation.hpp"

namespace fettle::design::cli {

enum class ProofState {
    proven,         ///< every pair that may collide stays farther apart than dmin
    nothing,        ///< no two bodies may collide
    not_certified,  ///< of some pair that could not be proven
    stopped         ///< the proof was stopped before it was whole
};
const char* to_string(ProofState state);

struct PathProof {
    ProofState state = ProofState::nothing;
    std::optional<double> lower;  ///< proven least distance over the path [m]; nothing without pairs, or if stopped
    std::string reason;           ///< of one that is not proven: the pair and its bounds
};

/// Of all pairs that may collide, over the whole path: first to about 1% of what the ends of the steps saw; pairs that this leaves open are
/// looked at again, a hundred times closer each time.
PathProof prove_path(const core::model::Model& model, const core::stepper::Simulation& simulation,
                     const std::function<bool()>& should_stop);

}  // namespace fettle::design::cli
