// SPDX-License-Identifier: MIT
#include "fettle/adjoint/clearance/distinct_witnesses.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace fettle::adjoint::clearance {
namespace {

using core::clearance::Witness;

constexpr double least_difference = 0.2;
constexpr double alike = 0.4;

struct WrenchAt {
    Vector6 wrench = Vector6::Zero();
    int step = -1, segment = 0;
    double s = 0;
};

WrenchAt wrench_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, const core::clearance::PairRequest& pair,
                   const Witness& w) {
    const double radius_a = model.bodies[pair.a].radius, radius_b = model.bodies[pair.b].radius;
    const int smaller = radius_a < radius_b ? pair.a : pair.b;
    const double radius = std::min(radius_a, radius_b);
    const Vector3 origin = pose_at(trajectory, w.step, w.segment, w.s, smaller).position;
    const Vector3 n = (w.point_a - w.point_b).normalized();
    WrenchAt out{Vector6::Zero(), w.step, w.segment, w.s};
    out.wrench.head<3>() = n;
    if (radius > 0) out.wrench.tail<3>() = (0.5 * (w.point_a + w.point_b) - origin).cross(n) / radius;
    return out;
}

double difference(const WrenchAt& x, const WrenchAt& y) {
    const bool same_instant = x.step == y.step && x.segment == y.segment && x.s == y.s;
    return (x.wrench - y.wrench).norm() + (same_instant ? 0 : 1);
}

}  // namespace

std::vector<Witness> distinct_witnesses(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                        const core::clearance::PairRequest& pair, const Witness& first,
                                        const std::vector<Witness>& candidates, int most) {
    const std::size_t count = candidates.size();
    std::vector<WrenchAt> places;
    std::vector<double> gap;  // to the nearest of those chosen
    places.reserve(count);
    gap.reserve(count);
    const WrenchAt start = wrench_at(model, trajectory, pair, first);
    for (const Witness& w : candidates) {
        places.push_back(wrench_at(model, trajectory, pair, w));
        gap.push_back(difference(start, places.back()));
    }
    std::vector<Witness> chosen;
    while (count_of(chosen) < most && count > 0) {
        const auto farthest = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
        if (!(gap[farthest] >= least_difference)) break;
        std::size_t pick = farthest;
        for (std::size_t i = 0; i < count; ++i) {
            const bool like = gap[i] >= least_difference && difference(places[i], places[farthest]) < alike;
            if (like && candidates[i].distance < candidates[pick].distance) pick = i;
        }
        chosen.push_back(candidates[pick]);
        for (std::size_t i = 0; i < count; ++i) gap[i] = std::min(gap[i], difference(places[i], places[pick]));
    }
    return chosen;
}

}  // namespace fettle::adjoint::clearance
