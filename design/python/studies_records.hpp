// SPDX-License-Identifier: MIT
/// The members of what audits and optimisations answer, for records.hpp.
#pragma once

#include "design/gradient_audit/difference_check.hpp"
#include "design/python/design_records.hpp"
#include "design/studies/optimise_design.hpp"

FETTLE_WORDS(fettle::design::optimisers::OptimiserStatus, "optimal", "feasible", "infeasible", "interrupted", "start_failed")
FETTLE_WORDS(fettle::design::optimisers::Held, "stationary", "lower bound", "upper bound", "constraints", "nothing")
FETTLE_RECORD(fettle::design::optimisers::StageReport, "StageReport", field("model", &Type::model),
              field("evaluations", &Type::evaluations), field("objective", &Type::objective), field("violation", &Type::violation),
              field("message", &Type::message))
FETTLE_RECORD(fettle::design::optimisers::Optimality, "Optimality", field("judged", &Type::judged),
              field("predicted_gain", &Type::predicted_gain), field("worth", &Type::worth), field("radius", &Type::radius),
              field("step", &Type::step), field("multipliers", &Type::multipliers), field("residual", &Type::residual),
              field("held", &Type::held), field("refused", &Type::refused), field("improvable", &Type::improvable),
              field("noise", &Type::noise), field("noise_in_objective", &Type::noise_in_objective), field("roughest", &Type::roughest))
FETTLE_RECORD(fettle::design::optimisers::OptimiserReport, "OptimiserReport", field("status", &Type::status),
              field("message", &Type::message), field("point", &Type::point), field("objective", &Type::objective),
              field("violation", &Type::violation), field("feasible", &Type::feasible), field("optimality", &Type::optimality),
              field("evaluations", &Type::evaluations), field("failures", &Type::failures), field("iterations", &Type::iterations),
              field("budget_spent", &Type::budget_spent), field("stages", &Type::stages))
FETTLE_RECORD(fettle::core::model::JointSide, "JointSide", field("joint", &Type::joint), field("assemble", &Type::assemble))
FETTLE_RECORD(fettle::design::studies::OptimiseOutcome, "OptimiseOutcome", field("report", &Type::report), field("start", &Type::start),
              field("sides", &Type::sides), field("objective_start", &Type::objective_start), field("final", &Type::final),
              field("clearance", &Type::clearance), field("limits", &Type::limits), field("unbuildable", &Type::unbuildable),
              field("replayed", &Type::replayed))
FETTLE_RECORD(fettle::design::gradient_audit::CheckRow, "CheckRow", field("quantity", &Type::quantity),
              field("parameter", &Type::parameter), field("adjoint", &Type::adjoint), field("difference", &Type::difference),
              field("difference_error", &Type::difference_error), field("relative_error", &Type::relative_error),
              field("kink", &Type::kink), field("lies_between", &Type::lies_between), field("resolved", &Type::resolved))
FETTLE_RECORD(fettle::design::gradient_audit::LineRow, "LineRow", field("quantity", &Type::quantity), field("adjoint", &Type::adjoint),
              field("difference", &Type::difference), field("difference_error", &Type::difference_error),
              field("relative_error", &Type::relative_error), field("resolved", &Type::resolved), field("kink", &Type::kink),
              field("lies_between", &Type::lies_between), field("slope", &Type::slope))
FETTLE_RECORD(fettle::design::gradient_audit::SweepAgreement, "SweepAgreement", field("disagreement", &Type::disagreement),
              field("quantity", &Type::quantity), field("failure", &Type::failure))
FETTLE_WORDS(fettle::design::optimisers::NoiseStatus, "detected", "spacing_too_small", "spacing_too_large")
FETTLE_RECORD(fettle::design::optimisers::NoiseLevel, "NoiseLevel", field("noise", &Type::noise),
              field("second_derivative", &Type::second_derivative), field("third_derivative", &Type::third_derivative),
              field("second_derivative_error", &Type::second_derivative_error),
              field("third_derivative_error", &Type::third_derivative_error), field("status", &Type::status))
FETTLE_RECORD(fettle::design::gradient_audit::QuantityRoughness, "QuantityRoughness", field("name", &Type::name),
              field("size", &Type::size), field("slope", &Type::slope), field("noise", &Type::noise), field("fine", &Type::fine),
              field("rounding", &Type::rounding), field("holds", &Type::holds), field("breaks", &Type::breaks),
              field("tolerance", &Type::tolerance), field("rough", &Type::rough))
FETTLE_RECORD(fettle::design::gradient_audit::RoughnessReport, "RoughnessReport", field("measured", &Type::measured),
              field("direction", &Type::direction), field("spacing", &Type::spacing), field("fine_spacing", &Type::fine_spacing),
              field("quantities", &Type::quantities), field("simulations", &Type::simulations), field("failures", &Type::failures),
              field("interrupted", &Type::interrupted))
FETTLE_WORDS(fettle::design::gradient_audit::ContactFeature::Kind, "vertex", "edge", "face")
FETTLE_RECORD(fettle::design::gradient_audit::ContactFeature, "ContactFeature", field("kind", &Type::kind),
              field("vertices", &Type::vertices))
FETTLE_RECORD(fettle::design::gradient_audit::ContactState, "ContactState", field("a", &Type::a), field("b", &Type::b),
              field("on_a", &Type::on_a), field("on_b", &Type::on_b), field("place", &Type::place),
              field("is_mollified", &Type::is_mollified), field("slides", &Type::slides))
FETTLE_WORDS(fettle::design::gradient_audit::ContactEvent, "touch", "part", "new_features", "parallel", "crossing", "slide", "stick")
// `is` and `from` are words of Python's own.
FETTLE_RECORD(fettle::design::gradient_audit::ContactDifference, "ContactDifference", field("event", &Type::event),
              field("step", &Type::step), field("was", &Type::was), field("is_", &Type::is), field("others", &Type::others))
FETTLE_RECORD(fettle::design::gradient_audit::ContactChange, "ContactChange", field("parameter", &Type::parameter),
              field("from_", &Type::from), field("to", &Type::to), field("share", &Type::share), field("at", &Type::at),
              field("body_a", &Type::body_a), field("body_b", &Type::body_b), field("time", &Type::time), field("count", &Type::count),
              field("scenario", &Type::scenario))
FETTLE_RECORD(fettle::design::gradient_audit::CheckReport, "CheckReport", field("rows", &Type::rows), field("along", &Type::along),
              field("sweeps", &Type::sweeps), field("left_out", &Type::left_out),
              field("largest_relative_error", &Type::largest_relative_error), field("roughness", &Type::roughness),
              field("first_step", &Type::first_step), field("contact_changes", &Type::contact_changes),
              field("contacts_reach", &Type::contacts_reach), field("simulations", &Type::simulations), field("failures", &Type::failures),
              field("interrupted", &Type::interrupted))
