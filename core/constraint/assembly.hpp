// SPDX-License-Identifier: MIT
/// Puts bodies where their joints are met, moved least: the poses P nearest to P0,
///   minimise 1/2 sum tr((P - P0) M (P - P0)^T)   subject to   row_i(P) = target_i,
/// by Newton's method on the Lagrangian. docs/method/joints.md#assembly-the-start.
#pragma once

#include <vector>

#include "core/constraint/dependent_rows.hpp"
#include "core/constraint/row.hpp"
#include "core/linear/free_dofs.hpp"

namespace fettle::core::constraint {

struct AssemblyProblem {
    const measure::MeasureSet& set;
    const std::vector<Row>& rows;
    VectorX targets;               ///< per row
    std::vector<Matrix4> moments;  ///< per body: what moving it costs
    linear::FreeDofs dofs;         ///< what may be moved
    double size = 1;               ///< of the scene [m]
};

/// Gaps of rows up to this are none [m]: 1e-12 of the scene's size, or what rounding makes of places as far out as these.
double closed_gap(double size, const std::vector<kinematics::Pose>& poses);

struct Assembly {
    std::vector<kinematics::Pose> poses;
    std::vector<double> angles;  ///< of the measures there
    bool is_met = false;
    bool has_moved = false;               ///< false: the poses are those that were handed in, bit for bit
    VectorX gaps;                         ///< per row: |row - target| times its length [m]
    std::vector<DependentRow> dependent;  ///< rows that follow from others; left out, but their gaps count
    int iterations = 0;
};

/// @param start    P0.
/// @param attempt  where the search begins; empty: at `start`. It decides which of several stationary poses is found.
Assembly assemble(const AssemblyProblem& problem, const std::vector<kinematics::Pose>& start,
                  const std::vector<kinematics::Pose>& attempt = {});

/// The velocity nearest to `velocities` (6 per body: v, omega) that keeps to the rows, by mass: minimises 1/2 (u - v)^T M (u - v) subject
/// to C u = rates.
std::vector<Vector6> compatible_velocities(const AssemblyProblem& problem, const std::vector<kinematics::Pose>& poses,
                                           const std::vector<DependentRow>& dependent, const VectorX& rates,
                                           const std::vector<Vector6>& velocities);

}  // namespace fettle::core::constraint
