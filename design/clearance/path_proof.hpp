// SPDX-License-Identifier: MIT
/// The proof that a simulated path is free of contact: what `simulate` needs before it says "ok".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/clearance.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::design::clearance {

enum class ProofState {
    proven,         ///< every pair that may collide stays farther apart than dmin, and neither lies in the other
    surfaces,       ///< the surfaces of every such pair do; of some pair with a mesh that is not closed it is open whether one lies inside
    nothing,        ///< no two bodies may collide
    not_certified,  ///< of some pair that could not be proven
    stopped         ///< the proof was stopped before it was whole
};
const char* to_string(ProofState state);

struct PathProof {
    ProofState state = ProofState::nothing;
    std::optional<double> lower;  ///< proven least distance over the first `steps` steps [m]; nothing where there are no pairs or no steps
    std::string reason;           ///< of one that is not proven: the pair and its bounds; of surfaces alone: of which pairs
    int steps = 0;                ///< whose path is proven; all of them, unless the proof was stopped or some pair could not be proven
};

/// The least distance of all pairs that may collide, over the whole path: first to about 1% of what the ends of the steps saw; where that
/// gives the least distance badly once more, by the distance found; pairs that this leaves open a hundred times closer each time. The path
/// may be proven while it is simulated, stretch by stretch, each by the least distance that was known by then: so a run that is interrupted
/// is proven up to there, and little is left to do at the end. The answer is the same to the accuracy asked for; the same bits for the same
/// stretches.
class PathProver {
public:
    /// @param should_stop  asked often, on any thread
    /// @param stretch      so many steps are proven at a time; fewer would cost more in all
    PathProver(const core::model::Model& model, std::function<bool()> should_stop, int stretch = 512);
    ~PathProver();
    PathProver(const PathProver&) = delete;
    PathProver& operator=(const PathProver&) = delete;

    /// Proves the whole stretches among the steps that there are by now. Contract: the simulation goes on from what was shown before.
    void follow(const core::stepper::Simulation& so_far);
    /// Proves what is left.
    PathProof finish(const core::stepper::Simulation& simulation);
    /// That both have taken so far, wall clock.
    double seconds() const { return seconds_; }

private:
    struct Stretch;

    bool prove(const core::stepper::Simulation& simulation, Stretch& stretch, double reach);
    bool prove_steps(const core::stepper::Simulation& simulation, int last);
    double first_reach(const core::stepper::Simulation& simulation) const;
    double lower() const;
    PathProof stopped() const;
    PathProof proven(double lower, std::vector<core::clearance::PairRequest> unverified, int steps) const;
    std::vector<core::clearance::PairRequest> unverified() const;
    PathProof look_closer(const core::stepper::Simulation& simulation);
    PathProof finished(const core::stepper::Simulation& simulation);

    const core::model::Model& model_;
    std::function<bool()> should_stop_;
    int stretch_;
    bool any_pair_;
    std::vector<Stretch> stretches_;
    double known_;  // a distance that was found: the least is no more [m]
    double seconds_ = 0;
};

/// All at once.
PathProof prove_path(const core::model::Model& model, const core::stepper::Simulation& simulation,
                     const std::function<bool()>& should_stop);

}  // namespace fettle::design::clearance
