// SPDX-License-Identifier: MIT
#include "core/ccd/placed_body.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/float_rounding.hpp"
#include "core/base/four.hpp"

namespace fettle::core::ccd {
namespace {

using base::Four;
using Columns = std::array<std::array<double, 4>, 4>;

#define FETTLE_INLINE [[gnu::always_inline]] inline

// To floats that are no more.
FETTLE_INLINE void store_below(const Four& x, float* to) {
    using FourFloats = float __attribute__((vector_size(16)));
    Four size;
    base::magnitude(x, size);
    const FourFloats below = __builtin_convertvector(x - (size * base::float_room_relative + base::float_room_absolute), FourFloats);
    std::memcpy(to, &below, sizeof below);
}

// The place of a point: columns * x + offset.
FETTLE_INLINE void put(const Columns& columns, const Four& x, Four& out) {
    base::load(columns[3].data(), out);
    for (std::size_t k = 0; k < 3; ++k) {
        Four column;
        base::load(columns[k].data(), column);
        out += column * x[static_cast<int>(k)];
    }
}

// Half the extents of a box that holds a turned box.
FETTLE_INLINE void turn_box(const Columns& columns, const Four& half, Four& out) {
    out = Four{0, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        Four column, size;
        base::load(columns[k].data(), column);
        base::magnitude(column, size);
        out += size * half[static_cast<int>(k)];
    }
}

// A box in its body's frame, and the boxes that it fills.
struct BoxAt {
    Four center, half;
    double loss;
    float *own_low, *own_minus_high, *other_low, *other_minus_high;
};

FETTLE_INLINE void place_both(const std::array<Columns, 2>& seen, const BoxAt& box) {
    store_below(box.center - box.half, box.own_low);
    store_below(-box.center - box.half, box.own_minus_high);
    Four start, end, half_start, half_end;
    put(seen[0], box.center, start);
    put(seen[1], box.center, end);
    turn_box(seen[0], box.half, half_start);
    turn_box(seen[1], box.half, half_end);
    const Four low_start = start - half_start, low_end = end - half_end, high_start = -start - half_start, high_end = -end - half_end;
    store_below((low_start < low_end ? low_start : low_end) - box.loss, box.other_low);
    store_below((high_start < high_end ? high_start : high_end) - box.loss, box.other_minus_high);
}
FETTLE_WIDE void place_both_wide(const std::array<Columns, 2>& seen, const BoxAt& box) { place_both(seen, box); }

// A point.
struct PointAt {
    Four center;
    double loss;
    SweptVertex* x;
    float *own_low, *own_minus_high, *other_low, *other_minus_high;
};

FETTLE_INLINE void place_point(const std::array<Columns, 2>& seen, const std::array<Columns, 2>& placed, const PointAt& point) {
    store_below(point.center, point.own_low);
    store_below(-point.center, point.own_minus_high);
    Four start, end;
    put(seen[0], point.center, start);
    put(seen[1], point.center, end);
    store_below((start < end ? start : end) - point.loss, point.other_low);
    store_below((start < end ? -end : -start) - point.loss, point.other_minus_high);
    put(placed[0], point.center, start);
    put(placed[1], point.center, end);
    std::memcpy(point.x->data(), &start, 3 * sizeof(double));
    std::memcpy(point.x->data() + 3, &end, 3 * sizeof(double));
}
FETTLE_WIDE void place_point_wide(const std::array<Columns, 2>& seen, const std::array<Columns, 2>& placed, const PointAt& point) {
    place_point(seen, placed, point);
}

#undef FETTLE_INLINE

}  // namespace

PlacedBody::Placing PlacedBody::placing(const Matrix3& rotation, const Vector3& offset) {
    Placing out{};
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = k < 3 ? rotation(i, k) : offset[i];
    return out;
}

void PlacedBody::start(const SweptBody& body, const SeenMotion& seen, bool is_first, const std::array<Vector3, 2>& origin) {
    for (const int v : placed_vertices_) vertex_at_[v] = -1;
    vertices_.clear();
    placed_vertices_.clear();
    body_ = &body;
    own_ = is_first ? 0 : 4;
    loss_ = seen;
    for (std::size_t e = 0; e < 2; ++e) {
        seen_[e] = placing(seen.rotation[e], seen.offset[e]);
        placed_[e] = placing(body.ends[e].rotation, origin[e]);
    }
    const auto vertices = static_cast<std::size_t>(body.body->mesh.vertices.cols());
    if (vertex_at_.size() < vertices) vertex_at_.resize(vertices, -1);
}

void PlacedBody::place_box(const geometry::HierarchyNode& node, PlacedBox& out) const {
    const Vector3 &c = node.center, &h = node.half_extent;
    const std::size_t other = 4 - own_;
    const BoxAt box{{c[0], c[1], c[2], 0},        {h[0], h[1], h[2], 0},  loss_.loss(node.radius),      out.low.data() + own_,
                    out.minus_high.data() + own_, out.low.data() + other, out.minus_high.data() + other};
    base::has_wide_instructions() ? place_both_wide(seen_, box) : place_both(seen_, box);
}

void PlacedBody::place_box(const geometry::OwnedBox& box, double radius, PlacedBox& out) const {
    // Sums and differences of floats: what they lose as doubles is far below the loss of rounding.
    geometry::HierarchyNode node;
    for (std::size_t k = 0; k < 3; ++k) {
        const double low = box.low[k], high = box.high[k];
        node.center[static_cast<int>(k)] = 0.5 * (low + high);
        node.half_extent[static_cast<int>(k)] = 0.5 * (high - low);
    }
    node.radius = radius;
    place_box(node, out);
}

int PlacedBody::place_vertex(int vertex) {
    const Vector3 X = body_->body->mesh.vertices.col(vertex);
    const std::size_t other = 4 - own_;
    PlacedVertex& out = vertices_.emplace_back();
    const PointAt point{
        {X[0], X[1], X[2], 0},      loss_.loss(X.norm() * (1 + 1e-15)), &out.x, out.box.low.data() + own_, out.box.minus_high.data() + own_,
        out.box.low.data() + other, out.box.minus_high.data() + other};
    base::has_wide_instructions() ? place_point_wide(seen_, placed_, point) : place_point(seen_, placed_, point);
    placed_vertices_.push_back(vertex);
    return count_of(vertices_) - 1;
}

}  // namespace fettle::core::ccd
