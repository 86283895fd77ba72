// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/segment_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

#include "fettle/core/base/rounding.hpp"

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

}  // namespace

bool splits_a(const Piece& a, const Piece& b) {
    if (a.is_element()) return false;
    return b.is_element() || a.size >= b.size;
}

SegmentSearch::SegmentSearch(SearchFront& front)
    : front_(front), recorder_(front.options.proof != nullptr, front.segments.size()), hulls_(front.a, front.b) {
    const auto count = static_cast<int>(front_.segments.size());
    intervals_.resize(static_cast<std::size_t>(count));
    bounds_.resize(static_cast<std::size_t>(count));
    if (is_nodes_only()) {
        for (int i = 0; i < count; ++i) make_whole(i);
        const int end = add_instant(front_.segments.back(), 1);
        push_interval({count - 1, end, end, end, -1, -1, 0});
    }
}

void SegmentSearch::try_roots() {
    const auto roots = static_cast<int>(intervals_.size());
    for (int i = 0; i < roots; ++i) {
        if (i < static_cast<int>(front_.segments.size())) make_whole(i);
        try_pieces(i, 0, 0, {recorder_.root(intervals_[i].segment)});
    }
}

void SegmentSearch::make_whole(int segment) {
    if (intervals_[segment].start >= 0) return;
    const PairSegment& moving = front_.segments[static_cast<std::size_t>(segment)];
    const int start = add_instant(moving, 0);
    if (is_nodes_only() || is_still(moving)) return set_interval(segment, {segment, start, start, start, -1, -1, 0});
    const int middle = add_instant(moving, 0.5), end = add_instant(moving, 1);
    set_interval(segment, {segment, start, middle, end, -1, -1, 0});
}

void SegmentSearch::set_interval(int index, const Interval& i) {
    intervals_[index] = i;
    bounds_[index].emplace(segment_of(i), instants_[i.start], instants_[i.middle], instants_[i.end]);
}

void SegmentSearch::push_interval(const Interval& i) {
    intervals_.push_back(i);
    bounds_.emplace_back();
    set_interval(static_cast<int>(intervals_.size()) - 1, i);
}

int SegmentSearch::add_instant(const PairSegment& segment, double s) {
    instants_.push_back(instant_at(segment, s));
    return static_cast<int>(instants_.size()) - 1;
}

void SegmentSearch::make_halves(int index) {
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

// Queues the entry, or sets it aside if it cannot change the result. `plane` proves `lower`.
void SegmentSearch::keep(const Entry& entry, double lower, const certificate::LeafPlane& plane, bool splittable) {
    recorder_.set_plane(entry.cell, plane);
    if (!splittable || lower >= front_.cutoff()) return front_.set_aside(lower);
    front_.push(lower, EntryKind::segment, entries_.add(entry));
}

// `cell` knows what was proven of the pieces that these are parts of.
double SegmentSearch::try_pieces(int interval_index, int a, int b, const Cell& cell) {
    ++front_.result.evaluations;
    const Interval& interval = intervals_[interval_index];
    const IntervalBound& prepared = *bounds_[interval_index];
    const Piece &piece_of_a = piece_a(a), &piece_of_b = piece_b(b);
    const Separation gap = separation(instants_[interval.middle], piece_of_a, piece_of_b);
    Entry entry;
    entry.interval = interval_index;
    entry.a = a;
    entry.b = b;
    entry.cell = cell.index;
    Cell known = cell;
    const auto learn = [&](double lower) {
        if (!(known.lower > lower)) known = {cell.index, lower, {gap.direction, gap.direction}};
    };
    const double motion = prepared.motion(piece_of_a, piece_of_b), at_once = gap.apart - motion - segment_of(interval).slack;
    const bool elements = piece_of_a.is_element() && piece_of_b.is_element();
    learn(at_once);
    if (!(at_once >= front_.cutoff()) && (elements || interval.start != interval.end)) {
        const SegmentBound bound =
            prepared.along(gap.direction, piece_of_a, piece_of_b, elements ? &corners_a(a) : nullptr, elements ? &corners_b(b) : nullptr);
        if (!elements && can_halve(interval)) {
            const double size = piece_of_a.size + piece_of_b.size;
            entry.halve = bound.at_ends - bound.lower > 0.5 * size || (gap.apart <= 0 && motion > size);
        }
        // With the exact values of their corners elements may do better than at once, boxes with an overlap worse.
        learn(bound.lower);
    }
    if (a == 0 && b == 0 && !elements && gap.apart > 0 && known.lower < front_.cutoff()) return try_hulls(entry, known);
    keep(entry, known.lower, known.plane, true);
    return known.lower;
}

// From b to a where their hulls are nearest at an instant; zero if they meet.
Vector3 SegmentSearch::hull_direction(int segment, int instant) {
    ++front_.result.evaluations;
    const Instant& at = instants_[instant];
    const HullDirection::Bound found =
        hulls_.at({at.rotation_b.transpose() * at.rotation_a, at.rotation_b.transpose() * at.offset}, front_.hull_tolerance());
    if (found.apart < front_.cutoff()) measure(segment, at, hulls_.element_a(), hulls_.element_b());
    return found.apart > 0 ? unit_direction(at.rotation_b * found.n) : Vector3::Zero();
}

// Both whole bodies, as if they were two elements, where their hulls are apart.
double SegmentSearch::try_hulls(const Entry& whole, const Cell& known) {
    const Interval interval = intervals_[whole.interval];
    const Vector3 n0 = hull_direction(interval.segment, interval.start);
    if (!n0.isZero(0))
        return try_hulls_along(whole, n0, interval.start == interval.end ? n0 : hull_direction(interval.segment, interval.end), known);
    keep(whole, known.lower, known.plane, true);
    return known.lower;
}

double SegmentSearch::try_hulls_along(const Entry& whole, const Vector3& n0, const Vector3& n1, const Cell& known) {
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
    const bool better = !(known.lower > bound.lower);
    const double lower = better ? bound.lower : known.lower;
    keep(entry, lower, better ? certificate::LeafPlane{n0, n1} : known.plane, true);
    return lower;
}

SegmentBound SegmentSearch::elements_bound(const Entry& entry, const Vector3& n0, const Vector3& n1) {
    ++front_.result.evaluations;
    const Interval& interval = intervals_[entry.interval];
    const PairSegment& segment = segment_of(interval);
    const Matrix3 &x = corners_a(entry.a).x, &y = corners_b(entry.b).x;
    const MovingPlane plane = moving_plane(instants_[interval.start], instants_[interval.middle], instants_[interval.end], n0, n1);
    return segment_bound(segment, length(interval), plane, corner_coefficients(plane, x, y),
                         {corners_reach(*segment.a, x), corners_reach(*segment.b, y)});
}

// The entry's elements with the closest points' directions at the interval's ends.
void SegmentSearch::try_elements(Entry entry, const Vector3& n0, const Vector3& n1) {
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
    keep(entry, bound.lower, {n0, n1}, front_.is_collecting() || (worth && can_halve(interval)));
}

Separation SegmentSearch::measure(int segment_index, const Instant& at, int element_a, int element_b) {
    const bool again = measured_.segment >= 0 && measured_.element_a == element_a && measured_.element_b == element_b;
    const Corners &corners_a = front_.a.elements[static_cast<std::size_t>(element_a)].corners,
                  &corners_b = front_.b.elements[static_cast<std::size_t>(element_b)].corners;
    const ElementPairDistance pair = placed_distance(at, corners_a, corners_b, again ? &measured_.pair : nullptr);
    measured_ = {segment_index, at.s, element_a, element_b, pair};
    front_.take_upper(measured_);
    if (pair.intersecting) return {};
    return {unit_direction(pair.difference), pair.distance};
}

Separation SegmentSearch::measure(const Entry& entry, const Instant& at) {
    return measure(intervals_[entry.interval].segment, at, piece_a(entry.a).first, piece_b(entry.b).first);
}

Separation SegmentSearch::measure_at(const SegmentEnd& place, int element_a, int element_b) {
    make_whole(place.segment);
    Instant at = instants_[place.at_end ? intervals_[place.segment].end : intervals_[place.segment].start];
    at.s = place.at_end ? 1 : 0;  // those of a segment at rest are one
    return measure(place.segment, at, element_a, element_b);
}

void SegmentSearch::refine_nearest() {
    SearchResult& result = front_.result;
    const PairSegment& segment = front_.segments[static_cast<std::size_t>(result.nearest.segment)];
    const bool was_crossing = result.nearest.pair.intersecting;
    const Encounter better = refined(segment, front_.a, front_.b, result.nearest);
    if (better.pair.intersecting != was_crossing) return;
    result.nearest = better;
    result.upper = better.pair.distance + segment.slack;
}

void SegmentSearch::take_distance_of_any_pair() {
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

void SegmentSearch::split(int index, double lower) {
    const Entry entry = entries_.take(index);
    if (lower >= front_.cutoff()) return front_.set_aside(lower);
    const certificate::LeafPlane plane = recorder_.plane(entry.cell);
    const bool elements = piece_a(entry.a).is_element() && piece_b(entry.b).is_element();
    if (elements && front_.is_collecting() && entry.measured) {
        if (!collect_pair(entry)) halve(entry);
    } else if (entry.halve || (entry.beside && entry.at_ends >= front_.cutoff())) {
        halve(entry);
    } else if (elements) {
        measure_elements(entry);
    } else if (splits_a(piece_a(entry.a), piece_b(entry.b))) {
        const auto [first, second] = recorder_.split(entry.cell, 'a');
        try_pieces(entry.interval, piece_a(entry.a).left, entry.b, {first, lower, plane});
        try_pieces(entry.interval, piece_a(entry.a).right, entry.b, {second, lower, plane});
    } else {
        const auto [first, second] = recorder_.split(entry.cell, 'b');
        try_pieces(entry.interval, entry.a, piece_b(entry.b).left, {first, lower, plane});
        try_pieces(entry.interval, entry.a, piece_b(entry.b).right, {second, lower, plane});
    }
}

// Closest points at the middle first: their direction is enough for most, and those at both ends cost twice as much.
void SegmentSearch::measure_elements(const Entry& entry) {
    const Interval interval = intervals_[entry.interval];
    const Vector3 n = measure(entry, instants_[interval.middle]).direction;
    if (interval.start == interval.end) return try_elements(entry, n, n);
    const SegmentBound bound =
        bounds_[entry.interval]->along(n, piece_a(entry.a), piece_b(entry.b), &corners_a(entry.a), &corners_b(entry.b));
    if (!front_.is_collecting() && bound.lower >= front_.cutoff()) return keep(entry, bound.lower, {n, n}, true);
    const Vector3 n0 = measure(entry, instants_[interval.start]).direction;
    try_elements(entry, n0, measure(entry, instants_[interval.end]).direction);
}

void SegmentSearch::halve(const Entry& entry) {
    if (intervals_[entry.interval].first_half < 0) make_halves(entry.interval);
    const Interval interval = intervals_[entry.interval];
    const auto [first, second] = recorder_.split(entry.cell, '0');
    if (entry.beside) {
        Entry half = entry;
        const Vector3 n = hull_direction(interval.segment, interval.middle);
        half.cell = first;
        half.interval = interval.first_half;
        try_hulls_along(half, entry.n0, n, {first});
        half.cell = second;
        half.interval = interval.second_half;
        try_hulls_along(half, n, entry.n1, {second});
        return;
    }
    if (!entry.measured) {
        try_pieces(interval.first_half, entry.a, entry.b, {first});
        try_pieces(interval.second_half, entry.a, entry.b, {second});
        return;
    }
    const Vector3 n = measure(entry, instants_[interval.middle]).direction;
    Entry half = entry;
    half.cell = first;
    half.interval = interval.first_half;
    try_elements(half, entry.n0, n);
    half.cell = second;
    half.interval = interval.second_half;
    try_elements(half, n, entry.n1);
}

// The elements' least distance near the interval, if it is within reach; else they have to be looked at more closely.
bool SegmentSearch::collect_pair(const Entry& entry) {
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

}  // namespace fettle::core::clearance
