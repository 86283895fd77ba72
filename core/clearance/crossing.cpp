// SPDX-License-Identifier: MIT
#include "core/clearance/crossing.hpp"

#include <algorithm>
#include <memory>

namespace fettle::core::clearance {
namespace {

constexpr long most_evaluations = 1'000'000;
constexpr int time_halvings = 30;  // of a segment

// From s0 to s1 of a segment, with its rounding: ends that round differently are covered by the slack.
PairSegment part_of(const PairSegment& whole, double s0, double s1) {
    const auto part = [&](const kinematics::PathSegment& path) {
        kinematics::PathSegment out = path;
        out.rotation_vector_t0 += s0 * path.rotation_vector_step;
        out.position_t0 += s0 * path.position_step;
        out.rotation_vector_step *= s1 - s0;
        out.position_step *= s1 - s0;
        return out;
    };
    PairSegment result = whole;
    result.a = std::make_shared<const BodySegment>(body_segment(part(whole.a->path)));
    result.b = std::make_shared<const BodySegment>(body_segment(part(whole.b->path)));
    return result;
}

// Parts of the path, searched for any distance at all.
class Halving {
public:
    Halving(const PairMotion& pair, const SearchOptions& search) : pair_(pair), search_(search) {
        for (const PairSegment& segment : pair.segments) slack_ = std::max(slack_, segment.slack);
        search_.enough = 4 * slack_;
        search_.tolerance = std::max(search.tolerance / 8, 64 * slack_);
        search_.max_evaluations = std::min(search.max_evaluations, most_evaluations);
        search_.sample_nodes = false;
        search_.seed.reset();
    }

    // Are they proven to be apart during all of this? Else `met` is where they are nearest.
    bool is_apart(const std::vector<PairSegment>& segments, Encounter& met) const {
        const SearchResult found = search_pair(pair_.a, pair_.b, segments, search_);
        if (found.lower > slack_) return true;
        met = found.nearest;
        return false;
    }

private:
    const PairMotion& pair_;
    SearchOptions search_;
    double slack_ = 0;
};

}  // namespace

CrossingResult find_crossing(const PairMotion& pair, const SearchOptions& search) {
    SearchOptions options = search;
    options.seek_intersection = true;
    options.seed.reset();
    options.max_evaluations = std::min(search.max_evaluations, most_evaluations);
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, options);
    if (found.intersecting) return {found.nearest, 0};
    return {std::nullopt, found.complete ? found.lower : 0};
}

FirstContact first_contact(const PairMotion& pair, const Encounter& known, const SearchOptions& search) {
    const Halving halving(pair, search);
    FirstContact first{time_of(pair, 0, 0), known};
    Encounter met;
    if (!halving.is_apart({part_of(pair.segments[0], 0, 0)}, met)) {
        first.encounter = met;
        first.encounter.segment = 0;
        first.encounter.s = 0;
        return first;
    }
    // Segments before `apart` are proven; at `known`'s, or in a later part of what is left, they are not.
    int apart = 0, open = known.segment + 1;
    while (open - apart > 1) {
        const int middle = (apart + open) / 2;
        if (halving.is_apart({pair.segments.begin() + apart, pair.segments.begin() + middle}, met)) {
            apart = middle;
        } else {
            first.encounter = met;
            first.encounter.segment += apart;
            open = middle;
        }
    }
    double s_apart = 0, s_open = 1;
    for (int i = 0; i < time_halvings; ++i) {
        const double middle = 0.5 * (s_apart + s_open);
        if (halving.is_apart({part_of(pair.segments[apart], s_apart, middle)}, met)) {
            s_apart = middle;
        } else {
            first.encounter = met;
            first.encounter.segment = apart;
            first.encounter.s = s_apart + met.s * (middle - s_apart);
            s_open = middle;
        }
    }
    first.not_before = time_of(pair, apart, s_apart);
    return first;
}

}  // namespace fettle::core::clearance
