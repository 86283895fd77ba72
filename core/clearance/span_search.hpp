// SPDX-License-Identifier: MIT
/// The part of a search for a clearance (pair_search.hpp) that looks at many path segments at once, by the bounds of relative_spans.hpp:
/// what is far enough apart, or moves together, is decided for all of them. What is left, two elements during one segment, goes to
/// segment_search.hpp.
#pragma once

#include <cstdint>

#include "fettle/core/clearance/hull_direction.hpp"
#include "fettle/core/clearance/relative_spans.hpp"
#include "fettle/core/clearance/search_front.hpp"
#include "fettle/core/clearance/segment_search.hpp"

namespace fettle::core::clearance {

class SpanSearch {
public:
    SpanSearch(SearchFront& front, SegmentSearch& segments);

    /// Both whole bodies, over all the time.
    void try_root();
    /// Halves an entry that the queue gave back, in time or in space.
    void split(int entry);

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

    const Piece& piece_a(int i) const { return front_.a.pieces[static_cast<std::size_t>(i)]; }
    const Piece& piece_b(int i) const { return front_.b.pieces[static_cast<std::size_t>(i)]; }
    bool are_elements(const Entry& entry) const { return piece_a(entry.a).is_element() && piece_b(entry.b).is_element(); }
    Entry whole_group(int group, int a, int b, double lower) const;
    double span_cutoff(const SpanGroup& group) const;
    const PieceTree& moving_tree() const { return frame_.exchanged ? front_.b : front_.a; }
    const PieceTree& fixed_tree() const { return frame_.exchanged ? front_.a : front_.b; }
    const Piece& moving(const Entry& entry) const { return frame_.exchanged ? piece_b(entry.b) : piece_a(entry.a); }
    const Piece& fixed(const Entry& entry) const { return frame_.exchanged ? piece_a(entry.a) : piece_b(entry.b); }
    void tighten(Entry& entry, const Vector3& n, double apart, bool by_corners);
    bool are_for_hulls(const Entry& entry) const;
    double tighten_by_corners(Entry& entry, Vector3 n, double least);
    void tighten_by_hulls(Entry& entry);
    static void take(const SpanBounds& found, std::uint32_t open, Entry& entry);
    double close(Entry& entry);
    void try_pieces(Entry entry);
    void split_space(const Entry& entry);
    double halve_span(const Entry& entry, int span);
    void measure_at(Entry& entry, int node);
    void measure_elements(Entry entry);

    SearchFront& front_;
    SegmentSearch& segments_;
    Frame frame_;  // of the spans
    RelativeSpans spans_;
    HullDirection hulls_;
    EntryPool<Entry> entries_;
};

}  // namespace fettle::core::clearance
