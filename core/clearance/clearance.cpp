// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/clearance/certificate_builder.hpp"
#include "fettle/core/clearance/pair_certification.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::clearance {
namespace {

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

// Of steps [first, last).
std::vector<SegmentPlace> segment_places(const stepper::Trajectory& trajectory, int first, int last) {
    std::vector<SegmentPlace> places;
    for (int t = first; t < last; ++t)
        for (int k = 0; k < stepper::segment_count(trajectory, t); ++k) places.push_back({t, k});
    return places;
}

std::vector<SegmentPlace> segment_places(const stepper::Trajectory& trajectory, bool motion) {
    if (!motion || trajectory.steps.empty()) return {{}};
    return segment_places(trajectory, 0, static_cast<int>(trajectory.steps.size()));
}

// What all pairs of a body share.
struct BodyMotion {
    // Those of its first copy, if it is one of several; none: the body is not asked for.
    std::shared_ptr<const PieceTree> tree;
    std::shared_ptr<const certificate::SolidMesh> solid;
    std::vector<BodySegment> segments;  // none: its path cannot be measured
};

std::vector<BodySegment> body_segments(const stepper::Trajectory& trajectory, const std::vector<SegmentPlace>& places, int body) {
    std::vector<BodySegment> segments;
    segments.reserve(places.size());
    for (const SegmentPlace& place : places)
        segments.push_back(body_segment(place.step < 0 ? held(trajectory.poses.front()[body])
                                                       : stepper::path_segment(trajectory, place.step, place.segment, body)));
    return segments;
}

// Finite, and small enough that no product of a few of them overflows: as the checker's limit (certificate/interval_motion.hpp).
bool has_usable_numbers(const model::Body& body, const stepper::Trajectory& trajectory, const std::vector<SegmentPlace>& places,
                        int index) {
    const auto usable = [](const auto& x) { return x.size() == 0 || (x.allFinite() && x.cwiseAbs().maxCoeff() < 1e30); };
    if (!usable(body.mesh.vertices)) return false;
    return std::all_of(places.begin(), places.end(), [&](const SegmentPlace& place) {
        const kinematics::Pose& pose = trajectory.poses[static_cast<std::size_t>(std::max(place.step, 0))][index];
        if (!usable(pose.rotation) || !usable(pose.position)) return false;
        if (place.step < 0) return true;
        const auto& nodes = trajectory.steps[place.step].nodes;
        const auto good = [&](int k) { return usable(nodes[k][index].position) && usable(nodes[k][index].rotation_vector); };
        return good(place.segment) && good(place.segment + 1);
    });
}

std::vector<BodyMotion> body_motions(const model::Model& model, const stepper::Trajectory& trajectory,
                                     const std::vector<SegmentPlace>& places, const std::vector<int>& bodies) {
    std::vector<BodyMotion> motions(model.bodies.size());
    geometry::ShapeIndex shapes;
    std::vector<std::size_t> first;  // of each of `bodies`: the first of them that is a copy of the same part
    first.reserve(bodies.size());
    for (const int body : bodies) first.push_back(shapes.add(model.bodies[body].mesh));
    parallel_for(static_cast<int>(bodies.size()), 1, [&](int i) {
        const model::Body& body = model.bodies[bodies[i]];
        BodyMotion& motion = motions[bodies[i]];
        if (has_usable_numbers(body, trajectory, places, bodies[i])) motion.segments = body_segments(trajectory, places, bodies[i]);
        if (first[i] != static_cast<std::size_t>(i)) return;
        motion.tree = std::make_shared<const PieceTree>(make_piece_tree(body.mesh, *body.hierarchy));
        motion.solid = std::make_shared<const certificate::SolidMesh>(certificate::solid_mesh(body.mesh));
    });
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        motions[bodies[i]].tree = motions[bodies[first[i]]].tree;
        motions[bodies[i]].solid = motions[bodies[first[i]]].solid;
    }
    return motions;
}

PairMotion pair_motion(const BodyMotion& a, const BodyMotion& b, const stepper::Trajectory& trajectory,
                       const std::vector<SegmentPlace>& places) {
    PairMotion pair{*a.tree, *b.tree, trajectory, {}, *a.solid, *b.solid};
    for (std::size_t i = 0; i < places.size(); ++i) {
        pair.segments.push_back(pair_segment(a.segments[i], b.segments[i], a.tree->radius(), b.tree->radius()));
        pair.segments.back().step = places[i].step;
        pair.segments.back().segment = places[i].segment;
    }
    return pair;
}

// Of one window: where it is nearest, and whether that is its very beginning or end.
struct WindowMinimum {
    std::optional<Witness> witness;
    bool at_start = false, at_end = false;
};

WindowMinimum window_minimum(PairMotion pair, std::size_t begin, std::size_t end, const SearchOptions& search) {
    const auto at = [&](std::size_t i) { return pair.segments.begin() + static_cast<std::ptrdiff_t>(i); };
    pair.segments = std::vector<PairSegment>(at(begin), at(end));
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    if (!(found.upper <= search.enough)) return {};
    const auto count = static_cast<int>(pair.segments.size());
    return {witness_of(pair, found.nearest), found.nearest.segment == 0 && found.nearest.s == 0,
            found.nearest.segment == count - 1 && found.nearest.s == 1};
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

// Of what could not be measured there is nothing to certify.
void drop_unbounded(certificate::Certificate& certificate) {
    const auto unbounded = [](const certificate::PairCertificate& pair) { return !std::isfinite(pair.upper) || pair.point_a.index < 0; };
    certificate.pairs.erase(std::remove_if(certificate.pairs.begin(), certificate.pairs.end(), unbounded), certificate.pairs.end());
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
        trees.reserve(motions.size());
        for (const BodyMotion& motion : motions) trees.push_back(motion.tree.get());
        *options.certificate = start_certificate(model, trajectory, trees, options.motion && !trajectory.steps.empty(), pairs.size());
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
        const BodyMotion &a = motions[request.a], &b = motions[request.b];
        results[i] = a.segments.empty() || b.segments.empty()
                         ? unmeasured(request, "the numbers of its path are not finite, or larger than 1e30")
                         : certify_pair(pair_motion(a, b, trajectory, places), request, model.dmin + model.dhat, options, record);
        if (!options.on_pair) return;
        const std::lock_guard<std::mutex> lock(report);
        options.on_pair(++done, count);
    });
    if (options.certificate != nullptr) drop_unbounded(*options.certificate);
    return results;
}

std::vector<Witness> nearest_by_window(const model::Model& model, const stepper::Trajectory& trajectory, const PairRequest& pair,
                                       const TimeWindows& windows, double reach, double tolerance) {
    const int steps = windows.last - windows.first;
    FETTLE_ASSERT(windows.first >= 0 && steps > 0 && windows.last <= static_cast<int>(trajectory.steps.size()),
                  "windows of the trajectory");
    const std::vector<SegmentPlace> places = segment_places(trajectory, windows.first, windows.last);
    const std::vector<BodyMotion> motions = body_motions(model, trajectory, places, {pair.a, pair.b});
    const BodyMotion &a = motions[pair.a], &b = motions[pair.b];
    if (a.segments.empty() || b.segments.empty()) return {};
    const PairMotion whole = pair_motion(a, b, trajectory, places);
    SearchOptions search;
    search.tolerance = tolerance;
    search.enough = reach;
    const int count = std::clamp(windows.count, 1, steps);
    std::vector<WindowMinimum> minima(static_cast<std::size_t>(count));
    const auto begin_of = [&](int w) {
        const int step = windows.first + static_cast<int>(static_cast<long>(w) * steps / count);
        const auto before = [](const SegmentPlace& place, int t) { return place.step < t; };
        return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), step, before) - places.begin());
    };
    parallel_for(count, 1, [&](int w) { minima[w] = window_minimum(whole, begin_of(w), begin_of(w + 1), search); });
    std::vector<Witness> witnesses;
    for (int w = 0; w < count; ++w) {
        const WindowMinimum& here = minima[w];
        if (!here.witness) continue;
        const auto is_nearer = [&](int other) {
            return other >= 0 && other < count && minima[other].witness && minima[other].witness->distance <= here.witness->distance;
        };
        if ((here.at_start && is_nearer(w - 1)) || (here.at_end && is_nearer(w + 1))) continue;
        witnesses.push_back(*here.witness);
    }
    return witnesses;
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
