// SPDX-License-Identifier: MIT
/// Which constraints of a mechanism are solved for where its bodies stand. Some that follow from others (two hinges on one axis, a flat
/// loop of ordinary hinges) are left out. Which ones can be depends on where the bodies are: those that were kept at the start may come to
/// depend on one another elsewhere, although all constraints together determine as much there as anywhere.
/// docs/method/joints.md#the-step-under-rows.
#pragma once

#include <optional>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::core::model {

/// All rows of a mechanism by number, solved for or not.
std::vector<constraint::Row> all_rows(const Mechanism& mechanism);

/// The numbers of the rows that follow from the others at these poses, ascending. Nothing, if these are those that the model leaves out
/// already, or if more of them follow there (a dead centre).
std::optional<std::vector<int>> rows_to_leave_out(const Model& model, const std::vector<kinematics::Pose>& poses);

/// The same model with these rows as Mechanism::dependent, and all others as `rows`.
Model without_rows(Model model, const std::vector<int>& left_out);

}  // namespace fettle::core::model
