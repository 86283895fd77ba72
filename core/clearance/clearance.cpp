// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/clearance/body_motions.hpp"
#include "fettle/core/clearance/certificate_builder.hpp"
#include "fettle/core/clearance/near_windows.hpp"
#include "fettle/core/clearance/pair_certification.hpp"

namespace fettle::core::clearance {
namespace {

constexpr const char* unusable_numbers = "the numbers of its path are not finite, or larger than 1e30";

// What all pairs of a body share.
struct BodyMotion {
    BodyShape shape;
    std::vector<BodySegment> segments;  // none: its path cannot be measured
};

std::vector<BodyMotion> body_motions(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                                     const std::vector<int>& bodies) {
    std::vector<BodyMotion> motions(model.bodies.size());
    const std::vector<BodyShape> shapes = body_shapes(model, bodies);
    parallel_for(static_cast<int>(bodies.size()), 1, [&](int i) {
        const int body = bodies[i];
        motions[body].shape = shapes[body];
        if (!has_usable_numbers(model.bodies[body], trajectory, places, body)) return;
        motions[body].segments.reserve(places.size());
        for (const PathPlace& place : places) motions[body].segments.push_back(body_segment(segment_at(trajectory, place, body)));
    });
    return motions;
}

PairMotion pair_motion(const BodyMotion& a, const BodyMotion& b, const stepper::Trajectory& trajectory,
                       const std::vector<PathPlace>& places) {
    PairMotion pair{*a.shape.tree, *b.shape.tree, trajectory, {}, *a.shape.solid, *b.shape.solid};
    for (std::size_t i = 0; i < places.size(); ++i) {
        pair.segments.push_back(pair_segment(a.segments[i], b.segments[i], pair.a.radius(), pair.b.radius()));
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
    const std::vector<PathPlace> places = path_places(trajectory, options.motion);
    const std::vector<BodyMotion> motions = body_motions(model, trajectory, places, bodies);
    std::vector<certificate::CertifiedBody> certified;
    if (options.certificate != nullptr) {
        std::vector<const PieceTree*> trees;
        trees.reserve(motions.size());
        for (const BodyMotion& motion : motions) trees.push_back(motion.shape.tree.get());
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
                         ? unmeasured(request, unusable_numbers)
                         : certify_pair(pair_motion(a, b, trajectory, places), request, model.dmin + model.dhat, options, record);
        if (!options.on_pair) return;
        const std::lock_guard<std::mutex> lock(report);
        options.on_pair(++done, count);
    });
    if (options.certificate != nullptr) drop_unbounded(*options.certificate);
    return results;
}

namespace {

PairMotion window_motion(const std::vector<BodyShape>& shapes, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         const NearWindow& window) {
    const BodyShape &a = shapes[window.a], &b = shapes[window.b];
    PairMotion pair{*a.tree, *b.tree, trajectory, {}, *a.solid, *b.solid};
    pair.segments.reserve(static_cast<std::size_t>(window.last - window.first));
    for (int i = window.first; i < window.last; ++i) {
        const PathPlace& place = places[static_cast<std::size_t>(i)];
        pair.segments.push_back(pair_segment(segment_at(trajectory, place, window.a), segment_at(trajectory, place, window.b),
                                             pair.a.radius(), pair.b.radius()));
        pair.segments.back().step = place.step;
        pair.segments.back().segment = place.segment;
    }
    return pair;
}

}  // namespace

NearClearances certify_near(const model::Model& model, const stepper::Trajectory& trajectory, double reach, ClearanceOptions options) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    FETTLE_ASSERT(options.certificate == nullptr, "a certificate speaks of whole paths");
    const std::vector<PathPlace> places = path_places(trajectory, options.motion);
    const NearWindows near = near_windows(model, trajectory, places, reach);
    std::vector<PairRequest> pairs;
    for (const NearWindow& window : near.windows) pairs.push_back({window.a, window.b, 0});
    const std::vector<BodyShape> shapes = body_shapes(model, bodies_of(pairs, static_cast<int>(model.bodies.size())));
    options.enough = std::min(options.enough, reach);
    NearClearances result;
    result.everything = near.everything;
    result.windows.resize(near.windows.size());
    parallel_for(static_cast<int>(near.windows.size()), 1, [&](int i) {
        const NearWindow& window = near.windows[i];
        result.windows[i] = window.measurable ? certify_pair(window_motion(shapes, trajectory, places, window), pairs[i],
                                                             model.dmin + model.dhat, options, std::nullopt)
                                              : unmeasured(pairs[i], unusable_numbers);
    });
    return result;
}

std::vector<Witness> nearest_by_window(const model::Model& model, const stepper::Trajectory& trajectory, const PairRequest& pair,
                                       const TimeWindows& windows, double reach, double tolerance) {
    const int steps = windows.last - windows.first;
    FETTLE_ASSERT(windows.first >= 0 && steps > 0 && windows.last <= static_cast<int>(trajectory.steps.size()),
                  "windows of the trajectory");
    const std::vector<PathPlace> places = path_places(trajectory, windows.first, windows.last);
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
        const auto before = [](const PathPlace& place, int t) { return place.step < t; };
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
