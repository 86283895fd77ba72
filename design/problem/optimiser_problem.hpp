// SPDX-License-Identifier: MIT
/// A design as what optimisers see: optimisers/problem.hpp.
#pragma once

#include "design/optimisers/problem.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::problem {

/// Start, bounds narrowed by their margins, relations, `refusal`, and `evaluate`, which does what `options` says. Must not outlive the
/// problem.
optimisers::Problem optimiser_problem(const DesignProblem& problem, const EvaluateOptions& options = {});

/// The same options, values alone.
EvaluateOptions without_gradients(EvaluateOptions options);

/// An evaluation as optimisers take it; a number that is not finite makes it a failure. Throws optimisers::Interrupted if it was.
optimisers::Evaluation optimiser_evaluation(const DesignEvaluation& evaluation);

}  // namespace fettle::design::problem
