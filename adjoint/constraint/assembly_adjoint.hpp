// SPDX-License-Identifier: MIT
/// The assembly at the start (core/constraint/assembly.hpp) backwards: from the assembled poses to the poses as written, the frames'
/// placement, the motors' curves and the masses. With v = [phi] R, dq the motion of lambda, and lambda, mu of
///   [ H  C^T ] [ lambda ]   [ P_bar in (q, phi) ]
///   [ C   0  ] [   mu   ] = [         0         ]
/// H the Hessian of the Lagrangian at the assembled poses:
///   written_bar = v M,   M_bar -= sym(v^T (P - P0)),   frames, curves: row_adjoint.hpp.
/// Coordinates that may not move are where they were written, and get P_bar - H lambda - C^T mu.
#pragma once

#include <memory>
#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/constraint/assembly.hpp"

namespace fettle::adjoint::constraint {

struct AssemblyGradient {
    std::vector<Vector6> written_bar;  ///< per body: of the poses as written, (q, phi)
    std::vector<Matrix4> moments_bar;
    std::vector<core::measure::FrameGradient> frames;
    VectorX targets_bar;                           ///< per row of the problem; 0 of those that follow from others
    std::vector<std::vector<double>> factors_bar;  ///< per row and part; 0 of the same
};

/// Factorised once, for any number of gradients.
class AssemblyAdjoint {
public:
    /// @param problem   its rows as they were assembled; `dependent` those that were left out. Must not outlive it, nor the poses.
    /// @param assembled where they are met, `written` what was written.
    /// @param angles    of the measures, with their turns, where the rows are met; empty: the nearest to those as written.
    AssemblyAdjoint(const core::constraint::AssemblyProblem& problem, const std::vector<core::constraint::DependentRow>& dependent,
                    const std::vector<core::kinematics::Pose>& written, const std::vector<core::kinematics::Pose>& assembled,
                    std::vector<double> angles = {});
    ~AssemblyAdjoint();
    AssemblyAdjoint(const AssemblyAdjoint&) = delete;
    AssemblyAdjoint& operator=(const AssemblyAdjoint&) = delete;

    /// @param pose_bar  per body: derivative in the assembled pose's matrix, entry by entry.
    AssemblyGradient reverse(const std::vector<Matrix34>& pose_bar) const;

private:
    class Implementation;
    std::unique_ptr<const Implementation> implementation_;
};

}  // namespace fettle::adjoint::constraint
