// SPDX-License-Identifier: MIT
#include "adjoint/stepper/check_differentiable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "adjoint/energy/contact_terms_adjoint.hpp"
#include "adjoint/energy/incremental_potential_adjoint.hpp"
#include "adjoint/model/body_mass_adjoint.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "core/base/contract.hpp"
#include "core/stepper/prescribed_path.hpp"

namespace fettle::adjoint::stepper {
namespace {

Errors check_scripts(const core::model::Model& model) {
    Errors errors;
    for (const core::model::Body& body : model.bodies) {
        if (body.script.empty()) continue;
        errors.push_back(energy::refusal(body.name, "'" + body.name + "' follows a script of poses, which"));
        errors.back().message += "; prescribed coordinates can";
    }
    return errors;
}

bool agree(const core::model::Model& model, const std::vector<core::kinematics::ChartPoint>& a,
           const std::vector<core::kinematics::ChartPoint>& b) {
    constexpr double settled = 1e-9;  // of the scene's size
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double turned = model.bodies[i].radius * (a[i].rotation_vector - b[i].rotation_vector).norm();
        if (!((a[i].position - b[i].position).norm() + turned <= settled * model.diagonal)) return false;
    }
    return true;
}

// One step says enough.
Errors check_friction_rounds(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    if (!energy::has_friction(model)) return {};
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const core::stepper::TrajectoryStep& step = trajectory.steps[t];
        if (step.friction_rounds.empty())
            return {{core::base::ErrorCode::inconsistent, "step " + std::to_string(t),
                     "the trajectory does not hold where its rounds of friction ended: only one that is in memory, and was simulated for "
                     "gradients, does"}};
        const bool is_quasi_static = model.integrator == core::scene::Integrator::quasi_static;
        if (is_quasi_static && step.friction_rounds.size() > 1 && !agree(model, step.friction_rounds.front(), step.friction_rounds.back()))
            return StepSolver::unsettled(trajectory, static_cast<int>(t));
    }
    return {};
}

// Steps are those of the model, from its start: curves are taken at their times.
Errors check_times(const core::stepper::Trajectory& trajectory) {
    if (trajectory.time_start == 0 && trajectory.times.empty()) return {};
    return {{core::base::ErrorCode::inconsistent, "trajectory",
             "its steps are not the even ones of a simulation from its start at t = 0, and cannot be differentiated"}};
}

// Contact may leave a motion short of its target, by no more than a solve accepts: then it is not the curve that says where the body goes.
Errors check_prescribed(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    constexpr double met = 1e-11;  // of the scene's size
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const std::vector<core::kinematics::ChartPoint>& end = trajectory.steps[t].nodes.back();
        const std::vector<Vector6> targets =
            core::stepper::prescribed_path(model, trajectory.poses[t], static_cast<double>(t) * model.timestep).back().targets;
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const core::model::Body& body = model.bodies[i];
            if (!body.script.empty()) continue;
            double off = 0;
            for (int k = 0; k < 6; ++k) {
                if (is_free(body, k)) continue;
                const double at = k < 3 ? end[i].position[k] : end[i].rotation_vector[k - 3];
                off = std::max(off, std::abs(targets[i][k] - at) * (k < 3 ? 1 : body.radius));
            }
            if (off <= met * model.diagonal) continue;
            std::ostringstream message;
            message
                << "'" << body.name << "' ends the step at t = " << time_at(trajectory, static_cast<int>(t)) << " s " << off
                << " m from where its prescribed motion leads: that step has no derivative. Does contact stop it, or is the trajectory of "
                   "another model?";
            return {{core::base::ErrorCode::inconsistent, "step " + std::to_string(t), message.str()}};
        }
    }
    return {};
}

}  // namespace

Errors check_differentiable(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(trajectory.poses.size() == trajectory.steps.size() + 1, "a trajectory has a pose before and after each step");
    FETTLE_ASSERT(trajectory.poses[0].size() == model.bodies.size(), "the trajectory is of another model");
    FETTLE_ASSERT(trajectory.timestep == model.timestep, "the trajectory was simulated with another time step");
    if (Errors errors = check_times(trajectory); !errors.empty()) return errors;
    Errors errors = energy::check_terms(model);
    for (const Errors& more :
         {model::check_masses(model), check_scripts(model), check_friction_rounds(model, trajectory), check_prescribed(model, trajectory)})
        errors.insert(errors.end(), more.begin(), more.end());
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t)
        for (std::size_t i = 0; i < model.bodies.size(); ++i) {
            const double angle = trajectory.steps[t].nodes.back()[i].rotation_vector.norm();
            if (angle < 1.99 * std::numbers::pi) continue;
            errors.push_back(
                {core::base::ErrorCode::out_of_range, "step " + std::to_string(t),
                 "'" + model.bodies[i].name + "' turns by " + std::to_string(angle) +
                     " rad in one time step, which cannot be differentiated: use a smaller time step (less than a revolution each)"});
        }
    return errors;
}

}  // namespace fettle::adjoint::stepper
