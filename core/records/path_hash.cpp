// SPDX-License-Identifier: MIT
#include "core/records/path_hash.hpp"

#include "core/base/contract.hpp"

namespace fettle::core::records {
namespace {

void add_vector(const Vector3& v, files::Fnv1a& hash) {
    for (const double x : v) hash.add(x);
}

void add_poses(const std::vector<kinematics::Pose>& poses, files::Fnv1a& hash) {
    for (const kinematics::Pose& pose : poses) {
        for (int row = 0; row < 3; ++row) add_vector(pose.rotation.row(row), hash);
        add_vector(pose.position, hash);
    }
}

}  // namespace

PathHash::PathHash(double timestep, double time_start, const std::vector<double>& times, const std::vector<kinematics::Pose>& start) {
    hash_.add(timestep);
    hash_.add(time_start);
    if (!times.empty()) hash_.add(times.front());
    add_poses(start, hash_);
}

void PathHash::add_step(const stepper::TrajectoryStep& step, const double* time, const std::vector<kinematics::Pose>& end) {
    hash_.add(static_cast<std::uint64_t>(step.nodes.size()));
    for (const auto& node : step.nodes) {
        for (const kinematics::ChartPoint& point : node) {
            add_vector(point.position, hash_);
            add_vector(point.rotation_vector, hash_);
        }
    }
    for (const double fraction : step.fractions) hash_.add(fraction);
    if (time) hash_.add(*time);
    add_poses(end, hash_);
}

std::uint64_t path_hash(const stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(trajectory.poses.size() == trajectory.steps.size() + 1, "one step between each two poses");
    PathHash hash(trajectory.timestep, trajectory.time_start, trajectory.times, trajectory.poses.front());
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t)
        hash.add_step(trajectory.steps[t], trajectory.times.empty() ? nullptr : &trajectory.times[t + 1], trajectory.poses[t + 1]);
    return hash.value();
}

}  // namespace fettle::core::records
