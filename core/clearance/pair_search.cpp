// SPDX-License-Identifier: MIT
#include "core/clearance/pair_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/rounding.hpp"
#include "core/clearance/hull_direction.hpp"
#include "core/clearance/piece_bound.hpp"
#include "core/clearance/relative_spans.hpp"
#include "core/clearance/search_front.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int max_halvings = 48;  // so that every parameter is a double exactly

bool is_still(const PairSegment& s) { return s.a->speed == 0 && s.b->speed == 0 && s.a->path.position_step == s.b->path.position_step; }

template <class Interval>
bool can_halve(const Interval& interval) {
    return interval.start != interval.end && interval.halvings < max_halvings;
}

// As corners_reach().
Reach whole_reach(const BodySegment& body, double radius) { return {radius, body.speed * body.base_norm * radius * rounded_up}; }

// Which of two pieces to split in space: the larger one that is not an element.
bool splits_a(const Piece& a, const Piece& b) {
    if (a.is_element()) return false;
    return b.is_element() || a.size >= b.size;
}

// Looks at one path segment at a time: its intervals, halved where the motion loosens a bound more than the size of the boxes does, down to
// the closest points of two elements.
class SegmentSearch {
public:
    explicit SegmentSearch(SearchFront& front) : front_(front), hulls_(front.a, front.b) {
        const auto count = count_of(front_.segments);
        intervals_.resize(count);
        bounds_.resize(count);
        if (is_nodes_only()) {
            for (int i = 0; i < count; ++i) make_whole(i);
            const int end = add_instant(front_.segments.back(), 1);
            push_interval({count - 1, end, end, end, -1, -1, 0});
        }
    }

    /// Both whole bodies, over every segment.
    void try_roots() {
        const auto roots = count_of(intervals_);
        for (int i = 0; i < roots; ++i) {
            if (i < count_of(front_.segments)) make_whole(i);
            try_pieces(i, 0, 0, -infinity);
        }
    }

    /// Two pieces over a whole segment; returns a lower bound of their distance there.
    double try_segment(int segment, int a, int b) {
        make_whole(segment);
        return try_pieces(segment, a, b, -infinity);
    }
    /// Halves an entry that the queue gave back, in time or in space, unless its bound has become good enough.
    void split(int index, double lower) {
        const Entry entry = entries_.take(index);
        if (lower >= front_.cutoff()) return front_.set_aside(lower);
        const bool elements = piece_a(entry.a).is_element() && piece_b(entry.b).is_element();
        if (elements && front_.is_collecting() && entry.measured) {
            if (!collect_pair(entry)) halve(entry);
        } else if (entry.halve || (entry.beside && entry.at_ends >= front_.cutoff())) {
            halve(entry);
        } else if (elements) {
            measure_elements(entry);
        } else if (splits_a(piece_a(entry.a), piece_b(entry.b))) {
            try_pieces(entry.interval, piece_a(entry.a).left, entry.b, lower);
            try_pieces(entry.interval, piece_a(entry.a).right, entry.b, lower);
        } else {
            try_pieces(entry.interval, entry.a, piece_b(entry.b).left, lower);
            try_pieces(entry.interval, entry.a, piece_b(entry.b).right, lower);
        }
    }

    /// Distance of two elements at an end of a segment: an upper bound, and the direction for lower ones.
    Separation measure_at(const SegmentEnd& place, int element_a, int element_b) {
        make_whole(place.segment);
        Instant at = instants_[place.at_end ? intervals_[place.segment].end : intervals_[place.segment].start];
        at.s = place.at_end ? 1 : 0;  // those of a segment at rest are one
        return measure(place.segment, at, element_a, element_b);
    }

    /// So that there is an upper bound however small the budget: down from the roots at the first instant, to the nearest boxes.
    void take_distance_of_any_pair() {
        int a = 0, b = 0;
        make_whole(0);
        const Instant at = instants_[intervals_[0].start];
        const auto apart = [&](int x, int y) {
            return (at.offset + at.rotation_a * piece_a(x).center - at.rotation_b * piece_b(y).center).norm();
        };
        while (!piece_a(a).is_element() || !piece_b(b).is_element()) {
            if (splits_a(piece_a(a), piece_b(b))) {
                const Piece& piece = piece_a(a);
                a = apart(piece.left, b) <= apart(piece.right, b) ? piece.left : piece.right;
            } else {
                const Piece& piece = piece_b(b);
                b = apart(a, piece.left) <= apart(a, piece.right) ? piece.left : piece.right;
            }
        }
        measure(0, at, piece_a(a).first, piece_b(b).first);
    }

    /// The instants that the search looks at have a distance within the tolerance of the least, but a derivative at fixed time wants the
    /// time itself right, whose error is the square root of that.
    void refine_nearest() {
        SearchResult& result = front_.result;
        const PairSegment& segment = front_.segments[result.nearest.segment];
        const bool was_crossing = result.nearest.pair.intersecting;
        const Encounter better = refined(segment, front_.a, front_.b, result.nearest);
        if (better.pair.intersecting != was_crossing) return;
        result.nearest = better;
        result.upper = better.pair.distance + segment.slack;
    }

    const std::vector<Encounter>& found() const { return found_; }

private:
    // A dyadic part of a segment; parts are made when first needed and shared by all pieces. Those of whole segments come first.
    struct Interval {
        int segment = 0;
        int start = -1, middle = 0, end = 0;  // indices of instants; start -1: not made yet
        int first_half = -1, second_half = -1;
        int halvings = 0;
    };
    struct Entry {
        int interval = 0;
        int a = 0, b = 0;       // pieces
        bool measured = false;  // two elements whose closest points are known at the interval's ends: n0, n1 are their directions
        bool beside = false;    // both whole bodies, whose hulls are apart along n0 and n1 at the interval's ends
        bool halve = false;     // in time, else in space
        double at_ends = 0;     // beside each other: what their bound may become by halving in time
        Vector3 n0 = Vector3::Zero(), n1 = Vector3::Zero();
    };

    void make_whole(int segment) {
        if (intervals_[segment].start >= 0) return;
        const PairSegment& moving = front_.segments[segment];
        const int start = add_instant(moving, 0);
        if (is_nodes_only() || is_still(moving)) return set_interval(segment, {segment, start, start, start, -1, -1, 0});
        const int middle = add_instant(moving, 0.5), end = add_instant(moving, 1);
        set_interval(segment, {segment, start, middle, end, -1, -1, 0});
    }

    void set_interval(int index, const Interval& i) {
        intervals_[index] = i;
        bounds_[index].emplace(segment_of(i), instants_[i.start], instants_[i.middle], instants_[i.end]);
    }

    void push_interval(const Interval& i) {
        intervals_.push_back(i);
        bounds_.emplace_back();
        set_interval(count_of(intervals_) - 1, i);
    }

    int add_instant(const PairSegment& segment, double s) {
        instants_.push_back(instant_at(segment, s));
        return count_of(instants_) - 1;
    }

    void make_halves(int index) {
        Interval interval = intervals_[index];
        const double s0 = instants_[interval.start].s, s1 = instants_[interval.end].s;
        const int first = add_instant(segment_of(interval), 0.75 * s0 + 0.25 * s1);
        const int second = add_instant(segment_of(interval), 0.25 * s0 + 0.75 * s1);
        interval.first_half = count_of(intervals_);
        interval.second_half = interval.first_half + 1;
        push_interval({interval.segment, interval.start, first, interval.middle, -1, -1, interval.halvings + 1});
        push_interval({interval.segment, interval.middle, second, interval.end, -1, -1, interval.halvings + 1});
        intervals_[index] = interval;
    }

    // Queues the entry, or sets it aside if it cannot change the result.
    void keep(const Entry& entry, double lower, bool splittable) {
        if (!splittable || lower >= front_.cutoff()) return front_.set_aside(lower);
        front_.push(lower, EntryKind::segment, entries_.add(entry));
    }

    // `known`: what was proven of the pieces that these are parts of.
    double try_pieces(int interval_index, int a, int b, double known) {
        ++front_.result.evaluations;
        const Interval& interval = intervals_[interval_index];
        const IntervalBound& prepared = *bounds_[interval_index];
        const Piece &piece_of_a = piece_a(a), &piece_of_b = piece_b(b);
        const Separation gap = separation(instants_[interval.middle], piece_of_a, piece_of_b);
        Entry entry;
        entry.interval = interval_index;
        entry.a = a;
        entry.b = b;
        const auto learn = [&](double lower) {
            if (!(known > lower)) known = lower;
        };
        const double motion = prepared.motion(piece_of_a, piece_of_b), at_once = gap.apart - motion - segment_of(interval).slack;
        const bool elements = piece_of_a.is_element() && piece_of_b.is_element();
        learn(at_once);
        if (!(at_once >= front_.cutoff()) && (elements || interval.start != interval.end)) {
            const SegmentBound bound = prepared.along(gap.direction, piece_of_a, piece_of_b, elements ? &corners_a(a) : nullptr,
                                                      elements ? &corners_b(b) : nullptr);
            if (!elements && can_halve(interval)) {
                const double size = piece_of_a.size + piece_of_b.size;
                entry.halve = bound.at_ends - bound.lower > 0.5 * size || (gap.apart <= 0 && motion > size);
            }
            // With the exact values of their corners elements may do better than at once, boxes with an overlap worse.
            learn(bound.lower);
        }
        if (a == 0 && b == 0 && !elements && gap.apart > 0 && known < front_.cutoff()) return try_hulls(entry, known);
        keep(entry, known, true);
        return known;
    }

    // Both whole bodies, as if they were two elements, where their hulls are apart.
    double try_hulls(const Entry& whole, double known) {
        const Interval interval = intervals_[whole.interval];
        const Vector3 n0 = hull_direction(interval.segment, interval.start);
        if (!n0.isZero(0))
            return try_hulls_along(whole, n0, interval.start == interval.end ? n0 : hull_direction(interval.segment, interval.end), known);
        keep(whole, known, true);
        return known;
    }

    double try_hulls_along(const Entry& whole, const Vector3& n0, const Vector3& n1, double known) {
        ++front_.result.evaluations;
        const Interval& interval = intervals_[whole.interval];
        const PairSegment& segment = segment_of(interval);
        const MovingPlane plane = moving_plane(instants_[interval.start], instants_[interval.middle], instants_[interval.end], n0, n1);
        Coefficients c{};
        Support a = any_support(front_.a), b = any_support(front_.b);
        for (std::size_t i = 0; i < c.size(); ++i) {
            a = support(front_.a, -plane.a[i], a);
            b = support(front_.b, plane.b[i], b);
            c[i] = plane.offset[i] - (a.value + b.value);
        }
        const ReachPair reach{whole_reach(*segment.a, front_.a.radius()), whole_reach(*segment.b, front_.b.radius())};
        const SegmentBound bound = segment_bound(segment, length(interval), plane, c, reach);
        Entry entry = whole;
        entry.beside = front_.are_beside = true;
        entry.halve = false;
        entry.n0 = n0;
        entry.n1 = n1;
        const bool worth = bound.at_ends - bound.lower > 4 * segment.slack;
        entry.at_ends = worth && can_halve(interval) ? bound.at_ends : -infinity;
        const double lower = known > bound.lower ? known : bound.lower;
        keep(entry, lower, true);
        return lower;
    }

    // From b to a where their hulls are nearest at an instant; zero if they meet.
    Vector3 hull_direction(int segment, int instant) {
        ++front_.result.evaluations;
        const Instant& at = instants_[instant];
        const HullDirection::Bound found =
            hulls_.at({at.rotation_b.transpose() * at.rotation_a, at.rotation_b.transpose() * at.offset}, front_.hull_tolerance());
        if (found.apart < front_.cutoff()) measure(segment, at, hulls_.element_a(), hulls_.element_b());
        return found.apart > 0 ? unit_direction(at.rotation_b * found.n) : Vector3::Zero();
    }

    SegmentBound elements_bound(const Entry& entry, const Vector3& n0, const Vector3& n1) {
        ++front_.result.evaluations;
        const Interval& interval = intervals_[entry.interval];
        const PairSegment& segment = segment_of(interval);
        const Matrix3 &x = corners_a(entry.a).x, &y = corners_b(entry.b).x;
        const MovingPlane plane = moving_plane(instants_[interval.start], instants_[interval.middle], instants_[interval.end], n0, n1);
        return segment_bound(segment, length(interval), plane, corner_coefficients(plane, x, y),
                             {corners_reach(*segment.a, x), corners_reach(*segment.b, y)});
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
        if (bound.dip >= 0 && bound.lower < front_.cutoff()) {
            const double s = instants_[interval.start].s + bound.dip * length(interval);
            measure(entry, instant_at(segment, s));
        }
        // Halving cannot win more than the loss; below the rounding charge it is not worth while.
        const bool worth = bound.at_ends - bound.lower > 4 * segment.slack;
        keep(entry, bound.lower, front_.is_collecting() || (worth && can_halve(interval)));
    }

    Separation measure(int segment_index, const Instant& at, int element_a, int element_b) {
        const bool again = measured_.segment >= 0 && measured_.element_a == element_a && measured_.element_b == element_b;
        const Corners &corners_a = front_.a.elements[element_a].corners, &corners_b = front_.b.elements[element_b].corners;
        const ElementPairDistance pair = placed_distance(at, corners_a, corners_b, again ? &measured_.pair : nullptr);
        measured_ = {segment_index, at.s, element_a, element_b, pair};
        front_.take_upper(measured_);
        if (pair.intersecting) return {};
        return {unit_direction(pair.difference), pair.distance};
    }

    Separation measure(const Entry& entry, const Instant& at) {
        return measure(intervals_[entry.interval].segment, at, piece_a(entry.a).first, piece_b(entry.b).first);
    }

    // Closest points at the middle first: their direction is enough for most, and those at both ends cost twice as much.
    void measure_elements(const Entry& entry) {
        const Interval interval = intervals_[entry.interval];
        const Vector3 n = measure(entry, instants_[interval.middle]).direction;
        if (interval.start == interval.end) return try_elements(entry, n, n);
        const SegmentBound bound =
            bounds_[entry.interval]->along(n, piece_a(entry.a), piece_b(entry.b), &corners_a(entry.a), &corners_b(entry.b));
        if (!front_.is_collecting() && bound.lower >= front_.cutoff()) return keep(entry, bound.lower, true);
        const Vector3 n0 = measure(entry, instants_[interval.start]).direction;
        try_elements(entry, n0, measure(entry, instants_[interval.end]).direction);
    }

    void halve(const Entry& entry) {
        if (intervals_[entry.interval].first_half < 0) make_halves(entry.interval);
        const Interval interval = intervals_[entry.interval];
        if (entry.beside) {
            Entry half = entry;
            const Vector3 n = hull_direction(interval.segment, interval.middle);
            half.interval = interval.first_half;
            try_hulls_along(half, entry.n0, n, -infinity);
            half.interval = interval.second_half;
            try_hulls_along(half, n, entry.n1, -infinity);
            return;
        }
        if (!entry.measured) {
            try_pieces(interval.first_half, entry.a, entry.b, -infinity);
            try_pieces(interval.second_half, entry.a, entry.b, -infinity);
            return;
        }
        const Vector3 n = measure(entry, instants_[interval.middle]).direction;
        Entry half = entry;
        half.interval = interval.first_half;
        try_elements(half, entry.n0, n);
        half.interval = interval.second_half;
        try_elements(half, n, entry.n1);
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
        const Encounter nearest =
            refined(segment_of(interval), front_.a, front_.b, at_start.pair.distance <= at_end.pair.distance ? at_start : at_end);
        const bool within = front_.is_within(nearest.pair.distance);
        if (within) found_.push_back(nearest);
        return within || !can_halve(interval);
    }

    bool is_nodes_only() const { return front_.options.nodes_only; }
    const PairSegment& segment_of(const Interval& interval) const { return front_.segments[interval.segment]; }
    const Piece& piece_a(int i) const { return front_.a.pieces[i]; }
    const Piece& piece_b(int i) const { return front_.b.pieces[i]; }
    const Corners& corners_a(int piece) const { return front_.a.elements[front_.a.pieces[piece].first].corners; }
    const Corners& corners_b(int piece) const { return front_.b.elements[front_.b.pieces[piece].first].corners; }
    double length(const Interval& interval) const { return instants_[interval.end].s - instants_[interval.start].s; }

    SearchFront& front_;
    HullDirection hulls_;
    std::vector<Instant> instants_;
    std::vector<Interval> intervals_;
    std::vector<std::optional<IntervalBound>> bounds_;  // of the intervals
    EntryPool<Entry> entries_;
    Encounter measured_;  // the last one
    std::vector<Encounter> found_;
};

// Calls with the index of every bit that is set.
template <class Call>
void for_bits(std::uint32_t bits, const Call& call) {
    for (; bits != 0; bits &= bits - 1) call(std::countr_zero(bits));
}

// Pieces of so many elements are tried by their hulls where their boxes are too near: corners of more of them cost more than parts do, and
// hulls of larger pieces of a surface that is not convex are nearer than it. Fewer pairs are as soon looked at one by one.
constexpr int most_elements_of_hull = 8, fewest_pairs_of_hulls = 4;

// Looks at many path segments at once, by the bounds of relative_spans.hpp: what is far enough apart, or moves together, is decided for all
// of them. What is left, two elements during one segment, goes to SegmentSearch.
class SpanSearch {
public:
    SpanSearch(SearchFront& front, SegmentSearch& segments)
        : front_(front),
          segments_(segments),
          frame_(better_frame(front.segments, front.a.radius(), front.b.radius())),
          spans_(front.segments, frame_, moving_tree().radius(), fixed_tree().radius()),
          hulls_(moving_tree(), fixed_tree()) {}

    /// Both whole bodies, over all the time.
    void try_root() { try_pieces(whole_group(spans_.root(), 0, 0, -infinity)); }

    /// Halves an entry that the queue gave back, in time or in space.
    // Spans that are open because of their rest only, or mostly, or during which the pieces go further than their size, are halved in time;
    // the others share one split in space.
    void split(int index) {
        Entry entry = entries_.take(index);
        close(entry);
        if (are_elements(entry)) return measure_elements(entry);
        const SpanGroup& group = spans_.group(entry.group);
        const double size = piece_a(entry.a).size + piece_b(entry.b).size, enough = span_cutoff(group);
        const double radius = moving(entry).radius;
        for_bits(entry.open_spans, [&](int j) {
            const double at_ends = std::min(entry.lower.nodes[j], entry.lower.nodes[j + 1]);
            const bool goes_far = group.level > 0 && group.step_shift[j] + radius * group.step_turn[j] > size;
            // Hulls cannot tell more in less time where they are near all the while.
            const double goes = group.step_shift[j] + radius * group.step_turn[j] + (at_ends - entry.lower.spans[j]);
            const bool whole = group.level > 0 && entry.beside && goes > enough - at_ends;
            if (!whole && at_ends < enough && at_ends - entry.lower.spans[j] <= 0.5 * size && !goes_far) return;
            halve_span(entry, j);
            entry.open_spans ^= 1U << j;
        });
        if (entry.open_spans != 0 || entry.open_nodes != 0) split_space(entry);
    }

private:
    // Two pieces over the spans of a group that are still open, and at the nodes that are, for sampling.
    struct Entry {
        int group = 0;
        int a = 0, b = 0;  // pieces
        SpanBounds lower;
        std::uint32_t open_spans = 0, open_nodes = 0;  // bits
        bool beside = false;                           // both whole bodies, whose hulls are apart
        int nearest = 0;                               // node: where the pieces are likely to be nearest
    };

    const Piece& piece_a(int i) const { return front_.a.pieces[i]; }
    const Piece& piece_b(int i) const { return front_.b.pieces[i]; }
    bool are_elements(const Entry& entry) const { return piece_a(entry.a).is_element() && piece_b(entry.b).is_element(); }
    Entry whole_group(int index, int a, int b, double lower) const {
        const SpanGroup& group = spans_.group(index);
        Entry entry;
        entry.group = index;
        entry.a = a;
        entry.b = b;
        entry.lower = {Lanes::Constant(lower), Lanes::Constant(lower)};
        entry.open_spans = (1U << group.count) - 1;
        if (group.level == 0 && front_.options.sample_nodes) entry.open_nodes = (2U << group.count) - 1;
        entry.nearest = group.count / 2;
        return entry;
    }

    // A span of several segments has to serve for the nodes inside it, too.
    double span_cutoff(const SpanGroup& group) const {
        return group.level == 0 ? front_.cutoff() : std::max(front_.cutoff(), front_.sampling_cutoff());
    }

    const PieceTree& moving_tree() const { return frame_.exchanged ? front_.b : front_.a; }
    const PieceTree& fixed_tree() const { return frame_.exchanged ? front_.a : front_.b; }
    const Piece& moving(const Entry& entry) const { return frame_.exchanged ? piece_b(entry.b) : piece_a(entry.a); }
    const Piece& fixed(const Entry& entry) const { return frame_.exchanged ? piece_a(entry.a) : piece_b(entry.b); }
    // Along n at the nearest node, which points from the frame's body to the other one. At the other nodes it points where the distance of
    // two round pieces would: what is far away turns it, faces that slide along each other do not.
    void tighten(Entry& entry, const Vector3& n, double apart, bool by_corners) {
        ++front_.result.evaluations;
        const Piece &x = moving(entry), &y = fixed(entry);
        const SpanGroup& group = spans_.group(entry.group);
        const double reach = apart + x.size + y.size;
        const TurningPlane plane{entry.nearest, n, apart / (reach * reach)};
        const std::uint32_t open = entry.open_spans | entry.open_spans << 1 | entry.open_nodes;
        const SpanBounds found = by_corners
                                     ? spans_.of_elements(group, plane, x, moving_tree().elements_of(x), fixed_tree().elements_of(y), open)
                                     : spans_.of_boxes(group, plane, x, y, open);
        take(found, open, entry);
    }

    // Are both pieces small, and yet more than a few pairs?
    bool are_for_hulls(const Entry& entry) const {
        const int a = piece_a(entry.a).count, b = piece_b(entry.b).count;
        return std::max(a, b) <= most_elements_of_hull && a * b >= fewest_pairs_of_hulls;
    }

    // Small pieces along the direction in which their hulls are nearest, at one node after another: where that is beyond the cutoff nothing
    // is as near there, or soon before and after. Returns the least bound of what stays open, which was `least`.
    double tighten_by_corners(Entry& entry, Vector3 n, double least) {
        const SpanGroup& group = spans_.group(entry.group);
        HullDirection hulls(moving_tree(), fixed_tree(), frame_.exchanged ? entry.b : entry.a, frame_.exchanged ? entry.a : entry.b);
        const double cutoff = span_cutoff(group);
        for (std::uint32_t tried = 0; least < infinity && (tried >> entry.nearest & 1) == 0;) {
            tried |= 1U << entry.nearest;
            ++front_.result.evaluations;
            const bool sampled = (entry.open_nodes >> entry.nearest & 1) != 0;
            const HullDirection::Bound bound =
                hulls.beyond(group.at(entry.nearest), n, sampled ? std::max(cutoff, front_.sampling_cutoff()) : cutoff);
            if (!(bound.apart > cutoff)) break;
            n = bound.n;
            tighten(entry, n, bound.apart, true);
            least = close(entry);
        }
        return least;
    }

    // Whole bodies along the directions in which their hulls are nearest.
    void tighten_by_hulls(Entry& entry) {
        const SpanGroup& group = spans_.group(entry.group);
        const std::uint32_t open = entry.open_spans | entry.open_spans << 1 | entry.open_nodes;
        const double tolerance = front_.hull_tolerance();
        NodePlanes planes;
        planes.n.fill(Vector3::Zero());
        ++front_.result.evaluations;
        if (!(hulls_.at(group.at(entry.nearest), tolerance).apart > 0)) return;
        entry.beside = front_.are_beside = true;
        for_bits(open, [&](int j) {
            ++front_.result.evaluations;
            const HullDirection::Bound bound = hulls_.at(group.at(j), tolerance);
            planes.n[j] = bound.n;
            planes.f[j] = bound.apart;
            if (!(bound.apart < front_.cutoff())) return;
            const int of_moving = hulls_.element_a(), of_fixed = hulls_.element_b();
            segments_.measure_at(group.end_at(j), frame_.exchanged ? of_fixed : of_moving, frame_.exchanged ? of_moving : of_fixed);
        });
        const SpanBounds found = spans_.of_planes(group, planes);
        take(found, open, entry);
    }

    static void take(const SpanBounds& found, std::uint32_t open, Entry& entry) {
        entry.lower = {entry.lower.spans.max(found.spans), entry.lower.nodes.max(found.nodes)};
        double least = infinity;
        for_bits(open, [&](int j) {
            if (!(found.nodes[j] < least)) return;
            least = found.nodes[j];
            entry.nearest = j;
        });
    }

    // Returns the least bound of what stays open.
    double close(Entry& entry) {
        const double enough = span_cutoff(spans_.group(entry.group)), sampling = front_.sampling_cutoff();
        double least = infinity;
        for_bits(entry.open_spans, [&](int j) {
            const double lower = proven(entry.lower.spans[j]);
            if (!(lower >= enough)) {
                least = std::min(least, lower);
            } else {
                front_.set_aside(lower);
                entry.open_spans ^= 1U << j;
            }
        });
        for_bits(entry.open_nodes, [&](int j) {
            const double lower = proven(entry.lower.nodes[j]);
            if (!(lower >= sampling)) {
                least = std::min(least, lower);
            } else {
                entry.open_nodes ^= 1U << j;
            }
        });
        return least;
    }

    void try_pieces(Entry entry) {
        const Separation gap = separation(spans_.group(entry.group).at(entry.nearest), moving(entry), fixed(entry));
        tighten(entry, gap.direction, gap.apart, are_elements(entry));
        double least = close(entry);
        if (least < infinity && entry.a == 0 && entry.b == 0 && gap.apart > 0 && !are_elements(entry)) {
            tighten_by_hulls(entry);
            least = close(entry);
        } else if (least < infinity && gap.apart > 0 && are_for_hulls(entry)) {
            least = tighten_by_corners(entry, gap.direction, least);
        }
        if (least < infinity) front_.push(least, EntryKind::spans, entries_.add(entry));
    }

    void split_space(const Entry& entry) {
        const Piece &a = piece_a(entry.a), &b = piece_b(entry.b);
        const bool first = splits_a(a, b);
        Entry half = entry;
        half.beside = false;
        (first ? half.a : half.b) = (first ? a : b).left;
        try_pieces(half);
        (first ? half.a : half.b) = (first ? a : b).right;
        try_pieces(half);
    }

    // Returns a lower bound over the span, if there is more than before.
    double halve_span(const Entry& entry, int span) {
        const SpanGroup& group = spans_.group(entry.group);
        if (group.level == 0) return segments_.try_segment(group.first + span, entry.a, entry.b);
        try_pieces(whole_group(group.first + span, entry.a, entry.b, entry.lower.spans[span]));
        return entry.lower.spans[span];
    }

    // Bounds along the direction of the closest points at a node, which is an upper bound, too.
    void measure_at(Entry& entry, int node) {
        const SegmentEnd place = spans_.group(entry.group).end_at(node);
        const BodySegment& fixed = frame_.fixed(front_.segments[place.segment]);
        const Matrix3& frame = fixed.poses[place.at_end ? 2 : 0].rotation;
        const Separation found = segments_.measure_at(place, piece_a(entry.a).first, piece_b(entry.b).first);
        entry.nearest = node;
        entry.open_nodes &= ~(1U << node);
        tighten(entry, unit_direction(frame.transpose() * (frame_.exchanged ? -found.direction : found.direction)), found.apart, true);
        close(entry);
    }

    void measure_elements(Entry entry) {
        measure_at(entry, entry.nearest);
        for_bits(entry.open_spans, [&](int j) {
            const double lower = halve_span(entry, j);
            for (const int node : {j, j + 1}) entry.lower.nodes[node] = std::max(entry.lower.nodes[node], lower);
        });
        entry.open_spans = 0;
        close(entry);
        while (entry.open_nodes != 0) {
            int nearest = std::countr_zero(entry.open_nodes);
            for_bits(entry.open_nodes, [&](int j) {
                if (entry.lower.nodes[j] < entry.lower.nodes[nearest]) nearest = j;
            });
            measure_at(entry, nearest);
        }
    }

    SearchFront& front_;
    SegmentSearch& segments_;
    Frame frame_;  // of the spans
    RelativeSpans spans_;
    HullDirection hulls_;
    EntryPool<Entry> entries_;
};

class PairSearch {
public:
    PairSearch(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options,
               double within = -1)
        : front_(a, b, segments, options, within), segments_(front_) {
        if (!options.nodes_only && segments.size() > 1) spans_.emplace(front_, segments_);
    }

    SearchResult run() {
        if (front_.options.seed) {
            front_.take_upper(*front_.options.seed);
        } else {
            segments_.take_distance_of_any_pair();
        }
        search(0);
        front_.result.lower = front_.lower_bound();
        if (!front_.options.nodes_only && front_.result.upper <= front_.options.enough) refine_nearest();
        return front_.result;
    }

    std::vector<Encounter> collect(std::size_t most) {
        search(most);
        return segments_.found();
    }

private:
    // Whole bodies' bounds leave open which elements are nearest: the nearest ones at an instant, then the instant where these are.
    void refine_nearest() {
        const SearchOptions& options = front_.options;
        if (!front_.are_beside || !front_.result.complete || !options.exact_witness || options.seek_intersection)
            return segments_.refine_nearest();
        constexpr int most_rounds = 4;
        for (int round = 0; round < most_rounds; ++round) {
            take_nearest_at_instant();
            const double s = front_.result.nearest.s;
            segments_.refine_nearest();
            if (front_.result.nearest.s == s) return;
        }
        take_nearest_at_instant();
    }

    void take_nearest_at_instant() {
        constexpr long most_evaluations = 2000;  // of faces that slide along each other many are as near
        const Encounter known = front_.result.nearest;
        const PairSegment& segment = front_.segments[known.segment];
        const std::vector<PairSegment> held{held_at(segment, known.s, front_.a.radius(), front_.b.radius())};
        SearchOptions options;
        options.tolerance = 3 * held.front().slack;  // what bounds are told less by, and distances more
        options.max_evaluations = std::min(most_evaluations, front_.options.max_evaluations - front_.result.evaluations);
        options.should_stop = front_.options.should_stop;
        PairSearch at_instant(front_.a, front_.b, held, options);
        Encounter nearest = known;
        nearest.segment = 0;
        at_instant.front_.take_upper(nearest);
        at_instant.search(0);
        nearest = at_instant.front_.result.nearest;
        front_.result.evaluations += at_instant.front_.result.evaluations;
        nearest.segment = known.segment;
        nearest.s = known.s;
        front_.take_upper(nearest);
    }

    void search(std::size_t most) {
        SearchResult& result = front_.result;
        if (!spans_) {
            segments_.try_roots();
        } else if (front_.options.should_stop && front_.options.should_stop()) {  // the root may well be all there is to do
            result.complete = false;
            front_.set_aside(0);
            return;
        } else {
            spans_->try_root();
        }
        while (!front_.is_settled() && (most == 0 || segments_.found().size() < most)) {
            result.complete = result.evaluations < front_.options.max_evaluations && !is_stopped();
            if (!result.complete) break;
            const SearchFront::Key key = front_.pop();
            if (key.is_spans != 0) {
                spans_->split(static_cast<int>(key.entry));
            } else {
                segments_.split(static_cast<int>(key.entry), key.lower);
            }
        }
    }

    bool is_stopped() { return front_.options.should_stop && (++rounds_ & 255) == 1 && front_.options.should_stop(); }

    SearchFront front_;
    SegmentSearch segments_;
    std::optional<SpanSearch> spans_;
    std::int64_t rounds_ = 0;
};

}  // namespace

SearchResult search_pair(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty(), "a search over no time");
    return PairSearch(a, b, segments, options).run();
}

std::vector<Encounter> encounters_within(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, double distance,
                                         std::size_t most, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty() && distance >= 0, "a search over no time or for no distance");
    return PairSearch(a, b, segments, options, distance).collect(most);
}

}  // namespace fettle::core::clearance
