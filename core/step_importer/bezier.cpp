// SPDX-License-Identifier: MIT
#include "core/step_importer/bezier.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace fettle::core::step_importer {
namespace {

using Poles = std::vector<Pole>;

constexpr double least_share = 1e-3;  // of a piece: what is divided by its square stays far from rounding

/// The poles of the same curve over [a, b] of [0, 1], by de Casteljau's algorithm at both ends. @param stride between neighbours
void restrict_to(Pole* poles, int degree, int stride, double a, double b) {
    const auto at = [&](int i) -> Pole& { return poles[i * stride]; };
    if (b < 1)
        for (int level = 1; level <= degree; ++level)
            for (int i = degree; i >= level; --i) at(i) = (1 - b) * at(i - 1) + b * at(i);
    const double s = b > 0 ? a / b : 0;
    if (s > 0)
        for (int level = 1; level <= degree; ++level)
            for (int i = 0; i + level <= degree; ++i) at(i) = (1 - s) * at(i) + s * at(i + 1);
}

/// The part of [from, to] that lies in [low, high], as shares of that, at least least_share of it long.
std::pair<double, double> share(double from, double to, double low, double high) {
    const double length = high - low;
    double a = std::clamp((from - low) / length, 0.0, 1.0), b = std::clamp((to - low) / length, 0.0, 1.0);
    if (b - a >= least_share) return {a, b};
    a = std::clamp((a + b - least_share) / 2, 0.0, 1 - least_share);
    return {a, a + least_share};
}

double norm(const Pole& pole) { return pole.head<3>().norm(); }

/// Moves the origin to the middle of the net, so that what weights multiply is small. @return the largest distance from there, of S
double centre(Poles& poles) {
    Eigen::Vector3d low = poles[0].head<3>() / poles[0][3], high = low;
    for (const Pole& pole : poles) {
        low = low.cwiseMin(pole.head<3>() / pole[3]);
        high = high.cwiseMax(pole.head<3>() / pole[3]);
    }
    const Eigen::Vector3d middle = (low + high) / 2;
    double reach = 0;
    for (Pole& pole : poles) {
        pole.head<3>() -= pole[3] * middle;
        reach = std::max(reach, norm(pole) / pole[3]);
    }
    return reach;
}

double least_weight(const Poles& poles) {
    double least = poles[0][3];
    for (const Pole& pole : poles) least = std::min(least, pole[3]);
    return least;
}

/// Largest norm of differences of the net in places and in weights.
struct Net {
    double place = 0, weight = 0;
    void add(const Pole& difference, double factor) {
        place = std::max(place, factor * norm(difference));
        weight = std::max(weight, factor * std::abs(difference[3]));
    }
};

/// Across the joint of two nets of one row each, `degree` and lengths: the net of the difference of derivatives.
Pole derivative_jump(const Pole& before_last, const Pole& last, const Pole& first, const Pole& second, int degree_a, double length_a,
                     int degree_b, double length_b) {
    return degree_b / length_b * (second - first) - degree_a / length_a * (last - before_last);
}

CurveSuprema over_piece(const BezierCurve& piece, double from, double to) {
    const int degree = static_cast<int>(piece.poles.size()) - 1;
    const auto [a, b] = share(from, to, piece.from, piece.to);
    Poles poles = piece.poles;
    restrict_to(poles.data(), degree, 1, a, b);
    const double reach = centre(poles), weight = least_weight(poles), length = (b - a) * (piece.to - piece.from);
    Net d1, d2;
    for (int i = 0; i < degree; ++i) d1.add(poles[i + 1] - poles[i], degree);
    for (int i = 0; i + 1 < degree; ++i) d2.add(poles[i + 2] - 2 * poles[i + 1] + poles[i], degree * (degree - 1.0));
    CurveSuprema out;
    out.first = (d1.place + d1.weight * reach) / weight;
    out.second = (d2.place + 2 * d1.weight * out.first + d2.weight * reach) / weight / (length * length);
    out.first /= length;
    return out;
}

/// A bound of |N_t+ - N_t- - (W_t+ - W_t-) S| / W over a joint whose common poles are `row`.
double jump_bound(const Poles& differences, const Poles& row) {
    double most = 0, weight = least_weight(row), reach = 0;
    Eigen::Vector3d middle = row[0].head<3>() / row[0][3];
    for (const Pole& pole : row) reach = std::max(reach, (pole.head<3>() / pole[3] - middle).norm());
    for (const Pole& d : differences) most = std::max(most, (d.head<3>() - d[3] * middle).norm() + std::abs(d[3]) * reach);
    return most / weight;
}

SurfaceSuprema over_patch(const BezierPatch& piece, double u0, double u1, double v0, double v1) {
    const int p = piece.u_degree, q = piece.v_degree, stride = q + 1;
    const auto [a, b] = share(u0, u1, piece.u0, piece.u1);
    const auto [c, d] = share(v0, v1, piece.v0, piece.v1);
    Poles poles = piece.poles;
    for (int j = 0; j <= q; ++j) restrict_to(poles.data() + j, p, stride, a, b);
    for (int i = 0; i <= p; ++i) restrict_to(poles.data() + i * stride, q, 1, c, d);
    const double reach = centre(poles), weight = least_weight(poles);
    const double du = (b - a) * (piece.u1 - piece.u0), dv = (d - c) * (piece.v1 - piece.v0);
    const auto at = [&](int i, int j) -> const Pole& { return poles[i * stride + j]; };
    Net u, v, uu, uv, vv;
    for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
            if (i < p) u.add(at(i + 1, j) - at(i, j), p);
            if (j < q) v.add(at(i, j + 1) - at(i, j), q);
            if (i + 1 < p) uu.add(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j), p * (p - 1.0));
            if (j + 1 < q) vv.add(at(i, j + 2) - 2 * at(i, j + 1) + at(i, j), q * (q - 1.0));
            if (i < p && j < q) uv.add(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j), double(p) * q);
        }
    }
    SurfaceSuprema out;
    out.u = (u.place + u.weight * reach) / weight;
    out.v = (v.place + v.weight * reach) / weight;
    out.uu = (uu.place + 2 * u.weight * out.u + uu.weight * reach) / weight / (du * du);
    out.vv = (vv.place + 2 * v.weight * out.v + vv.weight * reach) / weight / (dv * dv);
    out.uv = (uv.place + u.weight * out.v + v.weight * out.u + uv.weight * reach) / weight / (du * dv);
    out.u /= du;
    out.v /= dv;
    return out;
}

/// The jump of S_u across the line where `b` follows `a` in u, or of S_v in v, along all of it.
double patch_jump(const BezierPatch& a, const BezierPatch& b, bool in_u) {
    const int along = in_u ? a.v_degree : a.u_degree, stride_a = a.v_degree + 1, stride_b = b.v_degree + 1;
    Poles differences, row;
    for (int k = 0; k <= along; ++k) {
        const int last = in_u ? a.u_degree * stride_a + k : k * stride_a + a.v_degree, before = last - (in_u ? stride_a : 1),
                  first = in_u ? k : k * stride_b, second = first + (in_u ? stride_b : 1);
        differences.push_back(in_u ? derivative_jump(a.poles[before], a.poles[last], b.poles[first], b.poles[second], a.u_degree,
                                                     a.u1 - a.u0, b.u_degree, b.u1 - b.u0)
                                   : derivative_jump(a.poles[before], a.poles[last], b.poles[first], b.poles[second], a.v_degree,
                                                     a.v1 - a.v0, b.v_degree, b.v1 - b.v0));
        row.push_back(b.poles[first]);
    }
    return jump_bound(differences, row);
}

/// A range within [low, high] of a closed parameter: once round or over its end, all of it.
std::pair<double, double> reduced(double from, double to, double low, double high, double period) {
    if (period <= 0) return {from, to};
    const double shift = period * std::floor((from - low) / period);
    if (to - shift > high * (1 + 1e-15) + 1e-300) return {low, high};
    return {from - shift, to - shift};
}

}  // namespace

CurveSuprema suprema(const std::vector<BezierCurve>& pieces, double from, double to) {
    from = std::clamp(from, pieces.front().from, pieces.back().to);
    to = std::clamp(to, pieces.front().from, pieces.back().to);
    CurveSuprema out;
    const auto take = [&](const BezierCurve& piece) {
        const CurveSuprema one = over_piece(piece, from, to);
        out.first = std::max(out.first, one.first);
        out.second = std::max(out.second, one.second);
    };
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const BezierCurve& piece = pieces[k];
        if (piece.from <= to && from <= piece.to) take(piece);
        if (k == 0 || !(from < piece.from && piece.from < to)) continue;
        const Poles &a = pieces[k - 1].poles, &b = piece.poles;
        out.jump +=
            jump_bound({derivative_jump(a[a.size() - 2], a.back(), b[0], b[1], static_cast<int>(a.size()) - 1,
                                        pieces[k - 1].to - pieces[k - 1].from, static_cast<int>(b.size()) - 1, piece.to - piece.from)},
                       {b[0]});
    }
    return out;
}

SurfaceSuprema suprema(const PatchGrid& grid, double u0, double u1, double v0, double v1) {
    const BezierPatch &first = grid.pieces.front(), &last = grid.pieces.back();
    std::tie(u0, u1) = reduced(u0, u1, first.u0, last.u1, grid.u_period);
    std::tie(v0, v1) = reduced(v0, v1, first.v0, last.v1, grid.v_period);
    u0 = std::clamp(u0, first.u0, last.u1), u1 = std::clamp(u1, first.u0, last.u1);
    v0 = std::clamp(v0, first.v0, last.v1), v1 = std::clamp(v1, first.v0, last.v1);
    SurfaceSuprema out;
    const int count = static_cast<int>(grid.pieces.size()), columns = grid.v_count;
    // Jumps are summed over lines, and are each the largest of the pieces along the line.
    std::vector<double> jumps_u(count / columns, 0), jumps_v(columns, 0);
    for (int k = 0; k < count; ++k) {
        const BezierPatch& piece = grid.pieces[k];
        if (piece.u0 > u1 || piece.u1 < u0 || piece.v0 > v1 || piece.v1 < v0) continue;
        const SurfaceSuprema one = over_patch(piece, u0, u1, v0, v1);
        out.u = std::max(out.u, one.u), out.v = std::max(out.v, one.v);
        out.uu = std::max(out.uu, one.uu), out.uv = std::max(out.uv, one.uv), out.vv = std::max(out.vv, one.vv);
        const int i = k / columns, j = k % columns;
        if (i > 0 && u0 < piece.u0 && piece.u0 < u1) jumps_u[i] = std::max(jumps_u[i], patch_jump(grid.pieces[k - columns], piece, true));
        if (j > 0 && v0 < piece.v0 && piece.v0 < v1) jumps_v[j] = std::max(jumps_v[j], patch_jump(grid.pieces[k - 1], piece, false));
    }
    for (const double jump : jumps_u) out.jump_u += jump;
    for (const double jump : jumps_v) out.jump_v += jump;
    // Over the end of a closed parameter there is a joint that is not between neighbours of the list.
    if (grid.u_period > 0 && u0 == first.u0 && u1 == last.u1) out.jump_u += 2 * out.u;
    if (grid.v_period > 0 && v0 == first.v0 && v1 == last.v1) out.jump_v += 2 * out.v;
    return out;
}

}  // namespace fettle::core::step_importer
