// SPDX-License-Identifier: MIT
#include "core/solver/touching_groups.hpp"

#include <algorithm>
#include <numeric>

#include "core/energy/step_problem.hpp"

namespace fettle::core::solver {

std::vector<int> touching_groups(const model::Model& model, const contact::ContactSet& contacts, const contact::FrictionSet& friction) {
    std::vector<int> parent(model.bodies.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](int i) {
        while (parent[i] != i) {
            int& above = parent[i];
            above = parent[above];
            i = above;
        }
        return i;
    };
    const auto join = [&](int a, int b) {
        if (!energy::has_free_dof(model.bodies[a])) return;
        if (!energy::has_free_dof(model.bodies[b])) return;
        const auto [low, high] = std::minmax({root(a), root(b)});
        parent[high] = low;
    };
    for (const contact::BodyPairContacts& pair : contacts.pairs) join(pair.first, pair.second);
    for (const contact::BodyPairFriction& pair : friction.pairs) join(pair.first, pair.second);
    for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
    return parent;
}

}  // namespace fettle::core::solver
