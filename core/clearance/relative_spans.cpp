// SPDX-License-Identifier: MIT
#include "core/clearance/relative_spans.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/four.hpp"
#include "core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

// Four nodes at a time, which fit the registers; blocks without a wanted node are left out.
using base::Four;
using FourBits = long long __attribute__((vector_size(32)));
constexpr int block_size = base::lanes;
struct FourVectors {
    Four x, y, z;
};
static_assert((most_spans + 1) % block_size == 0);

[[gnu::always_inline]] inline void load(const Lanes& lanes, int block, Four& out) { base::load(lanes.data() + block * block_size, out); }
[[gnu::always_inline]] inline void dot(const FourVectors& n, const Vector3& v, Four& out) { out = v[0] * n.x + v[1] * n.y + v[2] * n.z; }
[[gnu::always_inline]] inline void subtract_magnitude(double factor, const FourVectors& n, const Vector3& v, Four& sum) {
    Four along;
    dot(n, v, along);
    sum -= factor * reinterpret_cast<Four>(reinterpret_cast<FourBits>(along) & std::numeric_limits<long long>::max());
}

// Functions at the nodes.
struct NodeFunctions {
    std::array<double, most_spans + 2> f{};                         // one more, so that each has a next one
    std::array<std::array<double, most_spans + 2>, 3> direction{};  // n_j, where it turns
};

struct NodesAt {
    const SpanGroup& group;
    const SpanMiddles* middles;  // or null
    const TurningPlane& plane;
    const Piece& a;
    std::uint32_t wanted;
    Vector3 here;  // the center of a's piece, at the plane's node
};

// A box against a box.
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

[[gnu::always_inline]] inline void find_least(const FourVectors& m, const Corners& corners, Four& out) {
    Four other;
    dot(m, corners.x.col(0), out);
    for (int k = 1; k < 3; ++k) {
        dot(m, corners.x.col(k), other);
        out = other < out ? other : out;
    }
}
[[gnu::always_inline]] inline void find_most(const FourVectors& n, const Corners& corners, Four& out) {
    Four other;
    dot(n, corners.x.col(0), out);
    for (int k = 1; k < 3; ++k) {
        dot(n, corners.x.col(k), other);
        out = other > out ? other : out;
    }
}

struct OfElements {
    const Corners &a, &b;

    [[gnu::always_inline]] inline void operator()(const FourVectors& n, const FourVectors& m, Four& out) const {
        Four low, high;
        find_least(m, a, low);
        find_most(n, b, high);
        out = low - high;
    }
};

// Pieces of several elements each: corners against corners.
struct OfPieces {
    std::span<const PieceElement> a, b;

    [[gnu::always_inline]] inline void operator()(const FourVectors& n, const FourVectors& m, Four& out) const {
        Four low, high, other;
        find_least(m, a[0].corners, low);
        for (const PieceElement& element : a.subspan(1)) {
            find_least(m, element.corners, other);
            low = other < low ? other : low;
        }
        find_most(n, b[0].corners, high);
        for (const PieceElement& element : b.subspan(1)) {
            find_most(n, element.corners, other);
            high = other > high ? other : high;
        }
        out = low - high;
    }
};

using Rotations = std::array<Four, 9>;

[[gnu::always_inline]] inline void load_pose(const std::array<Lanes, 9>& r, const std::array<Lanes, 3>& offset, int block,
                                             Rotations& rotation, FourVectors& p) {
    for (std::size_t k = 0; k < 9; ++k) load(r[k], block, rotation[k]);
    load(offset[0], block, p.x);
    load(offset[1], block, p.y);
    load(offset[2], block, p.z);
}

// n.p and what `support` makes of n and R^T n: f without the slack.
template <class Support>
[[gnu::always_inline]] inline void apart_along(const FourVectors& n, const Rotations& r, const FourVectors& p, const Support& support,
                                               Four& out) {
    const FourVectors m{n.x * r[0] + n.y * r[3] + n.z * r[6], n.x * r[1] + n.y * r[4] + n.z * r[7], n.x * r[2] + n.y * r[5] + n.z * r[8]};
    support(n, m, out);
    out = n.x * p.x + n.y * p.y + n.z * p.z + out;
}

// `at_nodes` is told n_j and R_j^T n_j: the rest of f_j, beside n_j.p_j.
template <class AtNodes>
[[gnu::always_inline]] inline void add_nodes(const NodesAt& at, const AtNodes& at_nodes, NodeFunctions& out) {
    for (int i = 0; i * block_size <= most_spans; ++i) {
        if ((at.wanted >> (i * block_size) & ((1U << block_size) - 1)) == 0) continue;
        Rotations rotation;
        FourVectors p;
        load_pose(at.group.rotation, at.group.offset, i, rotation, p);
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
        Four f;
        apart_along(n, rotation, p, at_nodes, f);
        std::memcpy(out.f.data() + i * block_size, &f, sizeof f);
    }
}

struct Rounding {
    double shrink, slack;
};

// Bounds the spans for points within `radius`; `turns`: do the planes turn?
[[gnu::always_inline]] inline void cover_spans(const SpanGroup& group, const NodeFunctions& found, bool turns, double radius,
                                               const Rounding& rounding, SpanBounds& out) {
    const double outer = radius * rounded_up;
    const auto next = [](const std::array<double, most_spans + 2>& x, int block, Four& after) __attribute__((always_inline)) {
        std::memcpy(&after, x.data() + block * block_size + 1, sizeof after);
    };
    for (int i = 0; i * block_size <= most_spans; ++i) {
        Four rest, turn, nodes, after;
        load(group.rest_shift, i, rest);
        load(group.rest_turn, i, turn);
        rest += outer * turn;
        if (turns) {
            Four squared = {0, 0, 0, 0}, shift;
            for (const auto& n : found.direction) {
                std::memcpy(&nodes, n.data() + i * block_size, sizeof nodes);
                next(n, i, after);
                squared += (after - nodes) * (after - nodes);
            }
            load(group.step_shift, i, shift);
            load(group.step_turn, i, turn);
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

// Raises the bounds of spans of one segment to those by their parabolas.
template <class AtNodes>
[[gnu::always_inline]] inline void cover_by_parabolas(const NodesAt& at, const NodeFunctions& found, const Rounding& rounding,
                                                      const AtNodes& at_nodes, SpanBounds& out) {
    const double outer = at.a.radius * rounded_up;
    const Four zero = {0, 0, 0, 0};
    for (int i = 0; i * block_size <= most_spans; ++i) {
        if ((at.wanted >> (i * block_size) & ((1U << block_size) - 1)) == 0) continue;
        Rotations rotation;
        FourVectors p;
        load_pose(at.middles->rotation, at.middles->offset, i, rotation, p);
        Four rest, turn;
        load(at.middles->rest_shift, i, rest);
        load(at.middles->rest_turn, i, turn);
        rest += outer * turn;
        FourVectors n{zero + at.plane.n[0], zero + at.plane.n[1], zero + at.plane.n[2]};
        Four turned = zero;
        if (at.plane.rate != 0) {
            std::array<Four*, 3> parts{&n.x, &n.y, &n.z};
            Four squared = zero, here, next, step, leaves;
            for (std::size_t k = 0; k < 3; ++k) {
                base::load(found.direction[k].data() + i * block_size, here);
                base::load(found.direction[k].data() + i * block_size + 1, next);
                *parts[k] = 0.5 * (here + next);
                squared += (next - here) * (next - here);
            }
            base::square_root(squared, turned);
            load(at.group.step_shift, i, step);
            load(at.group.step_turn, i, turn);
            step += outer * turn;
            load(at.group.rest_shift, i, leaves);
            load(at.group.rest_turn, i, turn);
            leaves += outer * turn;  // at least |g|/2
            turned *= (0.25 * rounded_up) * (0.5 * step + 2 * leaves);
        }
        Four middle, f, after;
        apart_along(n, rotation, p, at_nodes, middle);
        base::load(found.f.data() + i * block_size, f);
        base::load(found.f.data() + i * block_size + 1, after);
        Four least = f;
        base::take_smaller(after, least);
        base::take_smaller<Four>(0.5 * (least + middle) - turned, least);
        const Four spans = (least - rest) * rounding.shrink - rounding.slack;
        Four known;
        load(out.spans, i, known);
        known = spans > known ? spans : known;  // also a NaN's place: then the other bound is one
        std::memcpy(out.spans.data() + i * block_size, &known, sizeof known);
    }
}

template <class AtNodes>
[[gnu::always_inline]] inline void find_bounds(const NodesAt& at, const Rounding& rounding, const AtNodes& at_nodes, SpanBounds& out) {
    NodeFunctions found;
    add_nodes(at, at_nodes, found);
    cover_spans(at.group, found, at.plane.rate != 0, at.a.radius, rounding, out);
    if (at.middles != nullptr) cover_by_parabolas(at, found, rounding, at_nodes, out);
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

NodesAt nodes_at(const SpanGroup& group, const SpanMiddles* middles, const TurningPlane& plane, const Piece& a, std::uint32_t wanted) {
    const RelativePose at = group.at(plane.node);
    return {group, middles, plane, a, wanted, at.rotation * a.center + at.offset};
}

// How far points go from each node to the next one.
[[gnu::always_inline]] inline void find_steps(const std::array<std::array<double, most_spans + 2>, RelativeChain::entries>& nodes,
                                              SpanGroup& group) {
    for (int i = 0; i * block_size <= most_spans; ++i) {
        Four turn = {0, 0, 0, 0}, shift = {0, 0, 0, 0}, here, next;
        for (std::size_t k = 0; k < RelativeChain::entries; ++k) {
            base::load(nodes[k].data() + i * block_size, here);
            base::load(nodes[k].data() + i * block_size + 1, next);
            (k < 9 ? turn : shift) += (next - here) * (next - here);
        }
        for (int j = 0; j < block_size; ++j) {
            group.step_turn[i * block_size + j] = std::sqrt(turn[j]);
            group.step_shift[i * block_size + j] = std::sqrt(shift[j]);
        }
    }
}

[[gnu::always_inline]] inline void fill(const RelativeChain& chain, SpanGroup& group) {
    std::array<std::array<double, most_spans + 2>, RelativeChain::entries> nodes;
    for (std::size_t k = 0; k < RelativeChain::entries; ++k) {
        const double* values = chain.entry(static_cast<int>(k));
        if (group.length == 1) {
            std::memcpy(nodes[k].data(), values + group.first_segment, sizeof(Lanes));
        } else {
            for (int j = 0; j <= most_spans; ++j) nodes[k][j] = values[group.place_of(j)];
        }
        nodes[k].back() = nodes[k][most_spans];
        std::memcpy((k < 9 ? group.rotation[k] : group.offset[k - 9]).data(), nodes[k].data(), sizeof(Lanes));
    }
    find_steps(nodes, group);
    if (group.length == 1) {
        std::memcpy(group.rest_turn.data(), chain.rest_turns() + group.first_segment, sizeof(Lanes));
        std::memcpy(group.rest_shift.data(), chain.rest_shifts() + group.first_segment, sizeof(Lanes));
    } else {
        for (int j = 0; j < most_spans; ++j) {
            const Rest rest = j < group.count ? chain.rest_of_span(group.place_of(j), group.place_of(j + 1)) : Rest{};
            group.rest_turn[j] = rest.turn;
            group.rest_shift[j] = rest.shift;
        }
    }
    group.rest_turn[most_spans] = group.rest_shift[most_spans] = group.step_turn[most_spans] = group.step_shift[most_spans] = 0;
    for (Lanes* lengths : {&group.rest_turn, &group.rest_shift, &group.step_turn, &group.step_shift}) *lengths *= rounded_up;
}

void fill_middles(const RelativeChain& chain, const SpanGroup& group, SpanMiddles& out) {
    for (std::size_t k = 0; k < RelativeChain::entries; ++k) {
        Lanes& lanes = k < 9 ? out.rotation[k] : out.offset[k - 9];
        std::memcpy(lanes.data(), chain.middle(static_cast<int>(k)) + group.first_segment, sizeof lanes);
    }
    std::memcpy(out.rest_turn.data(), chain.parabola_rest_turns() + group.first_segment, sizeof(Lanes));
    std::memcpy(out.rest_shift.data(), chain.parabola_rest_shifts() + group.first_segment, sizeof(Lanes));
    for (Lanes* lengths : {&out.rest_turn, &out.rest_shift}) *lengths *= rounded_up;
}

FETTLE_WIDE void fill_wide(const RelativeChain& chain, SpanGroup& group) { fill(chain, group); }

}  // namespace

RelativePose SpanGroup::at(int j) const {
    RelativePose pose;
    for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < 3; ++k) pose.rotation(row, k) = rotation[3 * row + k][j];
        pose.offset[row] = offset[row][j];
    }
    return pose;
}

Separation separation(const RelativePose& at, const Piece& a, const Piece& b) {
    return box_separation(at.rotation * a.center + at.offset - b.center, at.rotation * a.axes, a.half_extent, b.axes, b.half_extent);
}

RelativeSpans::RelativeSpans(const std::vector<PairSegment>& segments, Frame frame, double radius_a, double radius_b) {
    const RelativeChain chain(segments, frame, radius_a, radius_b);
    radius_ = radius_a;
    const double norm = chain.base_norm();
    slack_ = (chain.rounding() + (norm * norm - 1 + 8 * unit_roundoff) * 2 * radius_b) * rounded_up + std::numeric_limits<double>::min();
    shrink_ = (1 - 8 * unit_roundoff) / norm;
    const int total = chain.segments();
    const auto groups_of = [](int spans) { return (spans + most_spans - 1) / most_spans; };
    int all = 1;
    for (int groups = groups_of(total); groups > 1; groups = groups_of(groups)) all += groups;
    groups_.reserve(all);
    middles_.reserve(groups_of(total));
    int begin = 0, spans = total, length = 1;  // spans of the level begin at this index, and last so many segments
    for (int level = 0;; ++level) {
        const int groups = groups_of(spans);
        for (int g = 0; g < groups; ++g) {
            SpanGroup& group = groups_.emplace_back();
            group.level = level;
            group.count = std::min(most_spans, spans - g * most_spans);
            group.first = begin + g * most_spans;
            group.first_segment = g * most_spans * length;
            group.length = length;
            group.segments = total;
            if (base::has_wide_instructions())
                fill_wide(chain, group);
            else
                fill(chain, group);
            if (level == 0) fill_middles(chain, group, middles_.emplace_back());
        }
        if (groups == 1) break;
        begin = count_of(groups_) - groups;
        spans = groups;
        length *= most_spans;
    }
}

SpanBounds RelativeSpans::of_boxes(const SpanGroup& group, const TurningPlane& plane, const Piece& a, const Piece& b,
                                   std::uint32_t wanted) const {
    return bounds(nodes_at(group, nullptr, plane, a, wanted), Rounding{shrink_, slack_}, OfBoxes{a, b});
}

SpanBounds RelativeSpans::of_elements(const SpanGroup& group, const TurningPlane& plane, const Piece& a,
                                      std::span<const PieceElement> elements_a, std::span<const PieceElement> elements_b,
                                      std::uint32_t wanted) const {
    const NodesAt at = nodes_at(group, middles(group), plane, a, wanted);
    if (elements_a.size() == 1 && elements_b.size() == 1)
        return bounds(at, Rounding{shrink_, slack_}, OfElements{elements_a[0].corners, elements_b[0].corners});
    return bounds(at, Rounding{shrink_, slack_}, OfPieces{elements_a, elements_b});
}

SpanBounds RelativeSpans::of_planes(const SpanGroup& group, const NodePlanes& planes) const {
    NodeFunctions found;
    for (std::size_t j = 0; j <= most_spans; ++j) {
        found.f[j] = planes.f[j];
        for (int k = 0; k < 3; ++k) found.direction[k][j] = planes.n[j][k];
    }
    SpanBounds out;
    cover_spans(group, found, true, radius_, {shrink_, slack_}, out);
    return out;
}

Frame better_frame(const std::vector<PairSegment>& segments, double radius_a, double radius_b) {
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
    return {as_frame_a < as_frame_b};
}

}  // namespace fettle::core::clearance
