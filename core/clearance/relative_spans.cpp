// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/relative_spans.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/rounding.hpp"
#include "fettle/core/base/wide_instructions.hpp"

namespace fettle::core::clearance {
namespace {

// What a body point X is off by at most: shift + |X| turn.
struct Rest {
    double turn = 0, shift = 0;
};

// `i`: 0, 1, 2 for s = 0, 1/2, 1.
RelativePose relative_pose(const PairSegment& segment, std::size_t i) {
    const Matrix3 back = segment.b->poses[i].rotation.transpose();
    return {back * segment.a->poses[i].rotation, back * (segment.a->poses[i].position - segment.b->poses[i].position)};
}

Rest difference(const RelativePose& x, const RelativePose& y) { return {(x.rotation - y.rotation).norm(), (x.offset - y.offset).norm()}; }

// Upper bound of |q_a - q_b| over the segment.
double reach_of_offset(const PairSegment& segment) {
    const auto apart = [&](std::size_t i) { return (segment.a->poses[i].position - segment.b->poses[i].position).norm(); };
    return std::max(apart(0), apart(2)) * rounded_up;
}

// Of one segment, beside its chord. `reach`: see above.
Rest rest_of_segment(const PairSegment& segment, const RelativePose& start, const RelativePose& end, double reach) {
    const RelativePose middle = relative_pose(segment, 1);
    const double wa = segment.a->speed, wb = segment.b->speed, w = wa + wb;
    const double travel = (segment.a->path.position_step - segment.b->path.position_step).norm();
    const double third_turn = w * w * w * segment.a->base_norm;
    const double third_shift = wb * wb * (wb * reach + 3 * travel);
    return {0.5 * (2 * middle.rotation - start.rotation - end.rotation).norm() + segment.b->base_norm * third_turn / 124,
            0.5 * (2 * middle.offset - start.offset - end.offset).norm() + segment.b->base_norm * third_shift / 124};
}

double pose_rounding(const PairSegment& segment, double radius_a, double radius_b, double reach) {
    const double norms = segment.a->base_norm * segment.b->base_norm;
    const double positions = segment.a->extent + segment.b->extent;
    const double size = 2 * radius_a + 2 * radius_b + reach;
    return 8 * norms * ((segment.a->rounding + segment.b->rounding + 64 * unit_roundoff) * size + 8 * unit_roundoff * positions);
}

void set_node(SpanGroup& group, int j, const RelativePose& pose, SegmentEnd place) {
    for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < 3; ++k) group.rotation[static_cast<std::size_t>(3 * row + k)][j] = pose.rotation(row, k);
        group.offset[static_cast<std::size_t>(row)][j] = pose.offset[row];
    }
    group.node[static_cast<std::size_t>(j)] = place;
}

void set_span(SpanGroup& group, int j, const Rest& rest, const Rest& step, double scale) {
    group.rest_turn[j] = scale * rest.turn * rounded_up;
    group.rest_shift[j] = scale * rest.shift * rounded_up;
    group.step_turn[j] = scale * step.turn * rounded_up;
    group.step_shift[j] = scale * step.shift * rounded_up;
}

// Four nodes at a time, which fit the registers; blocks without a wanted node are left out.
using base::Four;
using FourBits = long long __attribute__((vector_size(32)));
constexpr int block_size = 4;
struct FourVectors {
    Four x, y, z;
};
static_assert((most_spans + 1) % block_size == 0);

[[gnu::always_inline]] inline void load(const Lanes& lanes, int block, Four& out) {
    std::memcpy(&out, lanes.data() + block * block_size, sizeof out);
}
[[gnu::always_inline]] inline void dot(const FourVectors& n, const Vector3& v, Four& out) { out = v[0] * n.x + v[1] * n.y + v[2] * n.z; }
[[gnu::always_inline]] inline void subtract_magnitude(double factor, const FourVectors& n, const Vector3& v, Four& sum) {
    Four along;
    dot(n, v, along);
    sum -= factor * reinterpret_cast<Four>(reinterpret_cast<FourBits>(along) & std::numeric_limits<long long>::max());
}

// Of nodes.
struct NodeFunctions {
    std::array<double, most_spans + 2> f{};                         // one more, so that each has a next one
    std::array<std::array<double, most_spans + 2>, 3> direction{};  // n_j, where it turns
};

struct NodesAt {
    const SpanGroup& group;
    const TurningPlane& plane;
    const Piece& a;
    std::uint32_t wanted;
    Vector3 here;  // the center of a's piece, at the plane's node
};

// Of box against box.
struct OfBoxes {
    const Piece &a, &b;

    [[gnu::always_inline]] inline void operator()(const FourVectors& n, const FourVectors& m, Four& out) const {
        Four of_a, of_b;
        dot(m, a.center, of_a);
        dot(n, b.center, of_b);
        out = of_a - of_b;
        for (int k = 0; k < 3; ++k) {
            Four extents = {0, 0, 0, 0};
            subtract_magnitude(a.half_extent[k], m, a.axes.col(k), extents);
            subtract_magnitude(b.half_extent[k], n, b.axes.col(k), extents);
            out += extents;
        }
    }
};

struct OfElements {
    const Corners &a, &b;

    [[gnu::always_inline]] inline void operator()(const FourVectors& n, const FourVectors& m, Four& out) const {
        Four low, high, other;
        dot(m, a.x.col(0), low);
        dot(n, b.x.col(0), high);
        for (int k = 1; k < 3; ++k) {
            dot(m, a.x.col(k), other);
            low = other < low ? other : low;
            dot(n, b.x.col(k), other);
            high = other > high ? other : high;
        }
        out = low - high;
    }
};

// `at_nodes` is told n_j and R_j^T n_j: the rest of f_j, beside n_j.p_j.
template <class AtNodes>
[[gnu::always_inline]] inline void add_nodes(const NodesAt& at, const AtNodes& at_nodes, NodeFunctions& out) {
    const auto& r = at.group.rotation;
    const auto& offset = at.group.offset;
    for (int i = 0; i * block_size <= most_spans; ++i) {
        if ((at.wanted >> (i * block_size) & ((1U << block_size) - 1)) == 0) continue;
        std::array<Four, 9> rotation;
        FourVectors p;
        for (std::size_t k = 0; k < 9; ++k) load(r[k], i, rotation[k]);
        load(offset[0], i, p.x);
        load(offset[1], i, p.y);
        load(offset[2], i, p.z);
        const Four zero = {0, 0, 0, 0};
        FourVectors n{zero + at.plane.n[0], zero + at.plane.n[1], zero + at.plane.n[2]};
        if (at.plane.rate != 0) {
            Four goes;
            dot({rotation[0], rotation[1], rotation[2]}, at.a.center, goes);
            n.x += at.plane.rate * (goes + p.x - at.here[0]);
            dot({rotation[3], rotation[4], rotation[5]}, at.a.center, goes);
            n.y += at.plane.rate * (goes + p.y - at.here[1]);
            dot({rotation[6], rotation[7], rotation[8]}, at.a.center, goes);
            n.z += at.plane.rate * (goes + p.z - at.here[2]);
            const Four squared = n.x * n.x + n.y * n.y + n.z * n.z;
            Four scale;
            for (int j = 0; j < block_size; ++j) scale[j] = (1 - 8 * unit_roundoff) / std::sqrt(squared[j] > 1e-3 ? squared[j] : 1e-3);
            n = {n.x * scale, n.y * scale, n.z * scale};
            std::memcpy(out.direction[0].data() + i * block_size, &n.x, sizeof n.x);
            std::memcpy(out.direction[1].data() + i * block_size, &n.y, sizeof n.y);
            std::memcpy(out.direction[2].data() + i * block_size, &n.z, sizeof n.z);
        }
        const FourVectors m{n.x * rotation[0] + n.y * rotation[3] + n.z * rotation[6],
                            n.x * rotation[1] + n.y * rotation[4] + n.z * rotation[7],
                            n.x * rotation[2] + n.y * rotation[5] + n.z * rotation[8]};
        Four f;
        at_nodes(n, m, f);
        f = n.x * p.x + n.y * p.y + n.z * p.z + f;
        std::memcpy(out.f.data() + i * block_size, &f, sizeof f);
    }
}

struct Rounding {
    double shrink, slack;
};

template <class AtNodes>
[[gnu::always_inline]] inline void find_bounds(const NodesAt& at, const Rounding& rounding, const AtNodes& at_nodes, SpanBounds& out) {
    NodeFunctions found;
    add_nodes(at, at_nodes, found);
    const double outer = at.a.radius * rounded_up;
    const auto next = [](const std::array<double, most_spans + 2>& x, int block, Four& after) __attribute__((always_inline)) {
        std::memcpy(&after, x.data() + block * block_size + 1, sizeof after);
    };
    for (int i = 0; i * block_size <= most_spans; ++i) {
        Four rest, turn, nodes, after;
        load(at.group.rest_shift, i, rest);
        load(at.group.rest_turn, i, turn);
        rest += outer * turn;
        if (at.plane.rate != 0) {
            Four squared = {0, 0, 0, 0}, shift;
            for (const auto& n : found.direction) {
                std::memcpy(&nodes, n.data() + i * block_size, sizeof nodes);
                next(n, i, after);
                squared += (after - nodes) * (after - nodes);
            }
            load(at.group.step_shift, i, shift);
            load(at.group.step_turn, i, turn);
            for (int j = 0; j < block_size; ++j) squared[j] = std::sqrt(squared[j]);
            rest += squared * (0.25 * rounded_up) * (shift + outer * turn);
        }
        std::memcpy(&nodes, found.f.data() + i * block_size, sizeof nodes);
        next(found.f, i, after);
        // The sum of both ends is a NaN wherever one of them is, which the lesser of the two need not be.
        const Four sum = nodes + after, lesser = after < nodes ? after : nodes;
        const Four spans = ((sum == sum ? lesser : sum) - rest) * rounding.shrink - rounding.slack;
        nodes = nodes * rounding.shrink - rounding.slack;
        std::memcpy(out.spans.data() + i * block_size, &spans, sizeof spans);
        std::memcpy(out.nodes.data() + i * block_size, &nodes, sizeof nodes);
    }
}

template <class AtNodes>
FETTLE_WIDE void find_bounds_wide(const NodesAt& at, const Rounding& rounding, const AtNodes& at_nodes, SpanBounds& out) {
    find_bounds(at, rounding, at_nodes, out);
}

template <class AtNodes>
SpanBounds bounds(const NodesAt& at, const Rounding& rounding, const AtNodes& at_nodes) {
    SpanBounds out;
    if (base::has_wide_instructions())
        find_bounds_wide(at, rounding, at_nodes, out);
    else
        find_bounds(at, rounding, at_nodes, out);
    return out;
}

NodesAt nodes_at(const SpanGroup& group, const TurningPlane& plane, const Piece& a, std::uint32_t wanted) {
    const RelativePose at = group.at(plane.node);
    return {group, plane, a, wanted, at.rotation * a.center + at.offset};
}

// The chain of nodes of all segments, from which groups of every level are made.
struct Chain {
    std::vector<RelativePose> nodes;  // segment i leads from i to i + 1
    std::vector<Rest> rests;          // of the segments
    double rounding = 0;              // of the poses of any of them

    Chain(const std::vector<PairSegment>& segments, double radius_a, double radius_b) {
        const std::size_t count = segments.size();
        nodes.reserve(count + 1);
        rests.reserve(count);
        for (const PairSegment& segment : segments) nodes.push_back(relative_pose(segment, 0));
        nodes.push_back(relative_pose(segments.back(), 2));
        for (std::size_t i = 0; i < count; ++i) {
            const PairSegment& segment = segments[i];
            const double reach = reach_of_offset(segment);
            const RelativePose end = i + 1 < count ? end_of(segment, segments[i + 1], nodes[i + 1]) : nodes[count];
            const Rest rest = rest_of_segment(segment, nodes[i], end, reach), jump = difference(end, nodes[i + 1]);
            rests.push_back({rest.turn + jump.turn, rest.shift + jump.shift});
            rounding = std::max(rounding, pose_rounding(segment, radius_a, radius_b, reach));
        }
    }

    // Most paths go on with the very rotations with which they end: those of `begun`, the next node.
    static RelativePose end_of(const PairSegment& segment, const PairSegment& next, const RelativePose& begun) {
        const Matrix3 &frame = segment.b->poses[2].rotation, &other = segment.a->poses[2].rotation;
        if (frame != next.b->poses[0].rotation || other != next.a->poses[0].rotation) return relative_pose(segment, 2);
        return {begun.rotation, frame.transpose() * (segment.a->poses[2].position - segment.b->poses[2].position)};
    }

    // Segments first .. last - 1, beside the chord of all of them.
    Rest rest_of_span(std::size_t first, std::size_t last) const {
        Rest own = rests[first], off;
        const RelativePose &start = nodes[first], &end = nodes[last];
        for (std::size_t i = first + 1; i < last; ++i) {
            own = {std::max(own.turn, rests[i].turn), std::max(own.shift, rests[i].shift)};
            const double s = static_cast<double>(i - first) / static_cast<double>(last - first);
            const RelativePose chord{(1 - s) * start.rotation + s * end.rotation, (1 - s) * start.offset + s * end.offset};
            const Rest here = difference(chord, nodes[i]);
            off = {std::max(off.turn, here.turn), std::max(off.shift, here.shift)};
        }
        return {own.turn + off.turn, own.shift + off.shift};
    }
};

}  // namespace

RelativePose SpanGroup::at(int j) const {
    RelativePose pose;
    for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < 3; ++k) pose.rotation(row, k) = rotation[static_cast<std::size_t>(3 * row + k)][j];
        pose.offset[row] = offset[static_cast<std::size_t>(row)][j];
    }
    return pose;
}

Separation separation(const RelativePose& at, const Piece& a, const Piece& b) {
    return box_separation(at.rotation * a.center + at.offset - b.center, at.rotation * a.axes, a.half_extent, b.axes, b.half_extent);
}

RelativeSpans::RelativeSpans(const std::vector<PairSegment>& segments, double radius_a, double radius_b, double deviation_scale) {
    FETTLE_ASSERT(!segments.empty(), "spans of no time");
    const Chain chain(segments, radius_a, radius_b);
    const auto total = static_cast<int>(segments.size());
    double norm = 1;
    for (const PairSegment& segment : segments) norm = std::max(norm, segment.b->base_norm);
    slack_ = (chain.rounding + (norm * norm - 1 + 8 * unit_roundoff) * 2 * radius_b) * rounded_up + std::numeric_limits<double>::min();
    shrink_ = (1 - 8 * unit_roundoff) / norm;
    int begin = 0, spans = total, length = 1;  // spans of the level begin at this index, and last so many segments
    for (int level = 0;; ++level) {
        const int groups = (spans + most_spans - 1) / most_spans;
        for (int g = 0; g < groups; ++g) {
            SpanGroup group;
            group.level = level;
            group.count = std::min(most_spans, spans - g * most_spans);
            group.first = begin + g * most_spans;
            for (Lanes* lanes : {&group.rest_turn, &group.rest_shift, &group.step_turn, &group.step_shift}) lanes->setZero();
            for (int j = 0; j <= most_spans; ++j) {
                const int i = std::min((g * most_spans + j) * length, total), last = std::min(i + length, total);
                const int node = j <= group.count ? i : std::min((g * most_spans + group.count) * length, total);
                set_node(group, j, chain.nodes[static_cast<std::size_t>(node)], {std::min(node, total - 1), node == total});
                if (j >= group.count) continue;
                const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(last);
                set_span(group, j, chain.rest_of_span(from, to), difference(chain.nodes[from], chain.nodes[to]), deviation_scale);
            }
            groups_.push_back(group);
        }
        if (groups == 1) break;
        begin = static_cast<int>(groups_.size()) - groups;
        spans = groups;
        length *= most_spans;
    }
}

SpanBounds RelativeSpans::of_boxes(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Piece& b,
                                   std::uint32_t wanted) const {
    return bounds(nodes_at(group, plane, a, wanted), Rounding{shrink_, slack_}, OfBoxes{a, b});
}

SpanBounds RelativeSpans::of_elements(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Corners& element_a,
                                      const Corners& element_b, std::uint32_t wanted) const {
    return bounds(nodes_at(group, plane, a, wanted), Rounding{shrink_, slack_}, OfElements{element_a, element_b});
}

bool is_better_frame_a(const std::vector<PairSegment>& segments, double radius_a, double radius_b) {
    // Rotations leave their chords alike in both frames; offsets do not.
    const auto rest_of_offset = [](const PairSegment& segment, const BodySegment& frame) {
        const auto offset = [&](std::size_t i) {
            return Vector3(frame.poses[i].rotation.transpose() * (segment.a->poses[i].position - segment.b->poses[i].position));
        };
        return 0.5 * (2 * offset(1) - offset(0) - offset(2)).norm();
    };
    const auto rest_of_rotation = [](const PairSegment& segment) {
        const auto rotation = [&](std::size_t i) {
            return Matrix3(segment.b->poses[i].rotation.transpose() * segment.a->poses[i].rotation);
        };
        return 0.5 * (2 * rotation(1) - rotation(0) - rotation(2)).norm();
    };
    constexpr std::size_t looked_at = 16;  // segments: enough to tell
    double as_frame_a = 0, as_frame_b = 0;
    for (std::size_t i = 0; i < segments.size(); i += segments.size() / looked_at + 1) {
        const PairSegment& segment = segments[i];
        as_frame_a += rest_of_offset(segment, *segment.a);
        as_frame_b += rest_of_offset(segment, *segment.b);
        if (radius_a == radius_b) continue;
        const double turn = rest_of_rotation(segment);
        as_frame_a += radius_b * turn;
        as_frame_b += radius_a * turn;
    }
    return as_frame_a < as_frame_b;
}

std::vector<PairSegment> exchanged(const std::vector<PairSegment>& segments) {
    std::vector<PairSegment> result = segments;
    for (PairSegment& segment : result) std::swap(segment.a, segment.b);
    return result;
}

}  // namespace fettle::core::clearance
