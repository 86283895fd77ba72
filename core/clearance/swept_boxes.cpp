// SPDX-License-Identifier: MIT
#include "core/clearance/swept_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/four.hpp"
#include "core/base/limits.hpp"
#include "core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

constexpr double small_turn = 0.02;  // of the box's size

void take(const Vector3& center, const Vector3& half, geometry::Box& swept) {
    swept.low = swept.low.cwiseMin(center - half);
    swept.high = swept.high.cwiseMax(center + half);
}

// Whatever its turn, by the boxes at both ends.
void take_segment(const kinematics::PathSegment& path, const BodyBox& box, geometry::Box& swept) {
    const double w = path.rotation_vector_step.norm(), theta = path.rotation_vector_t0.norm() + w;
    const double radius = box.radius * std::sqrt(1 + (path.base.transpose() * path.base - Matrix3::Identity()).norm());
    const double position = path.position_t0.norm() + path.position_step.norm();
    const double rounding = 2 * unit_roundoff * ((256 + 48 * theta) * radius + 64 * position);
    const double rest = std::min(w * w / 8, 2.0) * radius;
    for (const double s : {0.0, 1.0}) {
        const kinematics::Pose pose = kinematics::pose_at(path, s);
        const Vector3 half =
            (pose.rotation.cwiseAbs() * box.half).array() + ((rest + rounding) * rounded_up + std::numeric_limits<double>::min());
        take(pose.rotation * box.center + pose.position, half, swept);
        if (w == 0 && path.position_step == Vector3::Zero()) return;
    }
}

// Lanes are bodies.
using base::Four;
using base::lanes;
using Vectors = std::array<Four, 3>;
using Matrices = std::array<Four, 9>;  // column by column

template <class Object>
using FourOf = std::array<const Object*, lanes>;

struct Segments {
    std::array<Four, 12> pose;  // the base in front
    std::array<Four, 6> start;  // position and rotation vector
    Vectors position_step, turn;
};

struct Boxes {
    Vectors center, half;
    Four size, radius;
};

[[gnu::always_inline]] inline void find_norm(const Four* v, Four& out) { base::square_root(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], out); }

// Gathers the segments of bodies from `first` on, the last of the range again where there are not as many. Contract: the place is of a
// step.
[[gnu::always_inline]] inline void gather_segments(const BodyRange& range, const PathPlace& place, int first, Segments& out) {
    const auto step = static_cast<std::size_t>(place.step), k = static_cast<std::size_t>(place.segment);
    const auto& poses = range.trajectory.poses[step];
    const auto& nodes = range.trajectory.steps[step].nodes;
    FourOf<kinematics::Pose> pose;
    FourOf<kinematics::ChartPoint> start, end;
    for (std::size_t j = 0; j < lanes; ++j) {
        const auto body = static_cast<std::size_t>(std::min(first + static_cast<int>(j), range.last - 1));
        pose[j] = &poses[body];
        start[j] = &nodes[k][body];
        end[j] = &nodes[k + 1][body];
    }
    std::array<Four, 6> to;
    base::gather(pose, out.pose);
    base::gather(start, out.start);
    base::gather(end, to);
    for (std::size_t i = 0; i < 3; ++i) {
        out.position_step[i] = to[i] - out.start[i];
        out.turn[i] = to[3 + i] - out.start[3 + i];
    }
}

[[gnu::always_inline]] inline void gather_boxes(const BodyRange& range, const std::vector<BodyBox>& boxes, int first, Boxes& out) {
    FourOf<BodyBox> box;
    for (int j = 0; j < lanes; ++j) box[j] = &boxes[std::min(first + j, range.last - 1)];
    std::array<Four, 8> numbers;
    base::gather(box, numbers);
    for (std::size_t i = 0; i < 3; ++i) {
        out.center[i] = numbers[i];
        out.half[i] = numbers[3 + i];
    }
    out.size = numbers[6];
    out.radius = numbers[7];
}

// |B^T B - I|
[[gnu::always_inline]] inline void find_excess(const std::array<Four, 12>& b, Four& out) {
    Four squares = {0, 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const Four product = b[3 * i] * b[3 * j] + b[3 * i + 1] * b[3 * j + 1] + b[3 * i + 2] * b[3 * j + 2];
            squares += i == j ? (product - 1) * (product - 1) : 2 * product * product;
        }
    }
    base::square_root(squares, out);
}

// The boxes at the middle of the segments, good for those bodies that turn little: where there is `room`, at least 0.
[[gnu::always_inline]] inline void find_middles(const Segments& path, const Boxes& box, Boxes& out, Four& room) {
    Four w, theta, excess, radius, position, step;
    find_norm(path.turn.data(), w);
    find_norm(path.start.data() + 3, theta);
    theta += w;
    find_excess(path.pose, excess);
    base::square_root(1 + excess, radius);
    radius *= box.radius;
    find_norm(path.start.data(), position);
    find_norm(path.position_step.data(), step);
    const Four rounding = 2 * unit_roundoff * ((256 + 48 * theta) * radius + 64 * (position + step));
    const Four grown = (theta * radius + rounding) * rounded_up + std::numeric_limits<double>::min();
    for (std::size_t r = 0; r < 3; ++r) {
        const Four half_step = 0.5 * path.position_step[r];
        out.center[r] = path.start[r] + half_step;
        base::magnitude(half_step, out.half[r]);
        for (std::size_t k = 0; k < 3; ++k) {
            Four size;
            base::magnitude(path.pose[3 * k + r], size);
            out.center[r] += path.pose[3 * k + r] * box.center[k];
            out.half[r] += size * box.half[k];
        }
        out.half[r] += grown;
    }
    room = small_turn * box.size - theta * radius;
}

[[gnu::always_inline]] inline void sweep_four(const BodyRange& range, const std::vector<BodyBox>& boxes, int first, geometry::Box* out) {
    Boxes box, middle;
    gather_boxes(range, boxes, first, box);
    const Four none = {infinity, infinity, infinity, infinity};
    Vectors low{none, none, none}, high{-none, -none, -none};
    const int count = std::min(lanes, range.last - first);
    for (const PathPlace& place : range.places) {
        Four room = {-1, -1, -1, -1};
        if (place.step >= 0) {
            Segments path;
            gather_segments(range, place, first, path);
            find_middles(path, box, middle, room);
            const auto holds = room >= 0;
            for (std::size_t k = 0; k < 3; ++k) {
                base::take_smaller<Four>(holds ? middle.center[k] - middle.half[k] : none, low[k]);
                base::take_larger<Four>(holds ? middle.center[k] + middle.half[k] : -none, high[k]);
            }
            if ((holds[0] & holds[1] & holds[2] & holds[3]) != 0) continue;
        }
        for (int j = 0; j < count; ++j) {
            const int body = first + j;
            if (!(room[j] >= 0)) take_segment(segment_at(range.trajectory, place, body), boxes[body], out[j]);
        }
    }
    for (int j = 0; j < count; ++j) {
        for (Eigen::Index k = 0; k < 3; ++k) {
            base::take_smaller<double>(low[k][j], out[j].low[k]);
            base::take_larger<double>(high[k][j], out[j].high[k]);
        }
    }
}

FETTLE_WIDE void sweep_four_wide(const BodyRange& range, const std::vector<BodyBox>& boxes, int first, geometry::Box* out) {
    sweep_four(range, boxes, first, out);
}

[[gnu::always_inline]] inline void measure_four(const BodyRange& range, const std::vector<BodyBox>& boxes, int first, double* out) {
    Boxes box;
    gather_boxes(range, boxes, first, box);
    Four way = {0, 0, 0, 0};
    for (const PathPlace& place : range.places) {
        if (place.step < 0) continue;
        Segments path;
        Four step, turn;
        gather_segments(range, place, first, path);
        find_norm(path.position_step.data(), step);
        find_norm(path.turn.data(), turn);
        way += step + turn * box.radius;
    }
    for (int j = 0; j < std::min(lanes, range.last - first); ++j) out[j] = way[j];
}

FETTLE_WIDE void measure_four_wide(const BodyRange& range, const std::vector<BodyBox>& boxes, int first, double* out) {
    measure_four(range, boxes, first, out);
}

}  // namespace

BodyBox box_of(const geometry::Mesh& mesh) {
    BodyBox box;
    if (mesh.vertices.cols() == 0) return box;
    const Vector3 low = mesh.vertices.rowwise().minCoeff(), high = mesh.vertices.rowwise().maxCoeff();
    box.center = 0.5 * (low + high);
    box.half = (0.5 * (high - low) + 4 * unit_roundoff * (low.cwiseAbs() + high.cwiseAbs())) * rounded_up;
    box.size = box.half.norm();
    box.radius = std::sqrt(mesh.vertices.colwise().squaredNorm().maxCoeff()) * rounded_up;
    return box;
}

void sweep(const BodyRange& range, const std::vector<BodyBox>& boxes, geometry::Box* out) {
    const bool wide = base::has_wide_instructions();
    for (int first = range.first; first < range.last; first += lanes) {
        geometry::Box* const swept = out + (first - range.first);
        std::fill_n(swept, std::min(lanes, range.last - first), geometry::Box{Vector3::Constant(infinity), Vector3::Constant(-infinity)});
        wide ? sweep_four_wide(range, boxes, first, swept) : sweep_four(range, boxes, first, swept);
    }
}

void measure_ways(const BodyRange& range, const std::vector<BodyBox>& boxes, double* out) {
    const bool wide = base::has_wide_instructions();
    for (int first = range.first; first < range.last; first += lanes) {
        double* const ways = out + (first - range.first);
        wide ? measure_four_wide(range, boxes, first, ways) : measure_four(range, boxes, first, ways);
    }
}

}  // namespace fettle::core::clearance
