// SPDX-License-Identifier: MIT
/// Does one body lie inside the other's material? The one place of design/ that asks. A distance of surfaces cannot tell: a ball in the
/// middle of a block is as far from the block's surface as one beside it.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/model/model.hpp"

namespace fettle::design::quantities {

/// "`ball` lies inside the material of `block`", or empty. Decided exactly at the world positions as rounded, for closed bodies; a body
/// that is not closed has no inside. Contract: the surfaces do not meet at these poses.
std::string containment(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses, int a, int b);

}  // namespace fettle::design::quantities
