// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/pair_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/clearance/piece_bound.hpp"
#include "fettle/core/clearance/proof_recorder.hpp"

namespace fettle::core::clearance {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int max_halvings = 48;  // so that every parameter is a double exactly

// A dyadic part of a segment; parts are made when first needed and shared by all pieces.
struct Interval {
    int segment = 0;
    int start = 0, middle = 0, end = 0;  // indices of instants
    int first_half = -1, second_half = -1;
    int halvings = 0;
};

struct Entry {
    int interval = 0;
    int a = 0, b = 0;       // pieces
    int cell = -1;          // of the recorder
    bool measured = false;  // two elements whose closest points are known at the interval's ends: n0, n1 are their directions
    bool halve = false;     // in time, else in space
    Vector3 n0 = Vector3::Zero(), n1 = Vector3::Zero();
};

// What the heap moves about: the entries themselves stay where they are.
struct Key {
    double lower = 0;
    std::int64_t order = 0;  // of making: breaks ties the same way on every run
    int entry = 0;
};

struct Later {
    bool operator()(const Key& x, const Key& y) const { return x.lower != y.lower ? x.lower > y.lower : x.order > y.order; }
};

class PairSearch {
public:
    PairSearch(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options)
        : a_(a), b_(b), segments_(segments), options_(options), recorder_(options.proof != nullptr, segments.size()) {
        for (int i = 0; i < static_cast<int>(segments_.size()); ++i) add_interval(i);
        if (options_.nodes_only) {
            const int last = static_cast<int>(segments_.size()) - 1, end = add_instant(segments_[last], 1);
            push_interval({last, end, end, end, -1, -1, 0});
        }
    }

    SearchResult run() {
        result_.upper = infinity;
        if (options_.seed) {
            take_upper(*options_.seed);
        } else {
            take_distance_of_any_pair();
        }
        search();
        const double lower = std::min({aside_, queue_.empty() ? infinity : queue_.front().lower, result_.upper});
        result_.lower = std::max(lower, 0.0);
        if (!options_.nodes_only) refine_nearest();
        if (options_.proof != nullptr) recorder_.write(*options_.proof);
        return result_;
    }

    std::vector<Encounter> collect(double distance, std::size_t most) {
        within_ = distance;
        most_ = most;
        search();
        return std::move(found_);
    }

private:
    void search() {
        const int roots = static_cast<int>(intervals_.size());
        for (int i = 0; i < roots; ++i) try_pieces(i, 0, 0, recorder_.root(intervals_[i].segment));
        while (!queue_.empty() && !is_settled()) {
            result_.complete = result_.evaluations < options_.max_evaluations && !is_stopped();
            if (!result_.complete) break;
            std::pop_heap(queue_.begin(), queue_.end(), Later{});
            const int index = queue_.back().entry;
            const Entry entry = entries_[index];
            queue_.pop_back();
            free_.push_back(index);
            split(entry);
        }
    }

    // Also settled when an entry at the limit of rounding is the least: what is in the queue cannot raise the lower bound then.
    bool is_settled() const {
        const double next = queue_.front().lower;
        if (is_collecting()) return next > within_ || found_.size() >= most_;
        if (options_.seek_intersection) return result_.intersecting || next > 0;
        return aside_ <= next || std::max(next, 0.0) >= cutoff();
    }

    bool is_collecting() const { return within_ >= 0; }

    // Entries whose bound is no less need no splitting.
    double cutoff() const {
        if (is_collecting()) return std::nextafter(within_, infinity);
        if (options_.seek_intersection) return std::numeric_limits<double>::min();
        return std::min(result_.upper - options_.tolerance, options_.enough);
    }

    bool is_stopped() { return options_.should_stop && (++rounds_ & 255) == 1 && options_.should_stop(); }

    static bool is_still(const PairSegment& s) {
        return s.a.speed == 0 && s.b.speed == 0 && s.a.path.position_step == s.b.path.position_step;
    }

    void add_interval(int segment) {
        const int start = add_instant(segments_[segment], 0);
        if (options_.nodes_only || is_still(segments_[segment])) {
            push_interval({segment, start, start, start, -1, -1, 0});
            return;
        }
        const int middle = add_instant(segments_[segment], 0.5), end = add_instant(segments_[segment], 1);
        push_interval({segment, start, middle, end, -1, -1, 0});
    }

    void push_interval(const Interval& i) {
        intervals_.push_back(i);
        bounds_.emplace_back(segments_[i.segment], instants_[i.start], instants_[i.middle], instants_[i.end]);
    }

    int add_instant(const PairSegment& segment, double s) {
        instants_.push_back(instant_at(segment, s));
        return static_cast<int>(instants_.size()) - 1;
    }

    const PairSegment& segment_of(const Interval& interval) const { return segments_[interval.segment]; }
    const Piece& piece_a(int i) const { return a_.pieces[i]; }
    const Piece& piece_b(int i) const { return b_.pieces[i]; }
    const Corners& corners_a(int piece) const { return a_.elements[a_.pieces[piece].first].corners; }
    const Corners& corners_b(int piece) const { return b_.elements[b_.pieces[piece].first].corners; }
    double length(const Interval& interval) const { return instants_[interval.end].s - instants_[interval.start].s; }
    bool can_halve(const Interval& interval) const { return interval.start != interval.end && interval.halvings < max_halvings; }

    MovingPlane plane_of(const Interval& i, const Vector3& n0, const Vector3& n1) const {
        return moving_plane(instants_[i.start], instants_[i.middle], instants_[i.end], n0, n1);
    }

    // Queues the entry, or sets it aside if it cannot change the result. `plane` proves `lower`.
    void keep(const Entry& entry, double lower, const LeafPlane& plane, bool splittable) {
        recorder_.set_plane(entry.cell, plane);
        if (!splittable || lower >= cutoff()) {
            aside_ = std::min(aside_, lower);
            return;
        }
        int index = static_cast<int>(entries_.size());
        if (free_.empty()) {
            entries_.push_back(entry);
        } else {
            index = free_.back();
            free_.pop_back();
            entries_[index] = entry;
        }
        queue_.push_back({lower, made_++, index});
        std::push_heap(queue_.begin(), queue_.end(), Later{});
    }

    void try_pieces(int interval_index, int a, int b, int cell) {
        ++result_.evaluations;
        const Interval& interval = intervals_[interval_index];
        const IntervalBound& prepared = bounds_[interval_index];
        const Piece &piece_of_a = piece_a(a), &piece_of_b = piece_b(b);
        const Separation gap = separation(instants_[interval.middle], piece_of_a, piece_of_b);
        const LeafPlane plane{gap.direction, gap.direction};
        Entry entry;
        entry.interval = interval_index;
        entry.a = a;
        entry.b = b;
        entry.cell = cell;
        const double slack = segment_of(interval).slack, motion = prepared.motion(piece_of_a, piece_of_b);
        const double at_once = gap.apart - motion - slack;
        const bool elements = piece_of_a.is_element() && piece_of_b.is_element();
        if (at_once >= cutoff() || (interval.start == interval.end && !elements)) return keep(entry, at_once, plane, true);
        const SegmentBound bound = prepared.along(gap.direction, piece_of_a, piece_of_b, elements ? &corners_a(a) : nullptr,
                                                  elements ? &corners_b(b) : nullptr, options_.deviation_scale);
        if (!elements && can_halve(interval)) {
            const double size = piece_of_a.half_extent.norm() + piece_of_b.half_extent.norm();
            entry.halve = bound.at_ends - bound.lower > 0.5 * size || (gap.apart <= 0 && motion > size);
        }
        // With the exact values of their corners elements may do better than at once, boxes with an overlap worse.
        keep(entry, std::max(bound.lower, at_once), plane, true);
    }

    SegmentBound elements_bound(const Entry& entry, const Vector3& n0, const Vector3& n1) {
        ++result_.evaluations;
        const Interval& interval = intervals_[entry.interval];
        const PairSegment& segment = segment_of(interval);
        const Matrix3 &x = corners_a(entry.a).x, &y = corners_b(entry.b).x;
        const MovingPlane plane = plane_of(interval, n0, n1);
        return segment_bound(segment, length(interval), plane, corner_coefficients(plane, x, y), corners_reach(segment.a, x),
                             corners_reach(segment.b, y), options_.deviation_scale);
    }

    // The entry's elements with the closest points' directions at the interval's ends.
    void try_elements(Entry entry, const Vector3& n0, const Vector3& n1) {
        const Interval interval = intervals_[entry.interval];
        const PairSegment& segment = segment_of(interval);
        const SegmentBound bound = elements_bound(entry, n0, n1);
        entry.measured = entry.halve = true;
        entry.n0 = n0;
        entry.n1 = n1;
        // Where the bound has its dip the distance is nearly least: an upper bound that halving would take long to find.
        if (bound.dip >= 0 && bound.lower < cutoff()) {
            const double s = instants_[interval.start].s + bound.dip * length(interval);
            measure(interval.segment, instant_at(segment, s), entry.a, entry.b);
        }
        // Halving cannot win more than the loss; below the rounding charge it is not worth while.
        const bool worth = bound.at_ends - bound.lower > 4 * segment.slack;
        keep(entry, bound.lower, {n0, n1}, is_collecting() || (worth && can_halve(interval)));
    }

    // Distance of two elements at an instant: an upper bound, and the direction for the lower ones.
    Vector3 measure(int segment_index, const Instant& at, int a, int b) {
        Encounter encounter{segment_index, at.s, piece_a(a).first, piece_b(b).first, placed_distance(at, corners_a(a), corners_b(b))};
        const bool crossing = encounter.pair.intersecting;
        const Vector3 direction = crossing ? Vector3::Zero() : unit_direction(encounter.pair.difference);
        take_upper(encounter);
        return direction;
    }

    // The instants that the search looks at have a distance within the tolerance of the least, but a derivative at fixed time wants the
    // time itself right, whose error is the square root of that.
    void refine_nearest() {
        const PairSegment& segment = segments_[result_.nearest.segment];
        const bool was_crossing = result_.nearest.pair.intersecting;
        const Encounter better = refined(segment, a_, b_, result_.nearest);
        if (better.pair.intersecting != was_crossing) return;
        result_.nearest = better;
        result_.upper = better.pair.distance + segment.slack;
    }

    void take_upper(const Encounter& encounter) {
        const double slack = segments_[encounter.segment].slack, upper = encounter.pair.distance + slack;
        const bool clash = encounter.pair.intersecting && encounter.pair.depth > 8 * slack;
        const bool better = options_.seek_intersection ? clash && !result_.intersecting : upper < result_.upper;
        if (result_.nearest.segment >= 0 && !better) return;
        result_.upper = upper;
        result_.nearest = encounter;
        result_.intersecting = clash;
    }

    // So that there is an upper bound however small the budget: down from the roots at the first instant, to the nearest boxes.
    void take_distance_of_any_pair() {
        int a = 0, b = 0;
        const Instant at = instants_[intervals_[0].start];
        while (!piece_a(a).is_element() || !piece_b(b).is_element()) {
            const bool first = open_a(a, b);
            const Piece& piece = first ? piece_a(a) : piece_b(b);
            const auto apart = [&](int child) { return center_distance(at, first ? child : a, first ? b : child); };
            (first ? a : b) = apart(piece.left) <= apart(piece.right) ? piece.left : piece.right;
        }
        measure(0, at, a, b);
    }

    double center_distance(const Instant& at, int a, int b) const {
        return (at.offset + at.rotation_a * piece_a(a).center - at.rotation_b * piece_b(b).center).norm();
    }

    bool open_a(int a, int b) const {
        if (piece_a(a).is_element()) return false;
        return piece_b(b).is_element() || piece_a(a).half_extent.squaredNorm() >= piece_b(b).half_extent.squaredNorm();
    }

    void split(const Entry& entry) {
        const bool elements = piece_a(entry.a).is_element() && piece_b(entry.b).is_element();
        if (elements && is_collecting() && entry.measured) {
            if (!collect_pair(entry)) halve(entry);
        } else if (entry.halve) {
            halve(entry);
        } else if (elements) {
            measure_elements(entry);
        } else if (open_a(entry.a, entry.b)) {
            const auto [first, second] = recorder_.split(entry.cell, 'a');
            try_pieces(entry.interval, piece_a(entry.a).left, entry.b, first);
            try_pieces(entry.interval, piece_a(entry.a).right, entry.b, second);
        } else {
            const auto [first, second] = recorder_.split(entry.cell, 'b');
            try_pieces(entry.interval, entry.a, piece_b(entry.b).left, first);
            try_pieces(entry.interval, entry.a, piece_b(entry.b).right, second);
        }
    }

    // Closest points at the middle first: their direction is enough for most, and those at both ends cost twice as much.
    void measure_elements(const Entry& entry) {
        const Interval interval = intervals_[entry.interval];
        const Vector3 n = measure(interval.segment, instants_[interval.middle], entry.a, entry.b);
        if (interval.start == interval.end) return try_elements(entry, n, n);
        const SegmentBound bound = bounds_[entry.interval].along(n, piece_a(entry.a), piece_b(entry.b), &corners_a(entry.a),
                                                                 &corners_b(entry.b), options_.deviation_scale);
        if (!is_collecting() && bound.lower >= cutoff()) return keep(entry, bound.lower, {n, n}, true);
        const Vector3 n0 = measure(interval.segment, instants_[interval.start], entry.a, entry.b);
        try_elements(entry, n0, measure(interval.segment, instants_[interval.end], entry.a, entry.b));
    }

    void halve(const Entry& entry) {
        if (intervals_[entry.interval].first_half < 0) make_halves(entry.interval);
        const Interval interval = intervals_[entry.interval];
        const auto [first, second] = recorder_.split(entry.cell, 't');
        if (!entry.measured) {
            try_pieces(interval.first_half, entry.a, entry.b, first);
            try_pieces(interval.second_half, entry.a, entry.b, second);
            return;
        }
        const Vector3 n = measure(interval.segment, instants_[interval.middle], entry.a, entry.b);
        Entry half = entry;
        half.cell = first;
        half.interval = interval.first_half;
        try_elements(half, entry.n0, n);
        half.cell = second;
        half.interval = interval.second_half;
        try_elements(half, n, entry.n1);
    }

    void make_halves(int index) {
        Interval interval = intervals_[index];
        const double s0 = instants_[interval.start].s, s1 = instants_[interval.end].s;
        const int first = add_instant(segment_of(interval), 0.75 * s0 + 0.25 * s1);
        const int second = add_instant(segment_of(interval), 0.25 * s0 + 0.75 * s1);
        interval.first_half = static_cast<int>(intervals_.size());
        interval.second_half = interval.first_half + 1;
        push_interval({interval.segment, interval.start, first, interval.middle, -1, -1, interval.halvings + 1});
        push_interval({interval.segment, interval.middle, second, interval.end, -1, -1, interval.halvings + 1});
        intervals_[index] = interval;
    }

    // The elements' least distance near the interval, if it is within reach; else they have to be looked at more closely.
    bool collect_pair(const Entry& entry) {
        const Interval& interval = intervals_[entry.interval];
        const Instant &start = instants_[interval.start], &end = instants_[interval.end];
        Encounter at_start{interval.segment, start.s, piece_a(entry.a).first, piece_b(entry.b).first,
                           placed_distance(start, corners_a(entry.a), corners_b(entry.b))};
        Encounter at_end = at_start;
        at_end.s = end.s;
        at_end.pair = placed_distance(end, corners_a(entry.a), corners_b(entry.b));
        const Encounter nearest = refined(segment_of(interval), a_, b_, at_start.pair.distance <= at_end.pair.distance ? at_start : at_end);
        if (nearest.pair.distance <= within_) found_.push_back(nearest);
        return nearest.pair.distance <= within_ || !can_halve(interval);
    }

    const PieceTree &a_, &b_;
    const std::vector<PairSegment>& segments_;
    const SearchOptions& options_;
    ProofRecorder recorder_;
    std::vector<Instant> instants_;
    std::vector<Interval> intervals_;
    std::vector<IntervalBound> bounds_;  // of the intervals
    std::vector<Entry> entries_;
    std::vector<int> free_;    // places in entries_
    std::vector<Key> queue_;   // a heap
    double aside_ = infinity;  // least bound of the entries that are not in the queue any more and were not split
    std::int64_t made_ = 0;
    std::int64_t rounds_ = 0;
    double within_ = -1;  // collecting
    std::size_t most_ = 0;
    std::vector<Encounter> found_;
    SearchResult result_;
};

}  // namespace

SearchResult search_pair(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty(), "a search over no time");
    return PairSearch(a, b, segments, options).run();
}

std::vector<Encounter> encounters_within(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, double distance,
                                         std::size_t most, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty() && distance >= 0, "a search over no time or for no distance");
    return PairSearch(a, b, segments, options).collect(distance, most);
}

}  // namespace fettle::core::clearance
