// SPDX-License-Identifier: MIT
/// One term of the incremental potential (core/energy/term.hpp) as the sweeps need it: what it cannot differentiate, and the derivative of
/// its gradient in the constants of a step, backwards and forwards. Each term is one file here, and an entry in the list of
/// incremental_potential_adjoint.cpp. Its Hessian in the poses is core's.
#pragma once

#include <string>
#include <vector>

#include "adjoint/contact/contact_set_adjoint.hpp"
#include "adjoint/contact/friction_adjoint.hpp"
#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/energy/term.hpp"

namespace fettle::adjoint::energy {

/// Where a step ended, or one of its rounds of friction: the gradient is zero over the free coordinates.
struct StepEnd : core::energy::DerivativesAt {
    const contact::LaggedContacts* lag = nullptr;  ///< what friction was taken from; null: there is none
};

/// Gradients in the constants of one step that follow from the steps before it and from the shapes, by seed and body.
struct StepGradient {
    std::vector<std::vector<Matrix34>> pose_hat_bar;
    std::vector<std::vector<Matrix34>> slip_reference_bar;
    std::vector<std::vector<Matrix34>> start_bar, before_bar;  ///< of P0 and P_-1 themselves
    std::vector<std::vector<Matrix4>> moments_bar;
    std::vector<std::vector<contact::AreaChange>> areas_bar;  ///< where the barrier is area-weighted
    std::vector<std::vector<Matrix34>> lag_poses_bar{};       ///< of where friction was taken from
};

/// Changes of the end poses and of the same constants, by body.
struct StepTangent {
    const std::vector<Matrix34>& poses_dot;
    const std::vector<Matrix34>& pose_hat_dot;
    const std::vector<Matrix34>& slip_reference_dot;
    const std::vector<Matrix34>&start_dot, &before_dot;  ///< of P0 and P_-1; the latter of BDF2 after its first step
    const std::vector<Matrix4>& moments_dot;
    const std::vector<contact::AreaChange>& areas_dot;
    const std::vector<Matrix34>& lag_poses_dot;
};

struct TermAdjoint {
    const char* name;  ///< that of core's term
    /// Errors (unsupported) for what the term has in this model that the sweeps know no derivative of.
    Errors (*check)(const core::model::Model& model);
    /// With r the term's gradient along motion[seed][body] = (dq, phi) of the adjoint variable: subtracts dr/d(constants) from the step's
    /// and the model's gradients.
    void (*subtract_reverse)(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                             std::vector<ModelGradient>& model_bar);
    /// Adds the term's dE/dP (3 x 4 per body) and its change.
    void (*add_tangent)(const StepEnd& at, const StepTangent& step, const ModelTangent& direction, contact::PoseGradientTangent& out);
};

/// "`what` cannot be differentiated".
core::base::Error refusal(const std::string& where, const std::string& what);

}  // namespace fettle::adjoint::energy
