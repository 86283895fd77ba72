// SPDX-License-Identifier: MIT
#include "fettle/core/constraint/dependent_rows.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/constraint/saddle_solver.hpp"

namespace fettle::core::constraint {

std::vector<DependentRow> dependent_rows(const std::vector<Matrix6>& masses, const std::vector<std::array<int, 6>>& index, int count,
                                         const RowJacobian& rows) {
    std::vector<DependentRow> out;
    if (rows.count() == 0) return out;
    SaddleSolver solver(index, count);
    kinematics::BlockHessian hessian;
    hessian.diagonal = masses;
    solver.factorise(hessian, rows);
    if (!solver.is_usable()) return out;
    const VectorX pivots = solver.relative_pivots();
    for (int i = 0; i < rows.count(); ++i)
        if (pivots[i] < dependent_pivot) out.push_back({i, {}});
    if (out.empty()) return out;

    // Of what is left no row depends on others: C^T m = (the row left out) has one solution.
    std::vector<int> kept;
    for (int i = 0; i < rows.count(); ++i)
        if (!(pivots[i] < dependent_pivot)) kept.push_back(i);
    const RowJacobian independent = without(rows, out);
    solver.factorise(hessian, independent);
    if (!solver.is_usable()) return out;
    constexpr double counts = 1e-6;  // of the largest share
    for (DependentRow& dependent : out) {
        VectorX r = VectorX::Zero(count);
        for (int k = rows.first[dependent.row]; k < rows.first[dependent.row + 1]; ++k)
            for (int i = 0; i < 6; ++i)
                if (index[rows.entries[k].body][i] >= 0) r[index[rows.entries[k].body][i]] += rows.entries[k].gradient[i];
        const VectorX shares = solver.solve(r, VectorX::Zero(independent.count())).multipliers;
        const double largest = shares.size() > 0 ? shares.cwiseAbs().maxCoeff() : 0;
        for (int i = 0; i < independent.count(); ++i)
            if (std::abs(shares[i]) > counts * largest) dependent.on.push_back(kept[i]);
    }
    return out;
}

RowJacobian without(const RowJacobian& rows, const std::vector<DependentRow>& left_out) {
    RowJacobian out;
    for (int i = 0; i < rows.count(); ++i) {
        if (std::any_of(left_out.begin(), left_out.end(), [&](const DependentRow& d) { return d.row == i; })) continue;
        out.first.push_back(static_cast<int>(out.entries.size()));
        out.entries.insert(out.entries.end(), rows.entries.begin() + rows.first[i], rows.entries.begin() + rows.first[i + 1]);
    }
    out.first.push_back(static_cast<int>(out.entries.size()));
    return out;
}

}  // namespace fettle::core::constraint
