// SPDX-License-Identifier: MIT
#include "fettle/core/scene/scene.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/base/contract.hpp"

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

}  // namespace

double motion_value(const MotionCurve& curve, double time) {
    FETTLE_ASSERT(curve.times.size() == curve.values.size(), "a motion table needs one value per time");
    const double reached = curve.stop_time ? std::min(time, *curve.stop_time) : time;
    return curve.rate * reached + table_value(curve, reached);
}

double bounding_diagonal(const Scene& scene) {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
    Vector3 high = -low;
    for (const Body& body : scene.bodies) {
        for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
            const Vector3 x = kinematics::world_position(body.pose, body.mesh.vertices.col(i));
            low = low.cwiseMin(x);
            high = high.cwiseMax(x);
        }
    }
    return low.x() <= high.x() ? (high - low).norm() : 0;
}

}  // namespace fettle::core::scene
