// SPDX-License-Identifier: MIT
#include "fettle/core/energy/measure_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::energy {
namespace {

LawValue quadratic(double stiffness, double away) { return {0.5 * stiffness * away * away, stiffness * away, stiffness, stiffness}; }

double slip_reference(const StepProblem& problem, const model::MeasureTerm& term) { return problem.mechanism.measures[term.measure]; }

LawValue stop(const StepProblem& problem, const model::MeasureTerm& term, double m) {
    const double dhat = problem.model->dhat, scale = term.sign * term.length, g = scale * (m - term.reference);
    if (!(g > 0)) return {std::numeric_limits<double>::infinity(), 0, 0, 0};
    if (g >= dhat) return {};
    const double c = problem.weight * term.coefficient, away = g - dhat, log = std::log(g / dhat);
    const double second = c * scale * scale * (-2 * log - 4 * away / g + away * away / (g * g));
    return {-c * away * away * log, c * scale * (-2 * away * log - away * away / g), second, second};
}

LawValue friction(const StepProblem& problem, const model::MeasureTerm& term, double m) {
    const double slip = term.length * (m - slip_reference(problem, term)), c = problem.weight * term.coefficient;
    const contact::FrictionMollifier f = contact::friction_mollifier(std::abs(slip), problem.model->friction.eps_v * problem.slip_time);
    return {c * f.value / term.length, c * f.first_by_y * slip, c * f.second * term.length, c * f.first_by_y * term.length};
}

}  // namespace

LawValue measure_law(const StepProblem& problem, const model::MeasureTerm& term, double m) {
    switch (term.kind) {
        case model::LawKind::spring:
            return quadratic(problem.weight * term.coefficient, m - term.reference);
        case model::LawKind::damper:
            return quadratic(problem.damping_weight * term.coefficient, m - slip_reference(problem, term));
        case model::LawKind::force: {
            const double f = problem.weight * term.coefficient * scene::curve_value(term.curve, problem.mechanism.end_time);
            return {-f * m, -f, 0, 0};
        }
        case model::LawKind::stop:
            return stop(problem, term, m);
        case model::LawKind::friction:
            return friction(problem, term, m);
    }
    return {};
}

}  // namespace fettle::core::energy
