// SPDX-License-Identifier: MIT
/// The start of a model with joints: dependent rows told and set apart, bodies assembled, velocities made to agree. docs/method.md
/// section 9.
#pragma once

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::model {

/// Contract and errors: build_mechanism.hpp.
base::Errors settle_start(const scene::Scene& scene, Model& model);

}  // namespace fettle::core::model
