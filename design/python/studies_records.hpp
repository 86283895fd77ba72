// SPDX-License-Identifier: MIT
/// The members of what audits and optimisations answer, for records.hpp.
#pragma once

#include "fettle/design/python/design_records.hpp"
#include "fettle/design/studies/difference_check.hpp"
#include "fettle/design/studies/optimise_design.hpp"

FETTLE_WORDS(fettle::design::optimisers::OptimiserStatus, "optimal", "feasible", "infeasible", "interrupted", "start_failed")
FETTLE_WORDS(fettle::design::optimisers::Held, "stationary", "lower bound", "upper bound", "constraints", "nothing")
FETTLE_RECORD(fettle::design::optimisers::StageReport, "StageReport", field("model", &Type::model),
              field("evaluations", &Type::evaluations), field("objective", &Type::objective), field("violation", &Type::violation),
              field("message", &Type::message))
FETTLE_RECORD(fettle::design::optimisers::Optimality, "Optimality", field("judged", &Type::judged),
              field("predicted_gain", &Type::predicted_gain), field("worth", &Type::worth), field("radius", &Type::radius),
              field("step", &Type::step), field("multipliers", &Type::multipliers), field("residual", &Type::residual),
              field("held", &Type::held), field("improvable", &Type::improvable), field("noise", &Type::noise),
              field("noise_in_objective", &Type::noise_in_objective), field("roughest", &Type::roughest))
FETTLE_RECORD(fettle::design::optimisers::OptimiserReport, "OptimiserReport", field("status", &Type::status),
              field("message", &Type::message), field("point", &Type::point), field("feasible", &Type::feasible),
              field("optimality", &Type::optimality), field("evaluations", &Type::evaluations), field("failures", &Type::failures),
              field("iterations", &Type::iterations), field("budget_spent", &Type::budget_spent), field("stages", &Type::stages))
FETTLE_RECORD(fettle::design::studies::OptimiseOutcome, "OptimiseOutcome", field("report", &Type::report), field("start", &Type::start),
              field("objective_start", &Type::objective_start), field("final", &Type::final), field("clearance", &Type::clearance),
              field("limits", &Type::limits), field("unbuildable", &Type::unbuildable), field("replayed", &Type::replayed))
FETTLE_RECORD(fettle::design::studies::CheckRow, "CheckRow", field("quantity", &Type::quantity), field("parameter", &Type::parameter),
              field("adjoint", &Type::adjoint), field("difference", &Type::difference), field("difference_error", &Type::difference_error),
              field("relative_error", &Type::relative_error), field("kink", &Type::kink), field("resolved", &Type::resolved))
FETTLE_RECORD(fettle::design::studies::CheckReport, "CheckReport", field("rows", &Type::rows),
              field("largest_relative_error", &Type::largest_relative_error), field("first_step", &Type::first_step),
              field("simulations", &Type::simulations), field("failures", &Type::failures), field("interrupted", &Type::interrupted))
