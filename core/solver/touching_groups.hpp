// SPDX-License-Identifier: MIT
/// Bodies whose motions depend on one another within a step: the components of the graph of contacts.
#pragma once

#include <vector>

#include "core/contact/contact_set.hpp"
#include "core/contact/friction.hpp"
#include "core/model/model.hpp"

namespace fettle::core::solver {

/// [body] the least body of its group. Bodies with nothing free couple no others: each is a group of its own.
std::vector<int> touching_groups(const model::Model& model, const contact::ContactSet& contacts, const contact::FrictionSet& friction);

}  // namespace fettle::core::solver
