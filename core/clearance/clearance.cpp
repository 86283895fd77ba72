// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/clearance.hpp"

#include <algorithm>
#include <mutex>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/clearance/pair_search.hpp"
#include "fettle/core/contact/body_hierarchy.hpp"

namespace fettle::core::clearance {
namespace {

kinematics::PathSegment held(const kinematics::Pose& pose) {
    kinematics::PathSegment path;
    path.base = pose.rotation;
    path.position_t0 = pose.position;
    return path;
}

std::vector<PairSegment> pair_segments(const stepper::Trajectory& trajectory, const PairRequest& pair, double radius_a, double radius_b,
                                       bool motion) {
    std::vector<PairSegment> segments;
    if (!motion || trajectory.steps.empty()) {
        const auto& poses = trajectory.poses.front();
        segments.push_back(pair_segment(held(poses[pair.a]), held(poses[pair.b]), radius_a, radius_b));
        return segments;
    }
    for (int t = 0; t < static_cast<int>(trajectory.steps.size()); ++t) {
        for (int k = 0; k < stepper::segment_count(trajectory, t); ++k) {
            segments.push_back(pair_segment(stepper::path_segment(trajectory, t, k, pair.a),
                                            stepper::path_segment(trajectory, t, k, pair.b), radius_a, radius_b));
            segments.back().step = t;
            segments.back().segment = k;
        }
    }
    return segments;
}

double witness_time(const stepper::Trajectory& trajectory, const Witness& witness) {
    if (witness.step < 0) return trajectory.time_start;
    const int n = stepper::segment_count(trajectory, witness.step);
    return trajectory.time_start + trajectory.timestep * (witness.step + (witness.segment + witness.s) / n);
}

PairStatus judge(const PairClearance& pair, double dhat) {
    if (pair.intersecting) return PairStatus::violated;
    if (!(pair.minimum > 0)) {
        if (pair.upper < dhat) return PairStatus::contact;
        return pair.complete || pair.lower >= dhat ? PairStatus::clear : PairStatus::undecided;
    }
    if (pair.lower >= pair.minimum) return PairStatus::clear;
    return pair.upper < pair.minimum ? PairStatus::violated : PairStatus::undecided;
}

struct BodyPair {
    SearchBody a, b;
};

double time_of(const stepper::Trajectory& trajectory, const PairSegment& segment, double s) {
    Witness at;
    at.step = segment.step;
    at.segment = segment.segment;
    at.s = s;
    return witness_time(trajectory, at);
}

std::vector<MarginInterval> margin_curve(const stepper::Trajectory& trajectory, const BodyPair& bodies,
                                         const std::vector<PairSegment>& segments, const SearchResult& whole, SearchOptions options) {
    std::vector<MarginInterval> margin;
    const double tolerance = options.tolerance;
    for (const PairSegment& segment : segments) {
        SearchOptions coarse = options;
        coarse.tolerance = std::max(tolerance, 1e-3 * whole.upper);
        const SearchResult found = search_pair(bodies.a, bodies.b, {segment}, coarse);
        MarginInterval interval{segment.step,
                                segment.segment,
                                time_of(trajectory, segment, 0),
                                time_of(trajectory, segment, 1),
                                std::max(found.lower, whole.lower),
                                found.upper};
        if (segment.step == whole.witness.step && segment.segment == whole.witness.segment)
            interval.upper = std::min(interval.upper, whole.upper);
        margin.push_back(interval);
    }
    return margin;
}

// The nodes of the path, each held.
std::vector<PairSegment> node_instants(const std::vector<PairSegment>& segments, double radius_a, double radius_b) {
    std::vector<PairSegment> nodes;
    const auto add = [&](const PairSegment& segment, double s) {
        nodes.push_back(
            pair_segment(held(kinematics::pose_at(segment.a.path, s)), held(kinematics::pose_at(segment.b.path, s)), radius_a, radius_b));
    };
    for (const PairSegment& segment : segments) add(segment, 0);
    add(segments.back(), 1);
    return nodes;
}

PairClearance certify_pair(const model::Model& model, const stepper::Trajectory& trajectory, const PairRequest& request,
                           const ClearanceOptions& options) {
    const auto bodies = static_cast<int>(model.bodies.size());
    FETTLE_ASSERT(request.a >= 0 && request.a < bodies && request.b >= 0 && request.b < bodies && request.a != request.b,
                  "a pair of two bodies of the model");
    const model::Body &a = model.bodies[request.a], &b = model.bodies[request.b];
    const double radius_a = a.hierarchy->nodes()[0].radius, radius_b = b.hierarchy->nodes()[0].radius;
    const auto segments = pair_segments(trajectory, request, radius_a, radius_b, options.motion);
    const BodyPair pair{{&a.mesh, a.hierarchy.get()}, {&b.mesh, b.hierarchy.get()}};
    const SearchOptions search{options.tolerance, options.max_evaluations, 1, options.should_stop};
    const SearchResult found = search_pair(pair.a, pair.b, segments, search);
    PairClearance result;
    result.a = request.a;
    result.b = request.b;
    result.minimum = request.minimum;
    result.lower = found.lower;
    result.upper = found.upper;
    result.witness = found.witness;
    result.witness.time = witness_time(trajectory, found.witness);
    result.complete = found.complete;
    result.intersecting = found.intersecting;
    result.status = judge(result, model.dhat);
    result.witnesses = {result.witness};
    result.sampled = search_pair(pair.a, pair.b, node_instants(segments, radius_a, radius_b), search).upper;
    if (options.margin_curve) result.margin = margin_curve(trajectory, pair, segments, found, search);
    return result;
}

}  // namespace

const char* to_string(PairStatus status) {
    switch (status) {
        case PairStatus::clear:
            return "clear";
        case PairStatus::violated:
            return "violated";
        case PairStatus::undecided:
            return "undecided";
        case PairStatus::contact:
            return "contact";
    }
    return "unknown";
}

std::vector<PairClearance> certify_clearance(const model::Model& model, const stepper::Trajectory& trajectory,
                                             const std::vector<PairRequest>& pairs, const ClearanceOptions& options) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    const auto count = static_cast<int>(pairs.size());
    std::vector<PairClearance> results(pairs.size());
    std::mutex report;
    int done = 0;
    // Each pair is a search of its own: the number of threads cannot change a result.
    parallel_for(count, 1, [&](int i) {
        results[i] = certify_pair(model, trajectory, pairs[i], options);
        if (!options.on_pair) return;
        const std::lock_guard<std::mutex> lock(report);
        options.on_pair(++done, count);
    });
    return results;
}

stepper::Trajectory as_assembled(const model::Model& model) {
    stepper::Trajectory trajectory;
    trajectory.timestep = model.timestep;
    trajectory.poses.emplace_back();
    for (const model::Body& body : model.bodies) {
        trajectory.body_names.push_back(body.name);
        trajectory.poses.front().push_back(body.pose_start);
    }
    return trajectory;
}

}  // namespace fettle::core::clearance
