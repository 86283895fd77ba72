// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/span_search.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "fettle/core/base/limits.hpp"

namespace fettle::core::clearance {
namespace {

// Calls with the index of every bit that is set.
template <class Call>
void for_bits(std::uint32_t bits, const Call& call) {
    for (; bits != 0; bits &= bits - 1) call(std::countr_zero(bits));
}

// Pieces of so many elements are tried by their hulls where their boxes are too near: corners of more of them cost more than parts do, and
// hulls of larger pieces of a surface that is not convex are nearer than it. Fewer pairs are as soon looked at one by one.
constexpr int most_elements_of_hull = 8, fewest_pairs_of_hulls = 4;

}  // namespace

SpanSearch::SpanSearch(SearchFront& front, SegmentSearch& segments)
    : front_(front),
      segments_(segments),
      frame_(better_frame(front.segments, front.a.radius(), front.b.radius())),
      spans_(front.segments, frame_, moving_tree().radius(), fixed_tree().radius()),
      hulls_(moving_tree(), fixed_tree()) {}

void SpanSearch::try_root() { try_pieces(whole_group(spans_.root(), 0, 0, -infinity)); }

SpanSearch::Entry SpanSearch::whole_group(int index, int a, int b, double lower) const {
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
double SpanSearch::span_cutoff(const SpanGroup& group) const {
    return group.level == 0 ? front_.cutoff() : std::max(front_.cutoff(), front_.sampling_cutoff());
}

// Along n at the nearest node, which points from the frame's body to the other one. At the other nodes it points where the distance of
// two round pieces would: what is far away turns it, faces that slide along each other do not.
void SpanSearch::tighten(Entry& entry, const Vector3& n, double apart, bool by_corners) {
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
bool SpanSearch::are_for_hulls(const Entry& entry) const {
    const int a = piece_a(entry.a).count, b = piece_b(entry.b).count;
    return std::max(a, b) <= most_elements_of_hull && a * b >= fewest_pairs_of_hulls;
}

// Small pieces along the direction in which their hulls are nearest, at one node after another: where that is beyond the cutoff nothing is
// as near there, or soon before and after. Returns the least bound of what stays open, which was `least`.
double SpanSearch::tighten_by_corners(Entry& entry, Vector3 n, double least) {
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
void SpanSearch::tighten_by_hulls(Entry& entry) {
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
        planes.n[static_cast<std::size_t>(j)] = bound.n;
        planes.f[static_cast<std::size_t>(j)] = bound.apart;
        if (!(bound.apart < front_.cutoff())) return;
        const int of_moving = hulls_.element_a(), of_fixed = hulls_.element_b();
        segments_.measure_at(group.end_at(j), frame_.exchanged ? of_fixed : of_moving, frame_.exchanged ? of_moving : of_fixed);
    });
    const SpanBounds found = spans_.of_planes(group, planes);
    take(found, open, entry);
}

void SpanSearch::take(const SpanBounds& found, std::uint32_t open, Entry& entry) {
    entry.lower = {entry.lower.spans.max(found.spans), entry.lower.nodes.max(found.nodes)};
    double least = infinity;
    for_bits(open, [&](int j) {
        if (!(found.nodes[j] < least)) return;
        least = found.nodes[j];
        entry.nearest = j;
    });
}

// Returns the least bound of what stays open.
double SpanSearch::close(Entry& entry) {
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

void SpanSearch::try_pieces(Entry entry) {
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

// Spans that are open because of their rest only, or mostly, or during which the pieces go further than their size, are halved in time;
// the others share one split in space.
void SpanSearch::split(int index) {
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

void SpanSearch::split_space(const Entry& entry) {
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
double SpanSearch::halve_span(const Entry& entry, int span) {
    const SpanGroup& group = spans_.group(entry.group);
    if (group.level == 0) return segments_.try_segment(group.first + span, entry.a, entry.b);
    try_pieces(whole_group(group.first + span, entry.a, entry.b, entry.lower.spans[span]));
    return entry.lower.spans[span];
}

// Bounds along the direction of the closest points at a node, which is an upper bound, too.
void SpanSearch::measure_at(Entry& entry, int node) {
    const SegmentEnd place = spans_.group(entry.group).end_at(node);
    const BodySegment& fixed = frame_.fixed(front_.segments[static_cast<std::size_t>(place.segment)]);
    const Matrix3& frame = fixed.poses[place.at_end ? 2 : 0].rotation;
    const Separation found = segments_.measure_at(place, piece_a(entry.a).first, piece_b(entry.b).first);
    entry.nearest = node;
    entry.open_nodes &= ~(1U << node);
    tighten(entry, unit_direction(frame.transpose() * (frame_.exchanged ? -found.direction : found.direction)), found.apart, true);
    close(entry);
}

void SpanSearch::measure_elements(Entry entry) {
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

}  // namespace fettle::core::clearance
