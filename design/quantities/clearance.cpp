// SPDX-License-Identifier: MIT
#include "design/quantities/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adjoint/clearance/clearance_adjoint.hpp"
#include "adjoint/clearance/local_witnesses.hpp"
#include "adjoint/clearance/range_adjoint.hpp"
#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::quantities {

using core::clearance::PairClearance;
using description::Branch;
using description::Measurement;
using description::Simulated;

namespace {

core::stepper::Trajectory part_of(const core::stepper::Trajectory& whole, int first, int last) {
    core::stepper::Trajectory part;
    part.time_start = whole.time_start + first * whole.timestep;
    part.timestep = whole.timestep;
    part.body_names = whole.body_names;
    part.poses.assign(whole.poses.begin() + first, whole.poses.begin() + last + 1);
    part.steps.assign(whole.steps.begin() + first, whole.steps.begin() + last);
    return part;
}

constexpr double share_of_step = 1e-6;  // by which times may miss a step's end, rounded as they are

core::clearance::FacesOfBody faces_of(const core::model::Model& model, int body, const std::vector<std::string>& names) {
    core::clearance::FacesOfBody faces{body, {}};
    for (const std::string& name : names) {
        const std::vector<int> more = core::geometry::triangles_of_face(model.bodies[body].mesh, name);
        faces.triangles.insert(faces.triangles.end(), more.begin(), more.end());
    }
    std::sort(faces.triangles.begin(), faces.triangles.end());
    faces.triangles.erase(std::unique(faces.triangles.begin(), faces.triangles.end()), faces.triangles.end());
    return faces;
}

core::clearance::FacesAlone faces_alone(const core::model::Model& model, const ClearanceRange& range) {
    return {model, faces_of(model, range.a, range.faces_a), faces_of(model, range.b, range.faces_b)};
}

Errors check_faces(const core::model::Model& model, int body, const std::vector<std::string>& names) {
    Errors errors;
    const core::model::Body& of = model.bodies[body];
    const std::vector<std::string> known = core::geometry::names_of_faces(of.mesh);
    for (const std::string& name : names) {
        if (!core::geometry::triangles_of_face(of.mesh, name).empty()) continue;
        const std::string what = "`" + of.name + "` has no face \"" + name + "\"";
        errors.push_back({ErrorCode::unknown_key, "",
                          known.empty() ? what + ": its mesh names none; faces have the names of a part's file"
                                        : what + "; " + core::files::did_you_mean(name, {known.begin(), known.end()})});
    }
    return errors;
}

// Surfaces apart, solids not.
bool one_lies_inside(const PairClearance& pair) { return pair.solids == core::certificate::Solids::overlap && !pair.intersecting; }

}  // namespace

std::pair<int, int> window_steps(int steps, int window, int windows) {
    const auto edge = [&](int w) { return static_cast<int>(static_cast<long>(w) * steps / windows); };
    return {edge(window), std::max(edge(window + 1), edge(window) + 1)};
}

std::pair<int, int> steps_of(const ClearanceRange& range, double timestep, int steps) {
    const double end = static_cast<double>(steps);
    const auto place = [&](double time) { return std::clamp(time / timestep, 0.0, end); };
    const int first = range.from ? std::min(static_cast<int>(std::floor(place(*range.from) + share_of_step)), steps - 1) : 0;
    const int last = range.to ? static_cast<int>(std::ceil(place(*range.to) - share_of_step)) : steps;
    const auto [from, to] = window_steps(std::max(last - first, 1), range.window, range.windows);
    return {first + from, first + to};
}

PairClearance Clearance::certify_ranges(const core::model::Model& model, const core::clearance::ClearanceOptions& options) const {
    const auto ranges = core::clearance::joint_ranges(model);
    if (!ranges) {  // of the scene as written there were some: check()
        PairClearance none;
        none.a = range_.a;
        none.b = range_.b;
        none.is_bounded = false;
        none.upper = std::numeric_limits<double>::infinity();
        none.reason = ranges.errors().front().where + ": " + ranges.errors().front().message;
        return none;
    }
    return adjoint::clearance::settled_witness(model, *ranges,
                                               core::clearance::certify(model, *ranges, {{range_.a, range_.b, minimum_}}, options).front());
}

PairClearance Clearance::certify(const Simulated& s) const {
    if (has_faces()) {
        const core::clearance::FacesAlone faces = faces_alone(s.model, range_);
        ClearanceRange whole = range_;
        whole.faces_a.clear();
        whole.faces_b.clear();
        Simulated alone{faces.model(), s.trajectory, s.clearance_tolerance};
        return faces.in_whole(Clearance(whole, minimum_).certify(alone));
    }
    core::clearance::ClearanceOptions options;
    options.tolerance = s.clearance_tolerance;
    options.sample_nodes = false;
    options.measure_overlap = false;
    options.motion = range_.motion;
    if (range_.ranges) return certify_ranges(s.model, options);
    const std::vector<core::clearance::PairRequest> request{{range_.a, range_.b, minimum_}};
    if (!range_.motion) return core::clearance::certify(s.model, s.trajectory, request, options).front();
    const auto steps = count_of(s.trajectory.steps);
    const auto [first, last] = steps_of(range_, s.trajectory.timestep, steps);
    if (first == 0 && last == steps) return core::clearance::certify(s.model, s.trajectory, request, options).front();
    PairClearance pair = core::clearance::certify(s.model, part_of(s.trajectory, first, last), request, options).front();
    if (pair.witness.step >= 0) pair.witness.step += first;
    return pair;
}

Measurement Clearance::value(const Simulated& s) const {
    const PairClearance pair = certify(s);
    const std::string names = "`" + s.model.bodies[range_.a].name + "` and `" + s.model.bodies[range_.b].name + "`";
    if (one_lies_inside(pair)) {
        const double inside = -pair.witness.distance;
        return {inside, inside, inside, false, pair, "material of one of " + names + " lies inside the other"};
    }
    Measurement measured{pair.upper, pair.lower, pair.upper, pair.is_bounded, pair, {}, {}};
    if (pair.intersecting) measured.fault = names + " pass through each other";
    if (pair.lower > 0 && !pair.intersecting && !core::certificate::are_apart(pair.solids))
        measured.fault = "of " + names + ": " + core::clearance::why_not_apart(pair.solids);
    return measured;
}

void Clearance::add_seeds(const Simulated& s, const Measurement& measured, double scale, description::Seeds& seeds) const {
    add_seeds_of(s, *measured.clearance, one_lies_inside(*measured.clearance) ? -scale : scale, seeds);
}

void Clearance::add_seeds_of(const Simulated& s, const PairClearance& pair, double scale, description::Seeds& seeds) const {
    std::string refusal;
    if (!range_.ranges) {
        refusal = adjoint::clearance::clearance_adjoint(s.model, s.trajectory, pair, scale, seeds.trajectory_bar, seeds.model_bar);
    } else if (const auto ranges = core::clearance::joint_ranges(s.model)) {
        refusal = adjoint::clearance::range_clearance_adjoint(s.model, *ranges, pair, scale, seeds.model_bar);
    } else {
        refusal = ranges.errors().front().message;
    }
    if (seeds.refusal.empty()) seeds.refusal = refusal;
}

// Those at most `room` farther apart than the witness is.
std::vector<PairClearance> Clearance::others(const Simulated& s, const PairClearance& pair, double room) const {
    const std::optional<core::clearance::FacesAlone> faces = has_faces() ? std::optional(faces_alone(s.model, range_)) : std::nullopt;
    const core::model::Model& model = faces ? faces->model() : s.model;
    const adjoint::clearance::LocalWitnessLimits limits{room, branch_parts, (range_.motion ? most_branches : most_branches_at_rest) - 1};
    std::vector<PairClearance> others;
    if (!range_.ranges) {
        std::optional<core::clearance::StepRange> steps;
        if (range_.motion) {
            const auto [first, last] = steps_of(range_, s.trajectory.timestep, count_of(s.trajectory.steps));
            steps = {first, last};
        }
        others = adjoint::clearance::local_witnesses(model, s.trajectory, steps, pair, limits);
    } else if (const auto ranges = core::clearance::joint_ranges(s.model)) {
        others = adjoint::clearance::local_witnesses(model, *ranges, pair, limits);
    }
    if (faces)
        for (PairClearance& other : others) other = faces->in_whole(other);
    return others;
}

std::vector<Branch> Clearance::branches(const Simulated& s, const Measurement& measured, double limit) const {
    std::vector<Branch> branches{{measured.value, [&](double scale, description::Seeds& seeds) { add_seeds(s, measured, scale, seeds); }}};
    const PairClearance& pair = *measured.clearance;
    if (pair.is_clash() || !(pair.witness.distance > 0) || !(limit >= measured.value)) return branches;
    for (const PairClearance& other : others(s, pair, limit - measured.value))
        branches.push_back({std::max(measured.value, other.upper),
                            [this, &s, other](double scale, description::Seeds& seeds) { add_seeds_of(s, other, scale, seeds); }});
    return branches;
}

Errors Clearance::check(const core::model::Model& model, int steps) const {
    Errors errors = description::check_body(model, range_.a);
    for (const Error& error : description::check_body(model, range_.b)) errors.push_back(error);
    const auto add = [&](ErrorCode code, const std::string& message) { errors.push_back({code, "", message}); };
    if (range_.a == range_.b) add(ErrorCode::inconsistent, "a clearance is between two bodies; both are the same");
    if (range_.motion && steps < 1) add(ErrorCode::out_of_range, "a clearance over the motion needs a step");
    if (range_.motion && range_.ranges)
        add(ErrorCode::inconsistent, "a clearance is over the motion, or over the ranges of the joints, whatever the motion; not both");
    if (range_.windows < 1 || range_.window < 0 || range_.window >= range_.windows)
        add(ErrorCode::out_of_range, "the windows of a motion are counted from 0, and are at least 1");
    if (!range_.motion && (range_.from || range_.to))
        add(ErrorCode::inconsistent, "`from` and `to` are a part of the motion: the clearance is to be over the motion");
    if (!errors.empty()) return errors;
    const double end = steps * model.timestep, room = share_of_step * model.timestep;
    for (const std::optional<double>& time : {range_.from, range_.to})
        if (time && !(*time >= 0 && *time <= end + room))
            add(ErrorCode::out_of_range, core::base::formatted("%.6g s is not within the motion, which ends at %.6g s", *time, end));
    if (range_.from && range_.to && !(*range_.from < *range_.to))
        add(ErrorCode::inconsistent, core::base::formatted("a part of the motion begins before it ends; this one is from %.6g s to %.6g s",
                                                           *range_.from, *range_.to));
    for (const Errors& faults : {check_faces(model, range_.a, range_.faces_a), check_faces(model, range_.b, range_.faces_b)})
        errors.insert(errors.end(), faults.begin(), faults.end());
    if (!range_.ranges) return errors;
    const auto ranges = core::clearance::joint_ranges(model);
    for (const Error& error : ranges.errors()) add(error.code, error.where + ": " + error.message);
    for (const std::string& lost : ranges ? ranges->lost : std::vector<std::string>())
        add(ErrorCode::out_of_range, lost + ": that is hardly a range. Correct their `limits`, or leave them out");
    return errors;
}

}  // namespace fettle::design::quantities
