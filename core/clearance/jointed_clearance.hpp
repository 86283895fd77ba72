// SPDX-License-Identifier: MIT
/// Clearance of bodies that joints hold and motors drive, at all times and not only at the nodes of a path (stepper/jointed_motion.hpp):
/// bounds along the path as stored, charged with how far joints and motors would have the bodies from it between its nodes
/// (certificate/ideal_joints.hpp), which is proven.
///
///     const auto motion = core::stepper::follow_joints(model, -1, core::stepper::default_joint_gap(model));
///     if (!motion) return 3;
///     const std::vector<core::clearance::PairRequest> pairs{{.a = 0, .b = 1, .minimum = 0.3e-3}};
///     auto options = core::clearance::usual_options(pairs);
///     options.motion = true;
///     const auto path = core::clearance::jointed_path(model, *motion);
///     for (const auto& pair : core::clearance::certify(model, motion->trajectory, path, pairs, options))
///         std::printf("%s: from %g to %g m\n", core::clearance::to_string(pair.status), pair.lower, pair.upper);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/certificate/ideal_joints.hpp"
#include "core/clearance/clearance.hpp"
#include "core/stepper/jointed_motion.hpp"

namespace fettle::core::clearance {

/// The joints of everything that is not held: as data, without deviations. Errors: a body that joints move has prescribed coordinates
/// besides, or they do not determine it.
base::Result<certificate::IdealJoints> ideal_joints(const model::Model& model, const std::vector<std::string>& held);

/// Bodies that the joints have somewhere, which need not be where a path has them between its nodes: those of a row that are not held, and
/// that scripts do not move wholly. Increasing.
std::vector<int> jointed_bodies(const model::Model& model, const std::vector<std::string>& held);

struct JointedPath {
    std::optional<certificate::IdealJoints> joints;  ///< with deviations that are proven for the path; nothing where there are none
    std::string refusal;                             ///< why there are none; empty: there are
    std::vector<int> bodies;                         ///< jointed_bodies
};
JointedPath jointed_path(const model::Model& model, const stepper::JointedMotion& motion);

/// As certify over the path, of the bodies where the joints have them: of each pair lower less its charge, upper more; clear or violated
/// only where that is proven of these, too. Where it is not proven where the joints have a body, a pair of it has no bounds and is
/// undecided; other pairs do not depend on joints.
std::vector<PairClearance> certify(const model::Model& model, const stepper::Trajectory& trajectory, const JointedPath& path,
                                   const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

/// The same with its certificate: it has the path's own bounds, and the joints beside them; nothing of pairs without bounds.
ProvenClearances certify_with_proof(const model::Model& model, const stepper::Trajectory& trajectory, const JointedPath& path,
                                    const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

}  // namespace fettle::core::clearance
