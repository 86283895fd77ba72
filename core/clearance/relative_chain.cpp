// SPDX-License-Identifier: MIT
#include "core/clearance/relative_chain.hpp"

#include <algorithm>
#include <array>

#include "core/base/contract.hpp"
#include "core/base/four.hpp"
#include "core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

// Lanes are consecutive segments.
using base::Four;
using base::lanes;
using base::load;
using base::store;
using base::take_larger;
using Vectors = std::array<Four, 3>;
using Poses = std::array<Four, 12>;  // as they are stored: the rotation column by column, the position
using RelativePoses = std::array<Four, RelativeChain::entries>;

struct Rests {
    Four turn, shift;
};

using Bodies = std::array<const BodySegment*, lanes>;

// `get` of a body's segment.
template <class Get>
[[gnu::always_inline]] inline void gather(const Bodies& bodies, const Get& get, Four& out) {
    out = Four{get(*bodies[0]), get(*bodies[1]), get(*bodies[2]), get(*bodies[3])};
}

// `instant`: 0, 1, 2 for s = 0, 1/2, 1.
[[gnu::always_inline]] inline void gather_poses(const Bodies& bodies, std::size_t instant, Poses& out) {
    std::array<const kinematics::Pose*, lanes> poses;
    for (std::size_t j = 0; j < lanes; ++j) poses[j] = &bodies[j]->poses[instant];
    base::gather(poses, out);
}

[[gnu::always_inline]] inline void find_norm(const Vectors& x, Four& out) {
    base::square_root(x[0] * x[0] + x[1] * x[1] + x[2] * x[2], out);
}

// `apart`: q_a - q_b.
[[gnu::always_inline]] inline void find_relative(const Poses& a, const Poses& b, const Vectors& apart, RelativePoses& out) {
    for (std::size_t r = 0; r < 3; ++r) {
        const Four &x = b[3 * r], &y = b[3 * r + 1], &z = b[3 * r + 2];
        for (std::size_t k = 0; k < 3; ++k) out[3 * r + k] = x * a[3 * k] + (y * a[3 * k + 1] + z * a[3 * k + 2]);
        out[9 + r] = x * apart[0] + (y * apart[1] + z * apart[2]);
    }
}

// Norms of what `difference` gives for each entry.
template <class Difference>
[[gnu::always_inline]] inline void find_norms(const Difference& difference, Rests& out) {
    Four turn = {0, 0, 0, 0}, shift = {0, 0, 0, 0}, here;
    for (std::size_t k = 0; k < 9; ++k) {
        difference(k, here);
        turn += here * here;
    }
    for (std::size_t k = 9; k < RelativeChain::entries; ++k) {
        difference(k, here);
        shift += here * here;
    }
    base::square_root(turn, out.turn);
    base::square_root(shift, out.shift);
}

}  // namespace

// Finds where four consecutive segments begin at a time, and how far they leave their chords.
struct RelativeChain::Block {
    RelativeChain& chain;
    const std::vector<PairSegment>& segments;
    Frame frame;
    double radius_sum;
    Four rounding = {0, 0, 0, 0}, base_norm = {1, 1, 1, 1};

    // From the last segments on, so that the node behind some is there.
    [[gnu::always_inline]] inline void find_all() {
        for (int first = (chain.segments_ - 1) / lanes * lanes; first >= 0; first -= lanes) find(first);
    }
    FETTLE_WIDE void find_all_wide() { find_all(); }

private:
    [[gnu::always_inline]] inline void find(int first) {
        Bodies a, b;
        for (int j = 0; j < lanes; ++j) {
            const PairSegment& segment = segments[std::min(first + j, chain.segments_ - 1)];
            a[j] = &frame.moving(segment);
            b[j] = &frame.fixed(segment);
        }
        std::array<RelativePoses, 3> at;
        Four reach = {0, 0, 0, 0}, norm;
        for (std::size_t i = 0; i < 3; ++i) {
            Poses of_a, of_b;
            gather_poses(a, i, of_a);
            gather_poses(b, i, of_b);
            const Vectors apart{of_a[9] - of_b[9], of_a[10] - of_b[10], of_a[11] - of_b[11]};
            find_relative(of_a, of_b, apart, at[i]);
            if (i == 1) continue;
            find_norm(apart, norm);
            take_larger(norm, reach);
        }
        reach *= rounded_up;  // an upper bound of |q_a - q_b|
        keep(first, at[0], at[2]);
        for (std::size_t k = 0; k < entries; ++k)
            store(2 * at[1][k] - 0.5 * (at[0][k] + at[2][k]), chain.row(entries + static_cast<int>(k)) + first);
        Rests rest, jump;
        find_norms(
            [&](std::size_t k, Four & out) __attribute__((always_inline)) { out = 2 * at[1][k] - at[0][k] - at[2][k]; }, rest);
        find_norms(
            [&](std::size_t k, Four & out) __attribute__((always_inline)) {
                load(chain.row(static_cast<int>(k)) + first + 1, out);
                out = at[2][k] - out;
            },
            jump);
        add_rests(first, a, b, reach, rest, jump);
    }

    [[gnu::always_inline]] inline void keep(int first, const RelativePoses& start, const RelativePoses& end) {
        for (int k = 0; k < entries; ++k) {
            double* values = chain.row(k);
            store(start[k], values + first);
            if (first + lanes < chain.segments_) continue;
            const double last = end[k][lanes - 1];
            std::fill(values + chain.segments_, values + chain.length_, last);
        }
    }

    [[gnu::always_inline]] inline void add_rests(int first, const Bodies& a, const Bodies& b, const Four& reach, const Rests& rest,
                                                 const Rests& jump) {
        const auto of_both = [&](const auto& get, Four& of_a, Four& of_b) __attribute__((always_inline)) {
            gather(a, get, of_a);
            gather(b, get, of_b);
        };
        Four wa, wb, norm_a, norm_b, rounding_a, rounding_b, extent_a, extent_b, travel;
        of_both([](const BodySegment& s) { return s.speed; }, wa, wb);
        of_both([](const BodySegment& s) { return s.base_norm; }, norm_a, norm_b);
        of_both([](const BodySegment& s) { return s.rounding; }, rounding_a, rounding_b);
        of_both([](const BodySegment& s) { return s.extent; }, extent_a, extent_b);
        Vectors step;
        for (std::size_t k = 0; k < 3; ++k) {
            Four of_a, of_b;
            of_both([k](const BodySegment& s) { return s.path.position_step.data()[k]; }, of_a, of_b);
            step[k] = of_a - of_b;
        }
        find_norm(step, travel);
        const Four w = wa + wb;
        const Four third_turn = w * w * w * norm_a, third_shift = wb * wb * (wb * reach + 3 * travel);
        const Four beside_turn = norm_b * third_turn / 124 + jump.turn, beside_shift = norm_b * third_shift / 124 + jump.shift;
        store(0.5 * rest.turn + beside_turn, chain.row(2 * entries) + first);
        store(0.5 * rest.shift + beside_shift, chain.row(2 * entries + 1) + first);
        store(beside_turn, chain.row(2 * entries + 2) + first);
        store(beside_shift, chain.row(2 * entries + 3) + first);
        const Four size = 2 * radius_sum + reach;
        take_larger<Four>(
            8 * (norm_a * norm_b) * ((rounding_a + rounding_b + 64 * unit_roundoff) * size + 8 * unit_roundoff * (extent_a + extent_b)),
            rounding);
        take_larger(norm_b, base_norm);
    }
};

namespace {

[[gnu::always_inline]] inline void find_rest(const RelativeChain& chain, int first, int last, Rest& out) {
    const Four zero = {0, 0, 0, 0};
    Rests own = {zero, zero}, off = {zero, zero};
    for (int i = first; i < last; i += lanes) {
        const Four index = {static_cast<double>(i), static_cast<double>(i + 1), static_cast<double>(i + 2), static_cast<double>(i + 3)};
        const Four s = (index - first) / static_cast<double>(last - first);
        Rests here;
        find_norms(
            [&](std::size_t k, Four & difference) __attribute__((always_inline)) {
                const double* values = chain.entry(static_cast<int>(k));
                load(values + i, difference);
                difference = (1 - s) * values[first] + s * values[last] - difference;
            },
            here);
        const auto is_inside = index < static_cast<double>(last);
        take_larger<Four>(is_inside ? here.turn : zero, off.turn);
        take_larger<Four>(is_inside ? here.shift : zero, off.shift);
        load(chain.rest_turns() + i, here.turn);
        load(chain.rest_shifts() + i, here.shift);
        take_larger<Four>(is_inside ? here.turn : zero, own.turn);
        take_larger<Four>(is_inside ? here.shift : zero, own.shift);
    }
    out = {};
    Rest beside;
    for (int j = 0; j < lanes; ++j) {
        take_larger<double>(own.turn[j], out.turn);
        take_larger<double>(own.shift[j], out.shift);
        take_larger<double>(off.turn[j], beside.turn);
        take_larger<double>(off.shift[j], beside.shift);
    }
    out = {out.turn + beside.turn, out.shift + beside.shift};
}

FETTLE_WIDE void find_rest_wide(const RelativeChain& chain, int first, int last, Rest& out) { find_rest(chain, first, last, out); }

}  // namespace

RelativeChain::RelativeChain(const std::vector<PairSegment>& segments, Frame frame, double radius_a, double radius_b)
    : segments_(count_of(segments)),
      length_(segments.size() + 1 + padding),
      values_(std::make_unique_for_overwrite<double[]>(rows * length_)) {
    FETTLE_ASSERT(!segments.empty(), "a chain of no segments");
    Block block{*this, segments, frame, radius_a + radius_b};
    if (base::has_wide_instructions())
        block.find_all_wide();
    else
        block.find_all();
    for (int i = entries; i < rows; ++i) std::fill(row(i) + segments_, row(i) + length_, 0);
    for (int j = 0; j < lanes; ++j) {
        take_larger<double>(block.rounding[j], rounding_);
        take_larger<double>(block.base_norm[j], base_norm_);
    }
}

Rest RelativeChain::rest_of_span(int first, int last) const {
    Rest rest;
    if (base::has_wide_instructions())
        find_rest_wide(*this, first, last, rest);
    else
        find_rest(*this, first, last, rest);
    return rest;
}

}  // namespace fettle::core::clearance
