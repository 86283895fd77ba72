// SPDX-License-Identifier: MIT
#include "fettle/core/solver/free_dofs.hpp"

namespace fettle::core::solver {

FreeDofs free_dofs(const model::Model& model) {
    FreeDofs dofs;
    for (const model::Body& body : model.bodies) {
        std::array<int, 6> index;
        for (int k = 0; k < 6; ++k) index[k] = model::is_free(body, k) ? dofs.count++ : -1;
        dofs.index.push_back(index);
    }
    return dofs;
}

VectorX gather(const FreeDofs& dofs, const std::vector<Vector6>& values) {
    VectorX out(dofs.count);
    for (std::size_t body = 0; body < values.size(); ++body)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[body][k] >= 0) out[dofs.index[body][k]] = values[body][k];
    return out;
}

void scatter(const FreeDofs& dofs, const VectorX& free_values, std::vector<Vector6>& values) {
    for (std::size_t body = 0; body < values.size(); ++body)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[body][k] >= 0) values[body][k] = free_values[dofs.index[body][k]];
}

}  // namespace fettle::core::solver
