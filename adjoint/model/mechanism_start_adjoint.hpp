// SPDX-License-Identifier: MIT
/// The start of a model (core/model/mechanism_start.hpp) backwards: from its poses, velocities and joints to the poses and velocities as
/// they were written. First the velocities' agreement with the rows, u = v + delta of
///   [ M  C^T ] [ delta ]   [      0      ]
///   [ C   0  ] [   m   ] = [ rates - C v ]
/// whose adjoint is, with (lambda, mu) of the same matrix and the right-hand side (u_bar, 0),
///   v_bar = u_bar - C^T mu,   rates_bar = mu,   and of what M and C depend on  - lambda . dM delta - m . dC lambda - mu . dC u;
/// then the assembly of the poses (constraint/assembly_adjoint.hpp). Where nothing had to move, the derivative is that of moving: a start
/// written a little differently is put on the constraints too.
#pragma once

#include <memory>
#include <vector>

#include "adjoint/model_gradient.hpp"

namespace fettle::adjoint::model {

/// Per body.
struct WrittenStartGradient {
    std::vector<Vector6> pose_bar;      ///< (q, phi) of the reference point's frame as written
    std::vector<Vector6> velocity_bar;  ///< (v, omega) as written
    std::vector<Vector6> rate_bar;      ///< of prescribed coordinates: how fast their curves begin
};

/// Factorised once, for any number of gradients.
class MechanismStartAdjoint {
public:
    /// Contract: masses of bodies that may move are those of their meshes and densities (body_mass_adjoint.hpp: check_masses). The model
    /// outlives this.
    explicit MechanismStartAdjoint(const core::model::Model& model);
    ~MechanismStartAdjoint();
    MechanismStartAdjoint(const MechanismStartAdjoint&) = delete;
    MechanismStartAdjoint& operator=(const MechanismStartAdjoint&) = delete;

    /// @param gradient  whole: of the model's start too. What the start depends on of frames, rows, densities and vertices is added to it.
    WrittenStartGradient reverse(ModelGradient& gradient) const;

private:
    struct Rows;
    const core::model::Model& model_;
    std::unique_ptr<const Rows> rows_;  // null: the model has none
};

}  // namespace fettle::adjoint::model
