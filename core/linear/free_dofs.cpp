// SPDX-License-Identifier: MIT
#include "core/linear/free_dofs.hpp"

namespace fettle::core::linear {

VectorX gather(const FreeDofs& dofs, const std::vector<Vector6>& values) {
    VectorX out(dofs.count);
    for (std::size_t body = 0; body < values.size(); ++body) {
        const std::array<int, 6>& index = dofs.index[body];
        if (are_all_free(index)) {
            out.segment<6>(index[0]) = values[body];
            continue;
        }
        for (int k = 0; k < 6; ++k)
            if (index[k] >= 0) out[index[k]] = values[body][k];
    }
    return out;
}

void scatter(const FreeDofs& dofs, const Eigen::Ref<const VectorX>& free_values, std::vector<Vector6>& values) {
    for (std::size_t body = 0; body < values.size(); ++body) {
        const std::array<int, 6>& index = dofs.index[body];
        if (are_all_free(index)) {
            values[body] = free_values.segment<6>(index[0]);
            continue;
        }
        for (int k = 0; k < 6; ++k)
            if (index[k] >= 0) values[body][k] = free_values[index[k]];
    }
}

}  // namespace fettle::core::linear
