// SPDX-License-Identifier: MIT
#include "core/clearance/domain.hpp"

#include <utility>

#include "core/clearance/clearance.hpp"
#include "core/clearance/looped_bodies.hpp"

namespace fettle::core::clearance {

Domain as_started(const model::Model& model) { return Domain(as_assembled(model)); }

base::Result<Domain> over_joints(const model::Model& model) {
    base::Result<JointRanges> ranges = joint_ranges(model);
    if (ranges) return Domain(as_assembled(model), *std::move(ranges));
    if (!closes_loops(model)) return ranges.errors();
    base::Result<LoopedRanges> looped = looped_ranges(model);
    if (!looped) return looped.errors();
    certificate::Toleranced bodies = looped_bodies(model, *looped);
    return Domain(as_assembled(model), std::move(looped->ranges), std::move(bodies));
}

std::vector<PairClearance> certify(const model::Model& model, const Domain& over, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options) {
    if (over.made() != nullptr) return certify(model, *over.made(), pairs, options);
    if (over.ranges() != nullptr) return certify(model, *over.ranges(), pairs, options);
    if (over.joints() != nullptr) return certify(model, over.path(), *over.joints(), pairs, options);
    return certify(model, over.path(), pairs, options);
}

ProvenClearances certify_with_proof(const model::Model& model, const Domain& over, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options) {
    if (over.made() != nullptr) return certify_with_proof(model, *over.made(), pairs, options);
    if (over.ranges() != nullptr) return certify_with_proof(model, *over.ranges(), pairs, options);
    if (over.joints() != nullptr) return certify_with_proof(model, over.path(), *over.joints(), pairs, options);
    return certify_with_proof(model, over.path(), pairs, options);
}

kinematics::Pose pose_at_witness(const model::Model& model, const Domain& over, const PairClearance& pair, int body) {
    if (pair.as_assembled) return model.bodies[body].pose_start;
    if (over.made() != nullptr) return pose_at_witness(*over.made(), pair, body);
    if (over.ranges() != nullptr) return pose_at_witness(model, *over.ranges(), pair, body);
    const Witness& at = pair.witness;
    return stepper::pose_at(over.path(), at.step, at.segment, at.s, body);
}

}  // namespace fettle::core::clearance
