// SPDX-License-Identifier: MIT
/// The identity of a path: what a certificate, or a file that grows, says which motion it is about. Bodies and meshes have a hash of their
/// own (geometry_hash, trajectory_io.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "core/files/hash.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::records {

/// FNV-1a, 64 bits, over the bits of all numbers of a path in the order in which it grows: timestep, time_start and the poses at the start
/// (of uneven steps their time too); then per step the number of nodes, the nodes, their fractions where they are not even, and the time
/// and the poses at its end. A pose: rotation row by row, position; a node: position, rotation vector; each with all bodies in their order.
class PathHash {
public:
    /// @param times  as Trajectory::times: the start's is hashed if there are any.
    PathHash(double timestep, double time_start, const std::vector<double>& times, const std::vector<kinematics::Pose>& start);

    /// @param time  at the end of the step; null where the steps are even.
    void add_step(const stepper::TrajectoryStep& step, const double* time, const std::vector<kinematics::Pose>& end);

    std::uint64_t value() const { return hash_.value(); }

private:
    files::Fnv1a hash_;
};

/// The hash of the whole path.
std::uint64_t path_hash(const stepper::Trajectory& trajectory);

}  // namespace fettle::core::records
