// SPDX-License-Identifier: MIT
/// A mechanism moved by hand: its joints put somewhere, and how far bodies are apart there.
///
///     const auto posing = Posing::of(model);
///     if (!posing) return 3;                                            // no joints, or they close loops
///     const Posed posed = posing->at({{"hinge", 0.5}});                 // [rad]
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/clearance/joint_ranges.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::design::session {

/// A coordinate that can be moved by itself.
struct JointHandle {
    std::string name;  ///< of the joint; of one with several coordinates with which it is
    bool is_angle = false;
    double start = 0, low = 0, high = 0;  ///< [rad or m]
    bool has_limits = true;               ///< false: the ends are where a whole turn ends, or the mechanism's size away
    std::vector<std::string> moves{};     ///< bodies
};

struct Posed {
    std::vector<core::kinematics::Pose> poses;          ///< of all bodies
    std::vector<core::clearance::PairClearance> pairs;  ///< those that can meet, the nearest first; bounds are of this pose
};

class Posing {
public:
    /// Errors: clearance::joint_ranges says which joints it takes.
    static Result<Posing> of(std::shared_ptr<const core::model::Model> model);

    const std::vector<JointHandle>& handles() const { return handles_; }
    /// Those left out are where they start. Errors: no such joint; a value that is no number, or outside its ends.
    /// @param depths  How deep clashes are, too, which takes a fraction of a second each; false: PairClearance::overlap is not filled in.
    Result<Posed> at(const std::map<std::string, double>& joints, bool depths = true) const;

private:
    Posing(std::shared_ptr<const core::model::Model> model, core::clearance::JointRanges ranges);

    std::shared_ptr<const core::model::Model> model_;
    core::clearance::JointRanges ranges_;
    std::vector<std::pair<int, int>> pairs_;
    std::vector<JointHandle> handles_;
};

}  // namespace fettle::design::session
