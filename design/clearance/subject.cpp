// SPDX-License-Identifier: MIT
#include "design/clearance/subject.hpp"

#include <algorithm>
#include <utility>

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"

namespace fettle::design::clearance {

namespace {

std::vector<std::string> notes_of_ranges(const core::model::Model& model, const core::clearance::JointRanges& ranges) {
    using core::base::joined;
    std::vector<std::string> notes, turns, swings, motors;
    if (!ranges.held.empty()) notes.push_back("held at the start pose, as no joint connects them to the world: " + joined(ranges.held));
    notes.insert(notes.end(), ranges.narrowed.begin(), ranges.narrowed.end());
    for (int k = 0; k < count_of(ranges.linkage.coordinates); ++k) {
        const auto& coordinate = ranges.linkage.coordinates[k];
        const std::string& joint = coordinate.joints.front().joint;
        if (coordinate.is_whole_turn && !is_direction(ranges, k)) turns.push_back(joint);
        if (ranges.direction_of[k] >= 0 && !ranges.has_limits[k]) swings.push_back(joint);
    }
    if (!swings.empty()) notes.push_back("without a `swing`, so they swing to all sides wholly: " + joined(swings));
    if (!turns.empty()) notes.push_back("without limits, so they turn wholly: " + joined(turns));
    for (const auto& joint : model.mechanism.joints)
        if (joint.is_motor) motors.push_back(joint.name);
    if (!motors.empty()) notes.push_back("motors have no effect here, limits have: " + joined(motors));
    return notes;
}

}  // namespace

const char* const follow_note = "joints of closed loops follow from what drives them, whatever their own limits are";

const char* to_string(SubjectSource source) {
    switch (source) {
        case SubjectSource::as_assembled:
            return "as assembled";
        case SubjectSource::simulated:
            return "over the simulated motion";
        case SubjectSource::scripted:
            return "over the scripted motion, without dynamics";
        case SubjectSource::poses:
            return "over the poses read";
        case SubjectSource::trajectory:
            return "over the trajectory";
        case SubjectSource::ranges:
            return "over the ranges of the joints";
        case SubjectSource::prescribed:
            return "over the prescribed motion";
    }
    return "";
}

std::string source_text(const Subject& subject) {
    return std::string(to_string(subject.source)) + (subject.domain.has_deviations() ? ", within tolerances" : "");
}

Subject subject_of(core::model::Model model, std::optional<core::stepper::Trajectory> trajectory) {
    Subject subject;
    subject.source = trajectory ? SubjectSource::trajectory : SubjectSource::as_assembled;
    subject.domain = trajectory ? core::clearance::Domain(*std::move(trajectory)) : core::clearance::as_started(model);
    subject.model = std::move(model);
    return subject;
}

Subject subject_over(core::model::Model model, core::clearance::Domain tree) {
    Subject subject;
    subject.source = SubjectSource::ranges;
    subject.model = std::move(model);
    subject.domain = std::move(tree);
    subject.notes = notes_of_ranges(subject.model, *subject.domain.ranges());
    if (subject.domain.made() && !subject.domain.made()->loops.empty()) subject.notes.emplace_back(follow_note);
    return subject;
}

Result<Subject> subject_over_joints(core::model::Model model) {
    core::base::Result<core::clearance::Domain> tree = core::clearance::over_joints(model);
    if (!tree) return tree.errors();
    return subject_over(std::move(model), *std::move(tree));
}

std::vector<WorstDeviation> worst_deviations(const Subject& subject, const core::clearance::PairClearance& pair) {
    std::vector<WorstDeviation> out;
    for (size_t k = 0; k < pair.deviations.size(); ++k) {
        const core::certificate::Deviation& d = subject.domain.made()->deviations[pair.deviations[k]];
        out.push_back({d.of, pair.deviations_at[k], d.lower, d.upper, d.unit});
    }
    return out;
}

std::vector<std::string> deviations_without_influence(const Subject& subject, const core::clearance::PairClearance& pair) {
    std::vector<std::string> out;
    for (int k = 0; k < count_of(subject.domain.made()->deviations); ++k)
        if (!std::binary_search(pair.deviations.begin(), pair.deviations.end(), k)) out.push_back(subject.domain.made()->deviations[k].of);
    return out;
}

double joint_charge(const Subject& subject, int a, int b) {
    const core::clearance::JointedPath* path = subject.domain.joints();
    return path != nullptr && path->joints ? core::certificate::joint_charge(*path->joints, a, b) : 0;
}

bool may_push(const Subject& subject, int a, int b) {
    const bool dynamics = subject.source == SubjectSource::simulated || subject.source == SubjectSource::trajectory;
    return dynamics && subject.motion() && core::model::may_collide(subject.model, a, b);
}

core::kinematics::Pose pose_where_nearest(const Subject& subject, const core::clearance::PairClearance& pair, int body) {
    const core::kinematics::Pose pose = core::clearance::pose_at_witness(subject.model, subject.domain, pair, body);
    return {pose.rotation, core::kinematics::world_position(pose, -subject.model.bodies[body].reference_point)};
}

void for_joints(
    const core::clearance::JointRanges& ranges, const core::clearance::PairClearance& pair,
    const std::function<void(const core::certificate::JointCoordinate&, double, const core::certificate::LinkageCoordinate&)>& visit) {
    for (size_t k = 0; k < pair.coordinates.size(); ++k) {
        const core::certificate::LinkageCoordinate& c = ranges.linkage.coordinates[pair.coordinates[k]];
        for (const auto& joint : c.joints) visit(joint, joint.scale * pair.at[k] + joint.offset, c);
    }
}

}  // namespace fettle::design::clearance
