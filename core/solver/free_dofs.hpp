// SPDX-License-Identifier: MIT
/// The degrees of freedom that are solved for.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::solver {

/// Their numbering.
struct FreeDofs {
    std::vector<std::array<int, 6>> index;        ///< [body][dof]: column, or -1 if prescribed
    std::vector<std::pair<int, int>> prescribed;  ///< the others: body, dof
    int count = 0;
};
FreeDofs free_dofs(const model::Model& model);
/// Of a body's DOFs: are all six free? Then they follow one another.
inline bool are_all_free(const std::array<int, 6>& index) { return index[0] >= 0 && index[5] == index[0] + 5; }

/// Entries of the free DOFs of a per-body vector, and back (prescribed entries are left alone).
VectorX gather(const FreeDofs& dofs, const std::vector<Vector6>& values);
void scatter(const FreeDofs& dofs, const VectorX& free_values, std::vector<Vector6>& values);

}  // namespace fettle::core::solver
