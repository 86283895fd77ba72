// SPDX-License-Identifier: MIT
/// The degrees of freedom that a linear system is solved for, and their numbering.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::linear {

struct FreeDofs {
    std::vector<std::array<int, 6>> index;        ///< [body][dof]: number of the unknown, or -1 if prescribed; 0 .. count - 1, increasing
    std::vector<std::pair<int, int>> prescribed;  ///< the others: body, dof
    int count = 0;

    /// The next body. @param is_free  of a dof, 0 .. 5: whether it is solved for
    template <class IsFree>
    void add_body(const IsFree& is_free) {
        const auto body = count_of(index);
        std::array<int, 6>& numbers = index.emplace_back();
        for (int k = 0; k < 6; ++k) {
            numbers[k] = is_free(k) ? count++ : -1;
            if (numbers[k] < 0) prescribed.emplace_back(body, k);
        }
    }
};

/// Are all six DOFs of a body free? Then they follow one another.
inline bool are_all_free(const std::array<int, 6>& index) { return index[0] >= 0 && index[5] == index[0] + 5; }
/// Is none of them?
inline bool is_none_free(const std::array<int, 6>& index) {
    for (const int k : index)
        if (k >= 0) return false;
    return true;
}

/// Entries of the free DOFs of a per-body vector, and back (prescribed entries are left alone).
VectorX gather(const FreeDofs& dofs, const std::vector<Vector6>& values);
void scatter(const FreeDofs& dofs, const Eigen::Ref<const VectorX>& free_values, std::vector<Vector6>& values);

}  // namespace fettle::core::linear
