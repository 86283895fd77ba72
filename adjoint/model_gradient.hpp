// SPDX-License-Identifier: MIT
/// Derivatives of a number that depends on a simulated trajectory, with respect to everything in the Model that moves it. The adjoint
/// never sees a design parameter: design/ chains these with its own Jacobians.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/types.hpp"
#include "core/model/model.hpp"

namespace fettle::adjoint {

/// dJ/d(configurations): what an objective hands in. Explicit dependence on the model is added by whoever computes it.
struct TrajectoryGradient {
    /// [t][body], t = 0 .. steps: derivative with respect to the pose matrix P = [R q], entry by entry (3x4).
    std::vector<std::vector<Matrix34>> pose_bar;
    /// [step]: derivative with respect to the multipliers of all rows (stepper/row_multipliers.hpp); empty: of none.
    std::vector<VectorX> multiplier_bar;
    /// [step][body]: of Newmark's velocity Pdot at the step's end, entry by entry; empty: of none (others' velocities are differences of
    /// poses: stepper/velocities.hpp).
    std::vector<std::vector<Matrix34>> velocity_bar;
    /// [step][body]: of the poses from which the step's last round of friction took its normal forces and tangents, entry by entry; empty:
    /// of none.
    std::vector<std::vector<Matrix34>> lag_bar;
};
TrajectoryGradient zero_trajectory_gradient(int steps, int bodies);

/// dJ/d(body data).
struct BodyGradient {
    Matrix3X vertices_bar;  ///< 3 x n, vertices in the body's frame (relative to c, which is constant)
    /// Start pose of the reference point's frame, [R q], entry by entry; R's part is defined up to what a rotation cannot do:
    /// pair it with tangents dP = [[phi] R, dq]. Body::velocity_start is held (a caller that holds omega in [[omega] R, v] adds that term).
    Matrix34 pose_start_bar = Matrix34::Zero();
    Matrix34 velocity_start_bar = Matrix34::Zero();  ///< Pdot at the start, entry by entry
    double density_bar = 0;                          ///< of the moments, by the body's MassKind
    Vector3 force_bar = Vector3::Zero(), torque_bar = Vector3::Zero();
    std::vector<Vector6> increment_bar;  ///< [step]: prescribed coordinates' increments over each step (chart coordinates); free ones 0
};

/// dJ/d(core::model::Mechanism). Everything is per frame, term and row of the model (of all its rows, by core::constraint::Row::number), as
/// it was built: how frames, rests and constants
/// follow from a scene is chained by whoever builds it.
struct MechanismGradient {
    std::vector<core::measure::FrameGradient> frames;  ///< placement, entry by entry: axes too, as if they could be anything
    std::vector<double> term_coefficient;              ///< stiffness, damping, friction, factor of a force
    std::vector<double> term_reference;                ///< rest or limit; 0 of others
    std::vector<std::vector<double>> term_values;      ///< values of a force's curve
    std::vector<double> term_rate;                     ///< rate of a force's curve
    std::vector<double> row_constant;
    std::vector<std::vector<double>> row_factors;  ///< of each part
    std::vector<std::vector<double>> row_values;   ///< values of a motor's curve
    std::vector<double> row_rate;                  ///< rate of a motor's curve
};

/// By two bodies a < b: in their coefficient of friction, as if it were one of its own. Pairs that are not there: 0.
using FrictionGradient = std::map<std::pair<int, int>, double>;

struct ModelGradient {
    std::vector<BodyGradient> bodies;
    Vector3 gravity_bar = Vector3::Zero();
    FrictionGradient friction_bar;
    double dmin_bar = 0;  ///< of the minimum separation; kappa is held
    MechanismGradient mechanism;
};
ModelGradient zero_model_gradient(const core::model::Model& model, int steps);

/// sum += part. Contract: of one model and number of steps; members of `part` that nothing was written to may be empty.
void add(ModelGradient& sum, const ModelGradient& part);

/// What a quantity of a simulated motion hands in: dJ/d(configurations) and its explicit dependence on the model, to be swept backwards
/// together (stepper/seeded_sweep.hpp).
struct Seeds {
    TrajectoryGradient trajectory_bar;
    ModelGradient model_bar;
    VectorX parameters_bar{};  ///< of numbers of the caller's own that no model holds; no sweep looks at it. Empty: of none
    std::string refusal{};     ///< why the quantity has no derivative here, with the step; empty: it has one
};
Seeds zero_seeds(const core::model::Model& model, int steps);

/// The same quantities as a direction to differentiate along (forward mode).
struct BodyTangent {
    Matrix3X vertices_dot;
    Vector6 pose_start_dot = Vector6::Zero();  ///< position, then left rotation: dR = [phi] R
    Matrix34 velocity_start_dot = Matrix34::Zero();
    double density_dot = 0;
    Vector3 force_dot = Vector3::Zero(), torque_dot = Vector3::Zero();
    std::vector<Vector6> increment_dot;  ///< [step]
};
using MechanismTangent = MechanismGradient;
struct ModelTangent {
    std::vector<BodyTangent> bodies;
    Vector3 gravity_dot = Vector3::Zero();
    FrictionGradient friction_dot;
    double dmin_dot = 0;
    MechanismTangent mechanism;
};
ModelTangent zero_model_tangent(const core::model::Model& model, int steps);

}  // namespace fettle::adjoint
