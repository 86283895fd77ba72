// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/clearance.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/clearance/certificate_builder.hpp"
#include "fettle/core/clearance/pair_details.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::clearance {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

kinematics::PathSegment held(const kinematics::Pose& pose) {
    kinematics::PathSegment path;
    path.base = pose.rotation;
    path.position_t0 = pose.position;
    return path;
}

// One place of the path: step -1 is the start pose, held.
struct SegmentPlace {
    int step = -1, segment = 0;
};

std::vector<SegmentPlace> segment_places(const stepper::Trajectory& trajectory, bool motion) {
    if (!motion || trajectory.steps.empty()) return {{}};
    std::vector<SegmentPlace> places;
    for (int t = 0; t < static_cast<int>(trajectory.steps.size()); ++t)
        for (int k = 0; k < stepper::segment_count(trajectory, t); ++k) places.push_back({t, k});
    return places;
}

// What all pairs of a body share.
struct BodyMotion {
    std::shared_ptr<const PieceTree> tree;  // that of its first copy, if it is one of several; none: the body is not asked for
    std::vector<BodySegment> segments;
};

std::vector<BodySegment> body_segments(const stepper::Trajectory& trajectory, const std::vector<SegmentPlace>& places, int body) {
    std::vector<BodySegment> segments;
    for (const SegmentPlace& place : places)
        segments.push_back(body_segment(place.step < 0 ? held(trajectory.poses.front()[body])
                                                       : stepper::path_segment(trajectory, place.step, place.segment, body)));
    return segments;
}

std::vector<BodyMotion> body_motions(const model::Model& model, const stepper::Trajectory& trajectory,
                                     const std::vector<SegmentPlace>& places, const std::vector<int>& bodies) {
    std::vector<BodyMotion> motions(model.bodies.size());
    geometry::ShapeIndex shapes;
    std::vector<std::size_t> first;  // of each of `bodies`: the first of them that is a copy of the same part
    for (const int body : bodies) first.push_back(shapes.add(model.bodies[body].mesh));
    parallel_for(static_cast<int>(bodies.size()), 1, [&](int i) {
        const model::Body& body = model.bodies[bodies[i]];
        BodyMotion& motion = motions[bodies[i]];
        motion.segments = body_segments(trajectory, places, bodies[i]);
        if (first[i] == static_cast<std::size_t>(i))
            motion.tree = std::make_shared<const PieceTree>(make_piece_tree(body.mesh, *body.hierarchy));
    });
    for (std::size_t i = 0; i < bodies.size(); ++i) motions[bodies[i]].tree = motions[bodies[first[i]]].tree;
    return motions;
}

PairMotion pair_motion(const BodyMotion& a, const BodyMotion& b, const stepper::Trajectory& trajectory,
                       const std::vector<SegmentPlace>& places) {
    PairMotion pair{*a.tree, *b.tree, trajectory, {}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        pair.segments.push_back(pair_segment(a.segments[i], b.segments[i], a.tree->radius(), b.tree->radius()));
        pair.segments.back().step = places[i].step;
        pair.segments.back().segment = places[i].segment;
    }
    return pair;
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

// A certificate's checker rounds in its own way and bounds curves in its own way: the claim leaves it this much room; half of it after
// thinning.
double checking_room(const ClearanceOptions& options, const PairMotion& pair) {
    double slack = 0;
    for (const PairSegment& segment : pair.segments) slack = std::max(slack, segment.slack);
    return options.tolerance / 8 + 8 * slack;
}

// The least at the nodes of the path, as a tool that samples would see it; a good upper bound for a search over the motion, too.
Encounter least_at_nodes(const PairMotion& pair, SearchOptions search) {
    search.sample_nodes = pair.segments.size() > 1;  // the motion is searched as well, which costs little more
    search.nodes_only = !search.sample_nodes;
    if (search.nodes_only) search.tolerance *= 0.01;
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    return search.nodes_only ? found.nearest : found.sampled;
}

// Of one pair, in the making.
struct PairRecord {
    certificate::PairCertificate& certificate;
    const certificate::CertifiedBody &a, &b;
};

SearchResult certified_search(const PairMotion& pair, const ClearanceOptions& options, SearchOptions search,
                              const std::optional<PairRecord>& record) {
    search.enough = options.enough;
    if (!record) {
        search.sample_nodes = options.sample_nodes && pair.segments.size() > 1;
        return search_pair(pair.a, pair.b, pair.segments, search);
    }
    search.tolerance *= 0.75;
    search.proof = &record->certificate.segments;
    SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    const double room = checking_room(options, pair);
    found.lower = std::max(0.0, found.lower - room);
    complete_certificate(pair, found, record->certificate);
    thin_certificate(pair, record->a, record->b, 0.5 * room, record->certificate);
    return found;
}

PairClearance certify_pair(const PairMotion& pair, const PairRequest& request, double dhat, const ClearanceOptions& options,
                           const std::optional<PairRecord>& record) {
    SearchOptions search;
    search.tolerance = options.tolerance;
    search.max_evaluations = options.max_evaluations;
    search.should_stop = options.should_stop;
    const bool apart = options.sample_nodes && (record || pair.segments.size() == 1);
    if (apart) search.seed = least_at_nodes(pair, search);
    const SearchResult found = certified_search(pair, options, search, record);
    PairClearance result;
    result.a = request.a;
    result.b = request.b;
    result.minimum = request.minimum;
    result.lower = found.lower;
    result.upper = found.upper;
    result.sampled = !options.sample_nodes ? infinity : (apart ? *search.seed : found.sampled).pair.distance;
    result.complete = found.complete;
    result.intersecting = found.intersecting;
    search.seed.reset();
    if (!result.intersecting && found.lower == 0 && found.upper <= options.tolerance)
        result.intersecting = intersects_at_nodes(pair, search);
    result.witnesses = all_witnesses(pair, found.nearest, options.witness_tolerance, options.max_witnesses, search);
    result.witness = result.witnesses.front();
    result.status = judge(result, dhat);
    if (options.margin_curve) result.margin = margin_curve(pair, found, search);
    return result;
}

std::vector<int> bodies_of(const std::vector<PairRequest>& pairs, int count) {
    std::vector<int> bodies;
    for (const PairRequest& pair : pairs) {
        FETTLE_ASSERT(pair.a >= 0 && pair.a < count && pair.b >= 0 && pair.b < count && pair.a != pair.b,
                      "a pair of two bodies of the model");
        bodies.push_back(pair.a);
        bodies.push_back(pair.b);
    }
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    return bodies;
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
    const std::vector<int> bodies = bodies_of(pairs, static_cast<int>(model.bodies.size()));
    const std::vector<SegmentPlace> places = segment_places(trajectory, options.motion);
    const std::vector<BodyMotion> motions = body_motions(model, trajectory, places, bodies);
    std::vector<certificate::CertifiedBody> certified;
    if (options.certificate != nullptr) {
        std::vector<const PieceTree*> trees;
        for (const BodyMotion& motion : motions) trees.push_back(motion.tree.get());
        *options.certificate = start_certificate(model, trees, options.motion && !trajectory.steps.empty(), pairs.size());
        certified = certified_bodies(*options.certificate, model);
    }
    std::vector<PairClearance> results(pairs.size());
    std::mutex report;
    int done = 0;
    // Each pair is a search of its own: the number of threads cannot change a result.
    parallel_for(count, 1, [&](int i) {
        const PairRequest& request = pairs[i];
        std::optional<PairRecord> record;
        if (options.certificate != nullptr) {
            record.emplace(PairRecord{options.certificate->pairs[i], certified[request.a], certified[request.b]});
            record->certificate.a = request.a;
            record->certificate.b = request.b;
        }
        results[i] =
            certify_pair(pair_motion(motions[request.a], motions[request.b], trajectory, places), request, model.dhat, options, record);
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
