// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/near_windows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/limits.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/rounding.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int most_boxes = 1 << 18;
constexpr int most_time_spans = 4096;

struct BodyBox {
    Vector3 center, half;
    double size = 0;    // from the center to a corner
    double radius = 0;  // of the mesh, about the body's reference point
};

BodyBox box_of(const geometry::Mesh& mesh) {
    BodyBox box{Vector3::Zero(), Vector3::Zero()};
    if (mesh.vertices.cols() == 0) return box;
    const Vector3 low = mesh.vertices.rowwise().minCoeff(), high = mesh.vertices.rowwise().maxCoeff();
    box.center = 0.5 * (low + high);
    box.half = (0.5 * (high - low) + 4 * unit_roundoff * (low.cwiseAbs() + high.cwiseAbs())) * rounded_up;
    box.size = box.half.norm();
    box.radius = std::sqrt(mesh.vertices.colwise().squaredNorm().maxCoeff()) * rounded_up;
    return box;
}

struct Swept {
    Eigen::Array3d low = Eigen::Array3d::Constant(infinity), high = Eigen::Array3d::Constant(-infinity);

    void take(const Vector3& center, const Vector3& half) {
        low = low.min((center - half).array());
        high = high.max((center + half).array());
    }
};

// Of a small turn the box as it lies at the turn's beginning, grown; else those at both ends of the segment, grown: see the header.
void take_segment(const kinematics::PathSegment& path, const BodyBox& box, Swept& swept) {
    constexpr double small_turn = 0.02;  // of the box's size
    const double w = path.rotation_vector_step.norm(), theta = path.rotation_vector_t0.norm() + w;
    // The base may be a rotation up to rounding only: |base X| <= sqrt(1 + |B^T B - I|) |X|.
    const double radius = box.radius * std::sqrt(1 + (path.base.transpose() * path.base - Matrix3::Identity()).norm());
    const double position = path.position_t0.norm() + path.position_step.norm();
    const double rounding = 2 * unit_roundoff * ((256 + 48 * theta) * radius + 64 * position);
    const auto padded = [&](const Vector3& half, double rest) -> Vector3 {
        return half.array() + ((rest + rounding) * rounded_up + std::numeric_limits<double>::min());
    };
    if (theta * radius <= small_turn * box.size) {
        const Vector3 half_step = 0.5 * path.position_step;
        swept.take(path.base * box.center + path.position_t0 + half_step,
                   padded(path.base.cwiseAbs() * box.half + half_step.cwiseAbs(), theta * radius));
        return;
    }
    const double rest = std::min(w * w / 8, 2.0) * radius;
    for (const double s : {0.0, 1.0}) {
        const kinematics::Pose pose = kinematics::pose_at(path, s);
        swept.take(pose.rotation * box.center + pose.position, padded(pose.rotation.cwiseAbs() * box.half, rest));
        if (w == 0 && path.position_step == Vector3::Zero()) return;
    }
}

// Spans of time: segments [first(k), first(k + 1)).
struct TimeSpans {
    int segments = 1, count = 1;
    int first(int k) const { return static_cast<int>(static_cast<long>(k) * segments / count); }
};

class NearSearch {
public:
    NearSearch(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places, double reach,
               const PairFilter& wanted)
        : trajectory_(trajectory), places_(places), reach_(reach), wanted_(wanted), bodies_(static_cast<int>(model.bodies.size())) {
        spans_.segments = static_cast<int>(places.size());
        spans_.count = std::clamp(most_boxes / std::max(bodies_, 1), 1, std::min(spans_.segments, most_time_spans));
        boxes_.resize(static_cast<std::size_t>(bodies_));
        usable_ = have_usable_numbers(model, trajectory, places);
        parallel_for(bodies_, 1, [&](int i) { boxes_[i] = box_of(model.bodies[i].mesh); });
        const double telling = telling_spans();
        if (telling < spans_.count) spans_.count = std::max(1, static_cast<int>(std::ceil(telling)));
    }

    NearWindows run() {
        std::vector<std::vector<std::pair<int, int>>> near(static_cast<std::size_t>(spans_.count));
        parallel_for(spans_.count, 1, [&](int k) { near[k] = near_in(k); });
        std::vector<NearSpan> rows;
        for (int k = 0; k < spans_.count; ++k) {
            for (const auto& [a, b] : near[static_cast<std::size_t>(k)]) rows.push_back({a, b, k});
        }
        rows = sorted_by_body(sorted_by_body(rows, &NearSpan::b), &NearSpan::a);
        NearWindows result;
        for (const NearSpan& row : rows) take(result.windows, row.a, row.b, row.span);
        add_unmeasurable(result.windows);
        result.everything = covers_everything(result.windows);
        return result;
    }

private:
    // So many spans that each body goes a small share of its size in each, about: more would tell no better what comes near.
    double telling_spans() const {
        constexpr double share = 0.1;
        std::vector<double> way(static_cast<std::size_t>(bodies_), 0);
        parallel_for((bodies_ + bodies_at_once - 1) / bodies_at_once, 1, [&](int block) {
            const int first = block * bodies_at_once, last = std::min(bodies_, first + bodies_at_once);
            for (const PathPlace& place : places_) {
                for (int body = first; body < last; ++body) {
                    const kinematics::PathSegment path = segment_at(trajectory_, place, body);
                    way[body] += path.position_step.norm() + path.rotation_vector_step.norm() * boxes_[body].radius;
                }
            }
        });
        double most = 0;
        for (std::size_t body = 0; body < way.size(); ++body)
            if (way[body] > 0) most = std::max(most, way[body] / (share * boxes_[body].size));
        return most;
    }

    struct NearSpan {
        int a, b, span;
    };

    // Those of the same body stay in their order.
    std::vector<NearSpan> sorted_by_body(const std::vector<NearSpan>& rows, int NearSpan::*body) const {
        std::vector<std::size_t> next(static_cast<std::size_t>(bodies_) + 1, 0);
        for (const NearSpan& row : rows) ++next[static_cast<std::size_t>(row.*body) + 1];
        std::partial_sum(next.begin(), next.end(), next.begin());
        std::vector<NearSpan> sorted(rows.size());
        for (const NearSpan& row : rows) sorted[next[static_cast<std::size_t>(row.*body)]++] = row;
        return sorted;
    }

    Swept swept(int body, int span) const {
        Swept box;
        for (int i = spans_.first(span); i < spans_.first(span + 1); ++i)
            take_segment(segment_at(trajectory_, places_[static_cast<std::size_t>(i)], body), boxes_[static_cast<std::size_t>(body)], box);
        return box;
    }

    // Sorted along the axis on which the boxes lie farthest apart, each is compared with those that begin before it ends.
    std::vector<std::pair<int, int>> near_in(int span) const {
        std::vector<Swept> boxes(static_cast<std::size_t>(bodies_));
        std::vector<int> order;
        Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
        for (int i = 0; i < bodies_; ++i) {
            if (usable_[static_cast<std::size_t>(i)] == 0) continue;
            boxes[static_cast<std::size_t>(i)] = swept(i, span);
            order.push_back(i);
            const Eigen::Array3d middle = 0.5 * (boxes[static_cast<std::size_t>(i)].low + boxes[static_cast<std::size_t>(i)].high);
            sum += middle;
            squares += middle.square();
        }
        int axis = 0;
        if (!order.empty()) (squares - sum.square() / static_cast<double>(order.size())).maxCoeff(&axis);
        const auto box = [&](int i) -> const Swept& { return boxes[static_cast<std::size_t>(i)]; };
        std::sort(order.begin(), order.end(),
                  [&](int i, int j) { return box(i).low[axis] != box(j).low[axis] ? box(i).low[axis] < box(j).low[axis] : i < j; });
        std::vector<std::pair<int, int>> pairs;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Swept& x = box(order[i]);
            for (std::size_t j = i + 1; j < order.size(); ++j) {
                const Swept& y = box(order[j]);
                // Apart only where the difference, rounding and all, says so: what is no number stays.
                if (y.low[axis] - x.high[axis] >= reach_) break;
                if (((y.low - x.high).max(x.low - y.high) >= reach_).any()) continue;
                const int a = std::min(order[i], order[j]), b = std::max(order[i], order[j]);
                if (wanted_(a, b)) pairs.emplace_back(a, b);
            }
        }
        return pairs;
    }

    void take(std::vector<NearWindow>& windows, int a, int b, int span) const {
        const int first = spans_.first(span), last = spans_.first(span + 1);
        if (!windows.empty() && windows.back().a == a && windows.back().b == b && windows.back().last == first) {
            windows.back().last = last;
        } else {
            windows.push_back({a, b, first, last});
        }
    }

    void add_unmeasurable(std::vector<NearWindow>& windows) const {
        const std::size_t measurable = windows.size();
        for (int i = 0; i < bodies_; ++i) {
            if (usable_[static_cast<std::size_t>(i)] != 0) continue;
            for (int j = 0; j < bodies_; ++j) {
                const bool told = usable_[static_cast<std::size_t>(j)] == 0 && j < i;
                const int a = std::min(i, j), b = std::max(i, j);
                if (!told && i != j && wanted_(a, b)) windows.push_back({a, b, 0, spans_.segments, false});
            }
        }
        if (windows.size() == measurable) return;
        std::sort(windows.begin(), windows.end(),
                  [](const NearWindow& x, const NearWindow& y) { return std::tie(x.a, x.b, x.first) < std::tie(y.a, y.b, y.first); });
    }

    bool covers_everything(const std::vector<NearWindow>& windows) const {
        const auto whole = [&](const NearWindow& w) { return w.first == 0 && w.last == spans_.segments; };
        if (!std::all_of(windows.begin(), windows.end(), whole)) return false;
        std::size_t pairs = 0;
        for (int a = 0; a < bodies_ && pairs <= windows.size(); ++a) {
            for (int b = a + 1; b < bodies_; ++b) pairs += wanted_(a, b) ? 1 : 0;
        }
        return pairs == windows.size();
    }

    const stepper::Trajectory& trajectory_;
    const std::vector<PathPlace>& places_;
    double reach_;
    const PairFilter& wanted_;
    int bodies_;
    TimeSpans spans_;
    std::vector<BodyBox> boxes_;
    std::vector<char> usable_;
};

}  // namespace

NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach, const PairFilter& wanted) {
    FETTLE_ASSERT(reach >= 0 && !places.empty(), "a reach of at least 0, over some time");
    return NearSearch(model, trajectory, places, reach, wanted).run();
}

NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach) {
    return near_windows(model, trajectory, places, reach, [&](int a, int b) { return model::may_collide(model, a, b); });
}

PairMotion window_motion(const std::vector<BodyShape>& shapes, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         const NearWindow& window) {
    const BodyShape &a = shapes[window.a], &b = shapes[window.b];
    PairMotion pair{*a.tree, *b.tree, trajectory, {}, *a.solid, *b.solid};
    pair.segments.reserve(static_cast<std::size_t>(window.last - window.first));
    for (int i = window.first; i < window.last; ++i) {
        const PathPlace& place = places[static_cast<std::size_t>(i)];
        pair.segments.push_back(pair_segment(segment_at(trajectory, place, window.a), segment_at(trajectory, place, window.b),
                                             pair.a.radius(), pair.b.radius()));
        pair.segments.back().step = place.step;
        pair.segments.back().segment = place.segment;
    }
    return pair;
}

}  // namespace fettle::core::clearance
