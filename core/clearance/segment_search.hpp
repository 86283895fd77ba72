// SPDX-License-Identifier: MIT
/// The part of a search for a clearance (pair_search.hpp) that looks at one path segment at a time: its intervals, halved where the
/// motion loosens a bound more than the size of the boxes does, down to the closest points of two elements.
#pragma once

#include <optional>
#include <vector>

#include "fettle/core/clearance/hull_direction.hpp"
#include "fettle/core/clearance/piece_bound.hpp"
#include "fettle/core/clearance/proof_recorder.hpp"
#include "fettle/core/clearance/relative_spans.hpp"
#include "fettle/core/clearance/search_front.hpp"

namespace fettle::core::clearance {

class SegmentSearch {
public:
    explicit SegmentSearch(SearchFront& front);

    /// Both whole bodies, over every segment.
    void try_roots();
    /// Two pieces over a whole segment; returns a lower bound of their distance there.
    double try_segment(int segment, int a, int b) {
        make_whole(segment);
        return try_pieces(segment, a, b, {recorder_.root(segment)});
    }
    /// Halves an entry that the queue gave back, in time or in space, unless its bound has become good enough.
    void split(int entry, double lower);

    /// Distance of two elements at an end of a segment: an upper bound, and the direction for lower ones.
    Separation measure_at(const SegmentEnd& place, int element_a, int element_b);
    /// So that there is an upper bound however small the budget: down from the roots at the first instant, to the nearest boxes.
    void take_distance_of_any_pair();
    /// The instants that the search looks at have a distance within the tolerance of the least, but a derivative at fixed time wants the
    /// time itself right, whose error is the square root of that.
    void refine_nearest();

    const std::vector<Encounter>& found() const { return found_; }
    const ProofRecorder& recorder() const { return recorder_; }

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
        int cell = -1;          // of the recorder
        bool measured = false;  // two elements whose closest points are known at the interval's ends: n0, n1 are their directions
        bool beside = false;    // both whole bodies, whose hulls are apart along n0 and n1 at the interval's ends
        bool halve = false;     // in time, else in space
        double at_ends = 0;     // beside each other: what their bound may become by halving in time
        Vector3 n0 = Vector3::Zero(), n1 = Vector3::Zero();
    };

    // Of the recorder, and what is known of it.
    struct Cell {
        int index = -1;
        double lower = -infinity;
        certificate::LeafPlane plane{};  // proves it
    };

    void make_whole(int segment);
    void set_interval(int index, const Interval& i);
    void push_interval(const Interval& i);
    int add_instant(const PairSegment& segment, double s);
    void make_halves(int index);
    void keep(const Entry& entry, double lower, const certificate::LeafPlane& plane, bool splittable);
    double try_pieces(int interval_index, int a, int b, const Cell& cell);
    double try_hulls(const Entry& whole, const Cell& known);
    double try_hulls_along(const Entry& whole, const Vector3& n0, const Vector3& n1, const Cell& known);
    Vector3 hull_direction(int segment, int instant);
    SegmentBound elements_bound(const Entry& entry, const Vector3& n0, const Vector3& n1);
    void try_elements(Entry entry, const Vector3& n0, const Vector3& n1);
    Separation measure(int segment_index, const Instant& at, int element_a, int element_b);
    Separation measure(const Entry& entry, const Instant& at);
    void measure_elements(const Entry& entry);
    void halve(const Entry& entry);
    bool collect_pair(const Entry& entry);

    bool is_nodes_only() const { return front_.options.nodes_only; }
    const PairSegment& segment_of(const Interval& interval) const { return front_.segments[static_cast<std::size_t>(interval.segment)]; }
    const Piece& piece_a(int i) const { return front_.a.pieces[i]; }
    const Piece& piece_b(int i) const { return front_.b.pieces[i]; }
    const Corners& corners_a(int piece) const { return front_.a.elements[front_.a.pieces[piece].first].corners; }
    const Corners& corners_b(int piece) const { return front_.b.elements[front_.b.pieces[piece].first].corners; }
    double length(const Interval& interval) const { return instants_[interval.end].s - instants_[interval.start].s; }

    SearchFront& front_;
    ProofRecorder recorder_;
    HullDirection hulls_;
    std::vector<Instant> instants_;
    std::vector<Interval> intervals_;
    std::vector<std::optional<IntervalBound>> bounds_;  // of the intervals
    EntryPool<Entry> entries_;
    Encounter measured_;  // the last one
    std::vector<Encounter> found_;
};

/// Which of two pieces to split in space: the larger one that is not an element.
bool splits_a(const Piece& a, const Piece& b);

}  // namespace fettle::core::clearance
