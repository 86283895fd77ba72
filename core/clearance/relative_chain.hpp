// SPDX-License-Identifier: MIT
/// The poses of body a as seen from body b at all nodes of their path, and how far the segments between leave their chords and their
/// parabolas: what the spans of relative_spans.hpp are made of, where the formulas stand. Worked out four segments at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

/// Which of a pair's bodies is the frame: "body b" of this file and of relative_spans.hpp; "body a" is the other one.
struct Frame {
    bool exchanged = false;  ///< the pair's a is

    const BodySegment& moving(const PairSegment& segment) const { return exchanged ? *segment.b : *segment.a; }
    const BodySegment& fixed(const PairSegment& segment) const { return exchanged ? *segment.a : *segment.b; }
};

/// R_b^T R_a and R_b^T (q_a - q_b) at a node.
struct RelativePose {
    Matrix3 rotation;
    Vector3 offset;
};

/// What a point X of body a is off by at most: shift + |X| turn.
struct Rest {
    double turn = 0, shift = 0;
};

class RelativeChain {
public:
    static constexpr int entries = 12;  ///< of a pose: R by rows, then p
    static constexpr int padding = 16;  ///< so often, at least, the last node is repeated

    /// Contract: there are segments. Segment i leads from node i to node i + 1.
    RelativeChain(const std::vector<PairSegment>& segments, Frame frame, double radius_a, double radius_b);

    int segments() const { return segments_; }
    /// An entry of the poses at all nodes.
    const double* entry(int i) const { return row(i); }
    /// An entry of 2 X(1/2) - (X(0) + X(1))/2 of the segments: the middle coefficient of the parabola through three poses.
    const double* middle(int i) const { return row(entries + i); }
    /// The rests of the segments, each beside its chord, with what its end and the next one's start differ by; 0 beyond the last.
    const double* rest_turns() const { return row(2 * entries); }
    const double* rest_shifts() const { return row(2 * entries + 1); }
    /// The same beside its parabola.
    const double* parabola_rest_turns() const { return row(2 * entries + 2); }
    const double* parabola_rest_shifts() const { return row(2 * entries + 3); }
    /// The rest of segments first .. last - 1, beside the chord of all of them.
    Rest rest_of_span(int first, int last) const;

    /// For points of both bodies, whatever the segment: how far rounding of the poses may move them [m].
    double rounding() const { return rounding_; }
    /// >= the norm of any stored base of body b's; >= 1.
    double base_norm() const { return base_norm_; }

private:
    struct Block;
    static constexpr int rows = 2 * entries + 4;
    const double* row(int i) const { return values_.get() + static_cast<std::size_t>(i) * length_; }
    double* row(int i) { return values_.get() + static_cast<std::size_t>(i) * length_; }

    int segments_;
    std::size_t length_;                // of a row
    std::unique_ptr<double[]> values_;  // entries of the poses, of the middles, then the rests
    double rounding_ = 0, base_norm_ = 1;
};

}  // namespace fettle::core::clearance
