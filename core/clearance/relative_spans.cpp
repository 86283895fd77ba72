// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/relative_spans.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/rounding.hpp"

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

// Of one segment, beside its chord.
Rest rest_of_segment(const PairSegment& segment, const RelativePose& start, const RelativePose& end) {
    const RelativePose middle = relative_pose(segment, 1);
    const double wa = segment.a->speed, wb = segment.b->speed, w = wa + wb;
    const double travel = (segment.a->path.position_step - segment.b->path.position_step).norm();
    const double third_turn = w * w * w * segment.a->base_norm;
    const double third_shift = wb * wb * (wb * reach_of_offset(segment) + 3 * travel);
    return {0.5 * (2 * middle.rotation - start.rotation - end.rotation).norm() + segment.b->base_norm * third_turn / 124,
            0.5 * (2 * middle.offset - start.offset - end.offset).norm() + segment.b->base_norm * third_shift / 124};
}

double pose_rounding(const PairSegment& segment, double radius_a, double radius_b) {
    const kinematics::PathSegment &a = segment.a->path, &b = segment.b->path;
    const double norms = segment.a->base_norm * segment.b->base_norm;
    const double positions = a.position_t0.norm() + a.position_step.norm() + b.position_t0.norm() + b.position_step.norm();
    const double size = 2 * radius_a + 2 * radius_b + reach_of_offset(segment);
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
constexpr int block_size = 4;
using Block = Eigen::Array<double, block_size, 1>;
using Blocks = std::array<Block, 3>;
static_assert((most_spans + 1) % block_size == 0);

auto block_of(const Lanes& lanes, int block) { return lanes.segment<block_size>(block * block_size); }
[[gnu::always_inline]] inline Block dot(const Blocks& n, const Vector3& v) { return v[0] * n[0] + v[1] * n[1] + v[2] * n[2]; }

// The chain of nodes of all segments, from which groups of every level are made.
struct Chain {
    std::vector<RelativePose> nodes;  // segment i leads from i to i + 1
    std::vector<Rest> rests;          // of the segments

    explicit Chain(const std::vector<PairSegment>& segments) {
        const std::size_t count = segments.size();
        for (const PairSegment& segment : segments) nodes.push_back(relative_pose(segment, 0));
        nodes.push_back(relative_pose(segments.back(), 2));
        for (std::size_t i = 0; i < count; ++i) {
            const RelativePose end = i + 1 < count ? relative_pose(segments[i], 2) : nodes[count];
            const Rest rest = rest_of_segment(segments[i], nodes[i], end), jump = difference(end, nodes[i + 1]);
            rests.push_back({rest.turn + jump.turn, rest.shift + jump.shift});
        }
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
    const Chain chain(segments);
    const auto total = static_cast<int>(segments.size());
    double norm = 1;
    for (const PairSegment& segment : segments) {
        norm = std::max(norm, segment.b->base_norm);
        slack_ = std::max(slack_, pose_rounding(segment, radius_a, radius_b));
    }
    slack_ = (slack_ + (norm * norm - 1 + 8 * unit_roundoff) * 2 * radius_b) * rounded_up + std::numeric_limits<double>::min();
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

// `at_nodes` is told n_j and R_j^T n_j: the rest of f_j, beside n_j.p_j.
template <class AtNodes>
SpanBounds RelativeSpans::bounds(const SpanGroup& group, const TurningPlane& plane, const Piece& a, std::uint32_t wanted,
                                 const AtNodes& at_nodes) const {
    const auto& r = group.rotation;
    const RelativePose at = group.at(plane.node);
    const Vector3 here = at.rotation * a.center + at.offset;
    Eigen::Array<double, most_spans + 2, 1> f = Eigen::Array<double, most_spans + 2, 1>::Zero();  // one more, so that each has a next one
    std::array<Eigen::Array<double, most_spans + 2, 1>, 3> directions{f, f, f};
    for (int i = 0; i * block_size <= most_spans; ++i) {
        if ((wanted >> (i * block_size) & ((1U << block_size) - 1)) == 0) continue;
        Blocks n{Block::Constant(plane.n[0]), Block::Constant(plane.n[1]), Block::Constant(plane.n[2])};
        if (plane.rate != 0) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Block goes = a.center[0] * block_of(r[3 * k], i) + a.center[1] * block_of(r[3 * k + 1], i) +
                                   a.center[2] * block_of(r[3 * k + 2], i) + block_of(group.offset[k], i);
                n[k] += plane.rate * (goes - here[static_cast<int>(k)]);
            }
            const Block squared = n[0].square() + n[1].square() + n[2].square();
            const Block scale = (1 - 8 * unit_roundoff) / squared.max(Block::Constant(1e-3)).sqrt();
            for (std::size_t k = 0; k < 3; ++k) directions[k].segment<block_size>(i * block_size) = n[k] *= scale;
        }
        Blocks m;
        for (std::size_t k = 0; k < 3; ++k) m[k] = n[0] * block_of(r[k], i) + n[1] * block_of(r[3 + k], i) + n[2] * block_of(r[6 + k], i);
        const Block along = n[0] * block_of(group.offset[0], i) + n[1] * block_of(group.offset[1], i) + n[2] * block_of(group.offset[2], i);
        f.segment<block_size>(i * block_size) = along + at_nodes(n, m);
    }
    const double outer = a.radius * rounded_up;
    Lanes rest = group.rest_shift + outer * group.rest_turn;
    if (plane.rate != 0) {
        Lanes squared = Lanes::Zero();
        for (const auto& n : directions) squared += (n.tail<most_spans + 1>() - n.head<most_spans + 1>()).square();
        rest += squared.sqrt() * (0.25 * rounded_up) * (group.step_shift + outer * group.step_turn);
    }
    const Lanes nodes = f.head<most_spans + 1>();
    const Lanes next = f.tail<most_spans + 1>();
    // The sum of both ends is a NaN wherever one of them is, which the lesser of the two need not be.
    const Lanes spans = (nodes + next).isNaN().select(nodes + next, nodes.min(next));
    return {(spans - rest) * shrink_ - slack_, nodes * shrink_ - slack_};
}

SpanBounds RelativeSpans::of_boxes(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Piece& b,
                                   std::uint32_t wanted) const {
    return bounds(group, plane, a, wanted, [&](const Blocks& n, const Blocks& m) {
        Block f = dot(m, a.center) - dot(n, b.center);
        for (int k = 0; k < 3; ++k) f -= a.half_extent[k] * dot(m, a.axes.col(k)).abs() + b.half_extent[k] * dot(n, b.axes.col(k)).abs();
        return f;
    });
}

SpanBounds RelativeSpans::of_elements(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Corners& element_a,
                                      const Corners& element_b, std::uint32_t wanted) const {
    return bounds(group, plane, a, wanted, [&](const Blocks& n, const Blocks& m) {
        Block low = dot(m, element_a.x.col(0)), high = dot(n, element_b.x.col(0));
        for (int k = 1; k < 3; ++k) {
            low = low.min(dot(m, element_a.x.col(k)));
            high = high.max(dot(n, element_b.x.col(k)));
        }
        return Block(low - high);
    });
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
