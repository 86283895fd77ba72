// SPDX-License-Identifier: MIT
/// What is wrong with a design that a program made. (Readers report a file's faults with their place in it.)
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "design/description/design.hpp"

namespace fettle::design::problem {

/// Every fault of the parts but the scene, which build_model judges: bodies, dimensions and motors that are not there, bounds that are not
/// in order, names that are not unique, a shape whose part as drawn is not its body's mesh, relations without a finite value at the
/// parameters' values, and what quantities say of themselves. `where` names the parameter, term, constraint or relation.
/// @param models  The models of the scenes as written, one for each scenario; of the scene, if there are none.
Errors check_design(const description::Design& design, const std::vector<core::model::Model>& models);

}  // namespace fettle::design::problem
