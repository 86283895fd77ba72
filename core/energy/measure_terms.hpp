// SPDX-License-Identifier: MIT
/// Springs, dampers, stops, friction of joints, forces of motors and loads at points as one term of the incremental potential, each an
/// energy of one measure m. Reports their energy and the force along each. docs/method/joints.md#springs-dampers-stops-friction.
///   spring    1/2 c (m - reference)^2
///   damper    1/2 c (m - m_slip)^2 / slip_time                              nothing in a quasi-static step
///   force     -f m, f the curve at the step's end
///   stop      c (dhat/w) b(g), g = sign length (m - reference) + w, w = stop_give dhat:
///             b(g) = -(g - w)^2 ln(g/w) for 0 < g < w, else 0; infinite for g <= 0
///   friction  c f0(|m - m_slip| length) / length,   f0 of contact/friction.hpp with e = eps_v slip_time
/// each times the integrator's weight (time_integration.hpp).
#pragma once

#include "core/energy/step_problem.hpp"
#include "core/energy/term.hpp"

namespace fettle::core::energy {

struct LawValue {
    double value = 0, first = 0, second = 0;  ///< and derivatives in m
    double majorant = 0;                      ///< a second derivative >= 0 that Newton's method may take in its place
};

/// @param m  the measure, an angle with its turns. Derivatives of a stop are of g > 0 only.
LawValue measure_law(const StepProblem& problem, const model::MeasureTerm& term, double m);

extern const CouplingTerm measure_terms;

}  // namespace fettle::core::energy
