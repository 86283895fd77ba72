// SPDX-License-Identifier: MIT
#include "core/constraint/dependent_rows.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/linear/dependent_columns.hpp"

namespace fettle::core::constraint {
namespace {

// The mass of the free coordinates, as if the others had the mass 1.
Matrix6 free_mass(Matrix6 mass, const std::array<int, 6>& index) {
    for (int k = 0; k < 6; ++k) {
        if (index[k] >= 0) continue;
        mass.row(k).setZero();
        mass.col(k).setZero();
        mass(k, k) = 1;
    }
    return mass;
}

}  // namespace

std::vector<DependentRow> dependent_rows(const std::vector<Matrix6>& masses, const linear::FreeDofs& dofs, const RowJacobian& rows) {
    std::vector<Eigen::LLT<Matrix6>> factors;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        factors.emplace_back(free_mass(masses[i], dofs.index[i]));
        if (factors.back().info() != Eigen::Success) return {};
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < rows.count(); ++row)
        for (int k = rows.first[row]; k < rows.first[row + 1]; ++k) {
            const auto body = static_cast<std::size_t>(rows.entries[k].body);
            Vector6 gradient = rows.entries[k].gradient;
            for (int i = 0; i < 6; ++i)
                if (dofs.index[body][i] < 0) gradient[i] = 0;
            factors[body].matrixL().solveInPlace(gradient);
            for (int i = 0; i < 6; ++i)
                if (dofs.index[body][i] >= 0) entries.emplace_back(dofs.index[body][i], row, gradient[i]);
        }
    Eigen::SparseMatrix<double> columns(dofs.count, rows.count());
    columns.setFromTriplets(entries.begin(), entries.end());
    std::vector<DependentRow> out;
    for (linear::DependentColumn& found : linear::dependent_columns(std::move(columns), dependent_angle))
        out.push_back({found.column, std::move(found.on)});
    return out;
}

RowJacobian without(const RowJacobian& rows, const std::vector<DependentRow>& left_out) {
    RowJacobian out;
    for (int i = 0; i < rows.count(); ++i) {
        if (std::any_of(left_out.begin(), left_out.end(), [&](const DependentRow& d) { return d.row == i; })) continue;
        out.first.push_back(count_of(out.entries));
        out.entries.insert(out.entries.end(), rows.entries.begin() + rows.first[i], rows.entries.begin() + rows.first[i + 1]);
    }
    out.first.push_back(count_of(out.entries));
    return out;
}

}  // namespace fettle::core::constraint
