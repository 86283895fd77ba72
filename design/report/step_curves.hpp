// SPDX-License-Identifier: MIT
/// Curves over time of a run: the efforts of motors, the loads of bodies and joints, energies. They are gathered from the values of each
/// step: as a simulation makes them, or as its tables have them (kept_steps.hpp).
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/step_outputs.hpp"

namespace fettle::design::report {

/// The motors that drive along lengths, whose effort is a force, by name; that of all others is a torque.
using LinearMotors = std::set<std::string>;
LinearMotors linear_motors(const core::model::Model& model);
LinearMotors linear_motors(const core::scene::Mechanism& mechanism);

/// Lines by name over common times.
class Curve {
public:
    void add(const std::string& name, double time, double value);

    /// Appends a chart to the list, unless it has no line. Lines of no more than `share` of the largest are left out. Where a line has no
    /// value it is 0: a pair that does not touch.
    void append_to(nlohmann::ordered_json& list, const char* title, const char* quantity, const char* unit, double share = 0) const;

private:
    std::vector<double> values(const std::string& name, std::size_t every) const;

    std::map<double, std::size_t> times_;  ///< and their places in the order of arrival
    std::map<std::string, std::vector<std::pair<std::size_t, double>>> lines_;
    std::map<std::string, double> largest_;
};

class StepCurves {
public:
    /// These belong to no run.
    StepCurves() = default;
    /// @param model  its bodies: what holds one that does not move is a force, not a drive.
    StepCurves(const core::model::Model& model, LinearMotors linear);

    /// The energies at a step's end [J]; forces [N], torques [N m].
    void add_energies(double time, double kinetic, double potential, double contact);
    void add_contact(double time, const std::string& a, const std::string& b, double normal);
    void add_drive(double time, const std::string& body, const Vector3& force, const Vector3& torque);
    void add_joint(double time, const std::string& name, const Vector3& force, double effort);
    /// All of a step. @param model  that is simulated
    void add(const core::stepper::StepOutputs& step, const core::model::Model& model);

    /// Has no step been added?
    bool empty() const { return empty_; }
    /// List of {title, quantity, unit, note: null or text, time f64 [s], lines: list of {name, values f64}}; forces in N, torques in N mm,
    /// energies in mJ. At most eight lines a curve, those with the largest values; at most 2000 instants, evenly.
    nlohmann::ordered_json charts() const;

private:
    std::set<std::string> fixed_;
    LinearMotors linear_;
    bool empty_ = true;
    Curve motor_torques_, motor_forces_, carried_, driving_torques_, driving_forces_, held_, normal_, energy_;
};

}  // namespace fettle::design::report
