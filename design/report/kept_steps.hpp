// SPDX-License-Identifier: MIT
/// The tables that a run left in its folder (core/records/step_tables.hpp), read back into the values that its simulation had.
#pragma once

#include <filesystem>
#include <string>

#include "design/report/step_curves.hpp"

namespace fettle::design::report {

/// The tables' texts; empty: there is none.
struct StepTables {
    std::string steps, contacts, drives, joints;
};
StepTables read_step_tables(const std::filesystem::path& folder);

/// Adds all of their rows.
void add_steps(const StepTables& tables, StepCurves& curves);

}  // namespace fettle::design::report
