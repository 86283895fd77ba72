// SPDX-License-Identifier: MIT
/// Whether two formulas are written alike.
#pragma once

#include <algorithm>

#include "core/expression/formula.hpp"

namespace fettle::design::reading {

/// The same operations on the same inputs, in the same order. False for formulas that are equal and written in another way.
inline bool is_same_formula(const core::expression::Formula& a, const core::expression::Formula& b) {
    const auto is_same_node = [](const core::expression::Node& x, const core::expression::Node& y) {
        return x.operation == y.operation && x.operands == y.operands && x.number == y.number;
    };
    return same(a.dimension, b.dimension) && a.inputs == b.inputs &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), is_same_node);
}

}  // namespace fettle::design::reading
