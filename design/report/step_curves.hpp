// SPDX-License-Identifier: MIT
/// Curves over time from a run's tables: the efforts of motors, the loads of bodies and joints, energies.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

namespace fettle::design::report {

/// The tables' texts (core/records/step_tables.hpp); empty: there is none.
struct StepTables {
    std::string steps, contacts, drives, joints;
};

/// The motors that drive along lengths, whose effort is a force, by name; that of all others is a torque.
using LinearMotors = std::set<std::string>;

/// List of {title, quantity, unit, note: null or text, time f64 [s], lines: list of {name, values f64}}; forces in N, torques in N mm,
/// energies in mJ. At most eight lines a curve, those with the largest values; at most 2000 instants, evenly.
/// @param fixed  bodies that do not move: what holds them is a force, not a drive.
nlohmann::ordered_json step_curves(const StepTables& tables, const std::set<std::string>& fixed, const LinearMotors& linear);

}  // namespace fettle::design::report
