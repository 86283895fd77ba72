// SPDX-License-Identifier: MIT
/// The load of a joint or motor at each step's end (core/stepper/joint_outputs.hpp): with m_i the multipliers of its constraints c_i, of
/// the potential times `weight`,
///   force     F = - sum m_i dc_i/dq / weight                 on body b (of a joint with the world alone: on that body), world [N]
///   torque    T = - sum m_i dc_i/dphi / weight - arm x F     on it, about the joint's point in b [N m]
///   effort    - m / weight                                   of a motor, along its joint's coordinate [N], [N m]
/// For a direction n of the world, F . n is the constraints' change along the translation n of the body, times -m_i / weight, and T . n
/// that along the turn n about the joint's point, so that derivatives are of a measure's change along a motion. Conditions of a joint that
/// follow from others carry nothing.
#pragma once

#include <string>

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

enum class JointLoadKind { force, torque, effort };

class JointLoad : public StepSeries {
public:
    struct Of {
        JointLoadKind kind = JointLoadKind::force;
        std::string name;                                ///< of the joint; of the motor (effort)
        Vector3 axis = Vector3::Zero();                  ///< the component along this unit vector, world; 0: the magnitude
        Dimension effort_dimension = Dimension::torque;  ///< of the motor's coordinate: torque or force
    };
    JointLoad(Of of, const Reduction& reduction) : StepSeries(reduction), of_(std::move(of)) {}

    const Of& of() const { return of_; }
    bool has_direction() const override { return of_.kind == JointLoadKind::effort || !of_.axis.isZero(0); }
    Dimension instant_dimension() const override;
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    bool is_magnitude() const override { return !has_direction(); }
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
