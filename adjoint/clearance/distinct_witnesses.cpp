// SPDX-License-Identifier: MIT
#include "adjoint/clearance/distinct_witnesses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace fettle::adjoint::clearance {
namespace {

using core::clearance::Witness;

constexpr double least_difference = 0.2;
constexpr double alike = 0.4;

struct WrenchAt {
    Vector6 wrench = Vector6::Zero();
    int step = -1, segment = 0;
    double s = 0;
    std::array<core::kinematics::Pose, 2> poses;  // of both bodies
    double size = 0;                              // of the smaller one
};

WrenchAt wrench_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const core::clearance::PairRequest& pair,
                   const Witness& w) {
    const double radius_a = model.bodies[pair.a].radius, radius_b = model.bodies[pair.b].radius;
    const auto place = [&](int body) { return pose_at(trajectory, w.step, w.segment, w.s, body); };
    WrenchAt out{Vector6::Zero(), w.step, w.segment, w.s, {place(pair.a), place(pair.b)}, std::min(radius_a, radius_b)};
    const Vector3 origin = out.poses[radius_a < radius_b ? 0 : 1].position;
    const Vector3 n = (w.point_a - w.point_b).normalized();
    out.wrench.head<3>() = n;
    if (out.size > 0) out.wrench.tail<3>() = (0.5 * (w.point_a + w.point_b) - origin).cross(n) / out.size;
    return out;
}

double difference_of_places(const WrenchAt& x, const WrenchAt& y, Places places) {
    if (x.step == y.step && x.segment == y.segment && x.s == y.s) return 0;
    if (places == Places::instants) return 1;
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        sum += (x.poses[i].rotation - y.poses[i].rotation).norm();
        if (x.size > 0) sum += (x.poses[i].position - y.poses[i].position).norm() / x.size;
    }
    return std::min(1.0, sum);
}

}  // namespace

std::vector<Witness> distinct_witnesses(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                        const core::clearance::PairRequest& pair, const std::vector<Witness>& candidates, int most,
                                        Places places) {
    const std::size_t count = candidates.size();
    std::vector<WrenchAt> all;
    all.reserve(count);
    for (const Witness& w : candidates) all.push_back(wrench_at(model, trajectory, pair, w));
    const auto difference = [&](std::size_t i, std::size_t j) {
        return (all[i].wrench - all[j].wrench).norm() + difference_of_places(all[i], all[j], places);
    };
    std::vector<double> gap(count);  // to the nearest of those chosen
    for (std::size_t i = 0; i < count; ++i) gap[i] = difference(0, i);
    std::vector<Witness> chosen;
    while (count_of(chosen) < most && count > 0) {
        const auto farthest = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
        if (!(gap[farthest] >= least_difference)) break;
        std::size_t pick = farthest;
        for (std::size_t i = 0; i < count; ++i) {
            const bool like = gap[i] >= least_difference && difference(i, farthest) < alike;
            if (like && candidates[i].distance < candidates[pick].distance) pick = i;
        }
        chosen.push_back(candidates[pick]);
        for (std::size_t i = 0; i < count; ++i) gap[i] = std::min(gap[i], difference(i, pick));
    }
    return chosen;
}

bool are_alike(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const core::clearance::PairRequest& pair,
               const Witness& one, const Witness& other) {
    return (wrench_at(model, trajectory, pair, one).wrench - wrench_at(model, trajectory, pair, other).wrench).norm() < alike;
}

}  // namespace fettle::adjoint::clearance
