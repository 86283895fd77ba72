// SPDX-License-Identifier: MIT
/// The start of a model with joints: dependent rows are reported and left out, bodies assembled, velocities made to agree.
/// docs/method/joints.md#assembly-the-start.
#pragma once

#include "core/base/result.hpp"
#include "core/constraint/assembly.hpp"
#include "core/model/model.hpp"

namespace fettle::core::model {

/// The rows of the model's mechanism at time 0, all bodies where they may move. Not to outlive the model.
constraint::AssemblyProblem start_problem(const Model& model);

/// How fast a row's curve begins.
double rate_at_start(const scene::Curve& curve, double timestep);

/// Contract and errors: build_mechanism.hpp.
base::Errors settle_start(const scene::Scene& scene, Model& model);

}  // namespace fettle::core::model
