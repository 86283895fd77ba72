// SPDX-License-Identifier: MIT
#include "core/scene/scene.hpp"

#include <algorithm>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"

namespace fettle::core::scene {
namespace {

double table_value(const MotionCurve& curve, double time) {
    if (curve.times.empty()) return 0;
    if (time <= curve.times.front()) return curve.values.front();
    if (time >= curve.times.back()) return curve.values.back();
    const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), time);
    const auto i = static_cast<std::size_t>(after - curve.times.begin());
    const double fraction = (time - curve.times[i - 1]) / (curve.times[i] - curve.times[i - 1]);
    return curve.values[i - 1] + fraction * (curve.values[i] - curve.values[i - 1]);
}

struct Extent {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;

    void take(const Vector3& other_low, const Vector3& other_high) {
        low = low.cwiseMin(other_low);
        high = high.cwiseMax(other_high);
    }
};

template <class Counts>
double diagonal_of(const Scene& scene, const Counts& counts) {
    constexpr int bodies_at_once = 8;  // that a thread takes
    const auto extent_of = [&](int begin, int end) {
        Extent extent;
        for (int b = begin; b < end; ++b) {
            const Body& body = scene.bodies[b];
            if (!counts(body)) continue;
            for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
                const Vector3 x = kinematics::world_position(body.pose, body.mesh.vertices.col(i));
                extent.take(x, x);
            }
        }
        return extent;
    };
    const Extent all =
        base::ordered_reduce(count_of(scene.bodies), bodies_at_once, Extent{}, extent_of, [](Extent&& so_far, Extent&& piece) {
            so_far.take(piece.low, piece.high);
            return so_far;
        });
    return all.low.x() <= all.high.x() ? (all.high - all.low).norm() : 0;
}

}  // namespace

int Friction::pair_of(const std::string& material_a, const std::string& material_b) const {
    if (material_a.empty() || material_b.empty()) return -1;
    const auto wanted = std::minmax(material_a, material_b);
    const auto found =
        std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return std::minmax(pair.material_a, pair.material_b) == wanted; });
    return found == pairs.end() ? -1 : static_cast<int>(found - pairs.begin());
}

double motion_value(const MotionCurve& curve, double time) {
    FETTLE_ASSERT(curve.times.size() == curve.values.size(), "a motion table needs one value per time");
    const double reached = curve.stop_time ? std::min(time, *curve.stop_time) : time;
    return curve.rate * reached + table_value(curve, reached);
}

kinematics::Pose scripted_pose(const PoseScript& script, const kinematics::Pose& start, double time) {
    FETTLE_ASSERT(script.times.size() == script.poses.size(), "a script needs one pose per time");
    if (script.empty() || time <= 0) return start;
    const auto after = std::upper_bound(script.times.begin(), script.times.end(), time);
    const auto i = static_cast<std::size_t>(after - script.times.begin());
    if (after == script.times.end()) return script.poses.back();
    const kinematics::Pose &from = i == 0 ? start : script.poses[i - 1], &to = script.poses[i];
    const double begin = i == 0 ? 0 : script.times[i - 1];
    const double fraction = (time - begin) / (script.times[i] - begin);
    if (fraction == 0) return from;
    const Vector3 turn = kinematics::rotation_vector(to.rotation * from.rotation.transpose());
    return {kinematics::rotation(fraction * turn) * from.rotation, from.position + fraction * (to.position - from.position)};
}

double bounding_diagonal(const Scene& scene) {
    return diagonal_of(scene, [](const Body&) { return true; });
}

double moving_diagonal(const Scene& scene) {
    return diagonal_of(scene, [](const Body& body) { return body.type != BodyType::static_body; });
}

}  // namespace fettle::core::scene
