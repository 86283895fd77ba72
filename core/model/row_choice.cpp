// SPDX-License-Identifier: MIT
#include "core/model/row_choice.hpp"

#include <algorithm>
#include <utility>

#include "core/constraint/dependent_rows.hpp"
#include "core/kinematics/mass_matrix.hpp"

namespace fettle::core::model {

std::vector<constraint::Row> all_rows(const Mechanism& mechanism) {
    std::vector<constraint::Row> out = mechanism.rows;
    out.insert(out.end(), mechanism.dependent.begin(), mechanism.dependent.end());
    std::sort(out.begin(), out.end(), [](const constraint::Row& a, const constraint::Row& b) { return a.number < b.number; });
    return out;
}

std::optional<std::vector<int>> rows_to_leave_out(const Model& model, const std::vector<kinematics::Pose>& poses) {
    const Mechanism& mechanism = model.mechanism;
    if (mechanism.dependent.empty()) return std::nullopt;
    const std::vector<constraint::Row> all = all_rows(mechanism);
    std::vector<Matrix6> masses;
    for (std::size_t i = 0; i < poses.size(); ++i) masses.push_back(kinematics::mass_matrix(poses[i].rotation, model.bodies[i].moments));
    const constraint::RowJacobian jacobian = row_jacobian(mechanism.set, all, placed(mechanism.set.frames, poses));
    std::vector<int> out, known;
    for (const constraint::DependentRow& row : constraint::dependent_rows(masses, free_dofs(model), jacobian)) out.push_back(row.row);
    for (const constraint::Row& row : mechanism.dependent) known.push_back(row.number);
    if (out == known || out.size() > known.size()) return std::nullopt;
    return out;
}

Model without_rows(Model model, const std::vector<int>& left_out) {
    Mechanism& mechanism = model.mechanism;
    const std::vector<constraint::Row> all = all_rows(mechanism);
    mechanism.rows.clear();
    mechanism.dependent.clear();
    for (const constraint::Row& row : all)
        (std::binary_search(left_out.begin(), left_out.end(), row.number) ? mechanism.dependent : mechanism.rows).push_back(row);
    return model;
}

}  // namespace fettle::core::model
