// SPDX-License-Identifier: MIT
#include "core/clearance/pair_details.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::clearance {
namespace {

// The same points at the same instant, seen from elements that share them.
bool is_same(const Witness& x, const Witness& y, double timestep) {
    const double size = x.point_a.cwiseAbs().maxCoeff() + x.point_b.cwiseAbs().maxCoeff();
    const double apart = (x.point_a - y.point_a).norm() + (x.point_b - y.point_b).norm();
    return std::abs(x.time - y.time) <= 1e-9 * timestep && apart <= 1e-9 * (x.distance + y.distance) + 1e-13 * size;
}

}  // namespace

double time_of(const PairMotion& pair, int segment, double s) {
    const PairSegment& at = pair.segments[segment];
    return stepper::time_at(pair.trajectory, at.step, at.segment, s);
}

Witness witness_of(const PairMotion& pair, const Encounter& encounter) {
    const PairSegment& segment = pair.segments[encounter.segment];
    Witness w = witness_between(pair.a, pair.b, encounter.element_a, encounter.element_b, encounter.pair);
    w.step = segment.step;
    w.segment = segment.segment;
    w.s = encounter.s;
    w.time = time_of(pair, encounter.segment, encounter.s);
    const Vector3 origin = kinematics::pose_at(segment.b->path, encounter.s).position;
    w.point_a += origin;
    w.point_b += origin;
    return w;
}

std::vector<Witness> all_witnesses(const PairMotion& pair, const Encounter& first, double tolerance, int most,
                                   const SearchOptions& search) {
    std::vector<Witness> witnesses{witness_of(pair, first)};
    if (!(tolerance > 0)) return witnesses;
    // More than are wanted, as many are the same or not the nearest.
    auto found =
        encounters_within(pair.a, pair.b, pair.segments, first.pair.distance + tolerance, 64 * static_cast<std::size_t>(most), search);
    const auto nearer = [](const Encounter& x, const Encounter& y) { return x.pair.distance < y.pair.distance; };
    std::stable_sort(found.begin(), found.end(), nearer);
    for (const Encounter& encounter : found) {
        if (count_of(witnesses) >= most) break;
        const Witness w = witness_of(pair, encounter);
        const auto same = [&](const Witness& other) { return is_same(w, other, pair.trajectory.timestep); };
        if (std::none_of(witnesses.begin(), witnesses.end(), same)) witnesses.push_back(w);
    }
    return witnesses;
}

std::vector<MarginInterval> margin_curve(const PairMotion& pair, const SearchResult& whole, const SearchOptions& search) {
    std::vector<MarginInterval> margin;
    SearchOptions options = search;
    options.exact_witness = false;
    for (int i = 0; i < count_of(pair.segments); ++i) {
        const PairSegment& segment = pair.segments[i];
        // A first search to a thousandth of the distance, then finer where that is not enough.
        options.tolerance = std::max(search.tolerance, 1e-3 * whole.upper);
        const SearchResult found = search_pair(pair.a, pair.b, {segment}, options);
        MarginInterval interval{segment.step, segment.segment, time_of(pair, i, 0), time_of(pair, i, 1), std::max(found.lower, whole.lower),
                                found.upper};
        if (i == whole.nearest.segment) interval.upper = std::min(interval.upper, whole.upper);
        interval.upper = std::max(interval.upper, interval.lower);
        margin.push_back(interval);
        options.seed = found.nearest;  // the same elements a moment later
        options.seed->segment = 0;
        options.seed->s = 0;
        if (i + 1 < count_of(pair.segments)) {
            const Encounter& last = found.nearest;
            options.seed->pair = placed_distance(instant_at(pair.segments[i + 1], 0), pair.a.elements[last.element_a].corners,
                                                 pair.b.elements[last.element_b].corners);
        }
    }
    return margin;
}

}  // namespace fettle::core::clearance
