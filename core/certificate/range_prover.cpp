// SPDX-License-Identifier: MIT
#include "core/certificate/range_prover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t few_region_points = 192;  // of more, their box stands for them in bounds of second order
constexpr std::size_t most_moves = 1 << 16;     // kept
constexpr double unit = 1 + 1e-8;               // above any power of |z| that is needed: linkage.hpp lets it be off 1 by 1e-9

IntervalMatrix product3(const IntervalMatrix& a, const IntervalMatrix& b) {
    IntervalMatrix out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    return out;
}

// exp([t]).
IntervalMatrix exponential(const Interval3& t) {
    const Interval z = square(t[0]) + square(t[1]) + square(t[2]), x = sqrt(z);
    const Interval a = sinc(x), b = Interval(0.5) * square(sinc(Interval(0.5) * x)), cosine = Interval(1) - z * b;
    const Interval3 at = a * t, bt = b * t;
    return {Interval3{cosine + bt[0] * t[0], bt[0] * t[1] - at[2], bt[0] * t[2] + at[1]},
            Interval3{bt[0] * t[1] + at[2], cosine + bt[1] * t[1], bt[1] * t[2] - at[0]},
            Interval3{bt[0] * t[2] - at[1], bt[1] * t[2] + at[0], cosine + bt[2] * t[2]}};
}

// The least f.X over the region, from below: over its box if it has many points and that is asked for, else over its points in doubles,
// whose rounding |X| bounds, and the functional's width with it.
double least_along(const Interval3& f, const Region& region, bool by_box) {
    if (by_box)
        return dot(f, {Interval(region.low.x(), region.high.x()), Interval(region.low.y(), region.high.y()),
                       Interval(region.low.z(), region.high.z())})
            .low;
    Vector3 middle;
    Interval3 width;
    for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (f[k].low + f[k].high);
        width[k] = Interval((f[k] - Interval(middle[k])).magnitude());
    }
    double low = std::numeric_limits<double>::infinity();
    for (const Vector3& x : region.points) {
        const double value = middle[0] * x[0] + middle[1] * x[1] + middle[2] * x[2];
        if (!(value >= low)) low = value;  // also what is no number
    }
    const Interval rounding = Interval(0x1p-49) * Interval(norm_bound(exactly(middle))) + Interval(norm_bound(width));
    return (Interval(low) - rounding * Interval(region.radius) - Interval(1e-290)).low;
}

}  // namespace

RangeProver::RangeProver(const Linkage& linkage, const LinkedPair& pair, const kinematics::Pose& start_a, const kinematics::Pose& start_b)
    : a_(side_of(linkage, pair, pair.a, start_a)),
      b_(side_of(linkage, pair, pair.b, start_b)),
      count_(count_of(pair.coordinates)),
      round_(linkage, pair, start_a, start_b) {
    for (std::size_t k = 0; k < pair.coordinates.size(); ++k) {
        const LinkageCoordinate& c = linkage.coordinates[pair.coordinates[k]];
        box_.low[k] = c.low;
        box_.high[k] = c.high;
    }
    for (const Side* side : {&a_, &b_}) {
        magnitude_ += side->start.position.norm() + side->start.rotation.norm();
        for (std::size_t j = 0; j < side->screws.size(); ++j) {
            const Screw& screw = side->screws[j];
            magnitude_ += screw.point.norm() + std::abs(screw.turn) + std::abs(screw.slide) + std::abs(side->starts[j]);
        }
    }
}

RangeProver::Side RangeProver::side_of(const Linkage& linkage, const LinkedPair& pair, const std::vector<Screw>& screws,
                                       const kinematics::Pose& start) {
    Side side{screws, {}, {}, start, {}};
    for (std::size_t j = 0; j < screws.size(); ++j) {
        const int coordinate = pair.coordinates[screws[j].coordinate];
        side.starts.push_back(linkage.coordinates[coordinate].start);
        Interval tilt = 0;
        for (std::size_t i = 0; i < j; ++i)
            if (screws[i].turn != 0)
                tilt = tilt + Interval(2 * unit) * Interval(norm_bound(cross(exactly(screws[i].axis), exactly(screws[j].axis))));
        side.tilt.push_back(tilt.high);
    }
    return side;
}

// x -> rotation x + place, of the screw alone.
const RangeProver::Placement& RangeProver::move(Side& side, std::size_t screw, double value) {
    if (side.moves.size() > most_moves) side.moves.clear();
    const auto [found, is_new] = side.moves.try_emplace({screw, value});
    if (!is_new) return found->second;
    const Screw& s = side.screws[screw];
    const Interval d = Interval(value) - Interval(side.starts[screw]);
    const Interval3 axis = exactly(s.axis), point = exactly(s.point);
    Placement& out = found->second;
    out.rotation = exponential((Interval(s.turn) * d) * axis);
    out.place = point - times(out.rotation, point) + (Interval(s.slide) * d) * axis;
    return out;
}

// The body by the screws from `first` on.
RangeProver::Placement RangeProver::after(Side& side, std::size_t first, const Coordinates& at) {
    Placement out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out.rotation[i][j] = Interval(side.start.rotation(i, j));
    out.place = exactly(side.start.position);
    for (std::size_t j = side.screws.size(); j-- > first;) {
        const Placement& by = move(side, j, at[side.screws[j].coordinate]);
        out = {product3(by.rotation, out.rotation), times(by.rotation, out.place) + by.place};
    }
    return out;
}

// r_j over the box: upper bounds.
std::vector<double> RangeProver::radii(Side& side, const Region& region, const CoordinateBox& box) {
    const std::size_t count = side.screws.size();
    Coordinates center{};
    for (std::size_t k = 0; k < center.size(); ++k) center[k] = 0.5 * (box.low[k] + box.high[k]);
    std::vector<double> out(count);
    Interval moved = 0;
    for (std::size_t j = count; j-- > 0;) {
        const Screw& screw = side.screws[j];
        const Placement inner = after(side, j + 1, center);
        const Interval3 axis = exactly(screw.axis), point = exactly(screw.point);
        const auto distance = [&](const Interval3& X) { return norm_bound(cross(axis, times(inner.rotation, X) + inner.place - point)); };
        double most = 0;
        if (region.points.size() <= few_region_points) {
            for (const Vector3& x : region.points) most = std::max(most, distance(exactly(x)));
        } else {
            most = distance({Interval(region.low.x(), region.high.x()), Interval(region.low.y(), region.high.y()),
                             Interval(region.low.z(), region.high.z())});
        }
        const Interval radius = Interval(most) + moved;
        out[j] = radius.high;
        const auto k = static_cast<std::size_t>(screw.coordinate);
        const Interval half(
            std::max((Interval(box.high[k]) - Interval(center[k])).high, (Interval(center[k]) - Interval(box.low[k])).high));
        const Interval turn = Interval(std::abs(screw.turn)) * half;
        moved = moved + Interval(std::min(turn.high, 2.0) * unit) * Interval(radius.high) + Interval(std::abs(screw.slide)) * half;
    }
    return out;
}

void RangeProver::add_losses(Side& side, const Region& region, const CoordinateBox& box, std::span<const Vector3> normals,
                             Losses& losses) const {
    const std::vector<double> r = radii(side, region, box);
    double length = 0;
    for (const Vector3& n : normals) length = std::max(length, norm_bound(exactly(n)));
    for (std::size_t j = 0; j < side.screws.size(); ++j) {
        const Screw& screw = side.screws[j];
        const auto k = static_cast<std::size_t>(screw.coordinate);
        const Interval half = Interval(0.5) * (Interval(box.high[k]) - Interval(box.low[k])), turn = Interval(std::abs(screw.turn)) * half;
        const Interval slide = Interval(std::abs(screw.slide)) * half, speed = turn * Interval(r[j]) + slide;
        double across = 0, change = 0;
        for (const Vector3& n : normals) across = std::max(across, norm_bound(cross(exactly(n), exactly(screw.axis))));
        across = std::min((Interval(across) + Interval(side.tilt[j]) * Interval(length)).high, (Interval(length) * Interval(unit)).high);
        for (std::size_t c = 0; normals.size() > 1 && c < normals.size(); ++c)
            if ((c >> k & 1) == 0) change = std::max(change, norm_bound(exactly(normals[c | std::size_t{1} << k]) - exactly(normals[c])));
        Interval loss = Interval(0.5) * (square(turn) * Interval(r[j]) * Interval(across) + Interval(change) * speed);
        for (std::size_t i = 0; i < j; ++i)
            if (side.screws[i].coordinate == screw.coordinate)
                loss = loss + Interval(length) * Interval(std::abs(side.screws[i].turn)) * half * speed;
        loss = Interval(unit) * loss;
        losses.along[k] = (Interval(losses.along[k]) + loss).high;
        losses.total = (Interval(losses.total) + loss).high;
    }
}

RangeProver::Losses RangeProver::losses(const Region& a, const Region& b, const CoordinateBox& box, std::span<const Vector3> normals) {
    Losses out;
    add_losses(a_, a, box, normals, out);
    add_losses(b_, b, box, normals, out);
    return out;
}

// Is n.(x_a - x_b) at least that at every corner of the box?
bool RangeProver::is_above(const Region& a, const Region& b, const CoordinateBox& box, std::span<const Vector3> normals, double wanted) {
    const auto n = static_cast<std::size_t>(count_);
    const bool many_a = a.points.size() > few_region_points, many_b = b.points.size() > few_region_points;
    Coordinates at{};
    for (std::size_t c = 0; c < std::size_t{1} << n; ++c) {
        for (std::size_t k = 0; k < n; ++k) at[k] = (c >> k & 1) != 0 ? box.high[k] : box.low[k];
        const Interval3 normal = exactly(normals[normals.size() == 1 ? 0 : c]);
        const Placement place_a = after(a_, 0, at), place_b = after(b_, 0, at);
        const Interval3 of_a = transposed_times(place_a.rotation, normal), of_b = transposed_times(place_b.rotation, normal);
        const Interval3 from_b{-of_b[0], -of_b[1], -of_b[2]};
        const Interval offset = dot(normal, place_a.place - place_b.place);
        const auto apart = [&](bool box_a, bool box_b) {
            return (Interval(least_along(of_a, a, box_a)) + Interval(least_along(from_b, b, box_b)) + offset).low;
        };
        if (((many_a || many_b) && apart(many_a, many_b) >= wanted) || apart(false, false) >= wanted) continue;
        return false;
    }
    return true;
}

bool RangeProver::is_usable(const Region& a, const Region& b) const {
    return magnitude_ < base::largest_magnitude && a.radius < base::largest_magnitude && b.radius < base::largest_magnitude;
}

long RangeProver::prove_round(const Region& a, const Region& b, const CoordinateBox& part, const Vector3& m, double lower) {
    return is_usable(a, b) && round_.prove(a, b, part, m, lower) ? 1 : 0;
}

long RangeProver::prove(const Region& a, const Region& b, const CoordinateBox& box, std::span<const Vector3> normals, double lower,
                        int halvings) {
    const std::size_t corners = std::size_t{1} << count_;
    if (normals.size() != 1 && normals.size() != corners) return 0;
    if (!is_usable(a, b)) return 0;
    double length = 0;
    for (const Vector3& normal : normals) {
        if (!normal.allFinite()) return 0;
        length = std::max(length, norm_bound(exactly(normal)));
    }
    if (!(length > 1e-6 && length < 1e6)) return 0;
    const Losses lost = losses(a, b, box, normals);
    const double wanted = (Interval(lower) * Interval(length) + Interval(lost.total)).high;
    if (is_above(a, b, box, normals, wanted)) return 1;
    if (halvings == 0 || count_ == 0) return 0;
    const auto k = static_cast<std::size_t>(std::max_element(lost.along.begin(), lost.along.end()) - lost.along.begin());
    const double middle = 0.5 * (box.low[k] + box.high[k]);
    if (!(lost.along[k] > 0) || !(box.low[k] < middle && middle < box.high[k])) return 0;
    CoordinateBox first = box, second = box;
    first.high[k] = second.low[k] = middle;
    std::vector<Vector3> of_first(normals.begin(), normals.end()), of_second = of_first;
    for (std::size_t c = 0; normals.size() > 1 && c < corners; ++c) {
        const std::size_t pair = c ^ std::size_t{1} << k;
        const Vector3 between = 0.5 * normals[c] + 0.5 * normals[pair];
        ((c >> k & 1) != 0 ? of_first : of_second)[c] = between;
    }
    const long parts = prove(a, b, first, of_first, lower, halvings - 1);
    if (parts == 0) return 0;
    const long others = prove(a, b, second, of_second, lower, halvings - 1);
    return others == 0 ? 0 : parts + others;
}

Interval RangeProver::distance_at(const Interval3& X_a, const Interval3& X_b, const Coordinates& at) {
    const Placement a = after(a_, 0, at), b = after(b_, 0, at);
    const Interval3 d = (times(a.rotation, X_a) - times(b.rotation, X_b)) + (a.place - b.place);
    return sqrt(square(d[0]) + square(d[1]) + square(d[2]));
}

double RangeProver::witness_room(const Interval3& X_a, const Interval3& X_b) const {
    double turned = 1;
    for (std::size_t k = 0; k < box_.low.size(); ++k) turned += std::abs(box_.high[k] - box_.low[k]);
    const double size = norm_bound(X_a) + norm_bound(X_b) + magnitude_;
    return 1e-11 * size * turned * (1 + magnitude_) + 1e-300;
}

}  // namespace fettle::core::certificate
