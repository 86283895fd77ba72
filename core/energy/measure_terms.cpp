// SPDX-License-Identifier: MIT
#include "core/energy/measure_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/linear/positive_part.hpp"

namespace fettle::core::energy {

namespace {

LawValue quadratic(double stiffness, double away) { return {0.5 * stiffness * away * away, stiffness * away, stiffness, stiffness}; }

double slip_reference(const StepProblem& problem, const model::MeasureTerm& term) { return problem.mechanism.measures[term.measure]; }

LawValue stop(const StepProblem& problem, const model::MeasureTerm& term, double m) {
    const double width = model::stop_give * problem.model->dhat, scale = term.sign * term.length;
    const double away = scale * (m - term.reference), g = away + width;
    if (!(g > 0)) return {std::numeric_limits<double>::infinity(), 0, 0, 0};
    if (away >= 0) return {};
    const double c = problem.weight * term.coefficient / model::stop_give, log = std::log(g / width);
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

namespace {

using Frames = std::vector<measure::PlacedFrame>;

double measure_at(const StepProblem& problem, int measure, const Frames& frames) {
    return constraint::value_at(problem.model->mechanism.set, measure, frames, problem.mechanism.angles);
}

double measures_value(const ValueAt& at) {
    const model::Mechanism& mechanism = at.problem.model->mechanism;
    if (mechanism.terms.empty()) return 0;
    const Frames frames = placed(mechanism.set.frames, at.poses);
    double sum = 0;
    for (const model::MeasureTerm& term : mechanism.terms)
        sum += measure_law(at.problem, term, measure_at(at.problem, term.measure, frames)).value;
    return sum;
}

// The derivatives of one term in the bodies of its measure.
struct TermGradient {
    int a = 0, b = 0;
    measure::PoseGradients gradient;
    Matrix12 hessian;
};

TermGradient derivatives_of(const DerivativesAt& at, const model::MeasureTerm& term, const Frames& frames) {
    const measure::MeasureSet& set = at.problem.model->mechanism.set;
    const measure::Measure& m = set.measures[term.measure];
    const measure::VectorFunction f = vector_function(m, frames);
    const LawValue law = measure_law(at.problem, term, measure_at(at.problem, term.measure, frames));
    TermGradient out;
    out.a = set.frames[m.a].body;
    out.b = set.frames[m.b].body;
    out.gradient = pose_gradients(m, f, frames);
    Vector12 along;
    along << tangent_gradient(out.gradient.a), tangent_gradient(out.gradient.b);
    const bool exact = at.kind == contact::HessianKind::exact;
    out.hessian = (exact ? law.second : law.majorant) * along * along.transpose();
    if (!f.is_linear() && law.first != 0) out.hessian += law.first * gauss_newton_hessian(m, f, frames);
    if (!exact && law.first != 0) out.hessian = linear::positive_part(linear::symmetric_eigen<12>(out.hessian));
    for (kinematics::PoseGradient* side : {&out.gradient.a, &out.gradient.b}) {
        side->force *= law.first;
        side->arm *= law.first;
    }
    return out;
}

void add_side(const model::Model& model, int body, const kinematics::PoseGradient& gradient, const Eigen::Ref<const Matrix6>& hessian,
              CouplingDerivatives& d) {
    if (body == measure::world) return;
    const auto i = static_cast<std::size_t>(body);
    d.gradient[i].force += gradient.force;
    d.gradient[i].arm += gradient.arm;
    d.magnitude[i] += std::max(gradient.force.norm(), gradient.arm.norm() / std::max(model.bodies[i].radius, model.dhat));
    d.hessian.diagonal[i] += hessian;
}

void add_measures_derivatives(const DerivativesAt& at, CouplingDerivatives& d) {
    const model::Mechanism& mechanism = at.problem.model->mechanism;
    if (mechanism.terms.empty()) return;
    const Frames frames = placed(mechanism.set.frames, at.poses);
    std::vector<kinematics::OffDiagonalBlock> blocks;
    for (const model::MeasureTerm& term : mechanism.terms) {
        const TermGradient t = derivatives_of(at, term, frames);
        add_side(*at.problem.model, t.a, t.gradient.a, t.hessian.topLeftCorner<6, 6>(), d);
        add_side(*at.problem.model, t.b, t.gradient.b, t.hessian.bottomRightCorner<6, 6>(), d);
        if (t.a == measure::world || t.b == measure::world) continue;
        if (t.a < t.b)
            blocks.push_back({t.a, t.b, t.hessian.topRightCorner<6, 6>()});
        else
            blocks.push_back({t.b, t.a, t.hessian.bottomLeftCorner<6, 6>()});
    }
    linear::add_blocks(blocks, d.hessian);
}

void add_measures_report(const SolvedStep& step, TermReport& report) {
    const model::Mechanism& mechanism = step.problem.model->mechanism;
    if (mechanism.terms.empty()) return;
    const Frames frames = placed(mechanism.set.frames, step.end.poses);
    const std::vector<double> rates = measure_rates(mechanism.set, step.end.poses, step.end.velocities);
    for (const model::MeasureTerm& term : mechanism.terms) {
        const double m = measure_at(step.problem, term.measure, frames);
        const LawValue law = measure_law(step.problem, term, m);
        const double force = -law.first / step.problem.weight, power = force * rates[term.measure];
        report.measure_forces.push_back(force);
        if (term.kind == model::LawKind::force) report.supplied_power += power;
        if (term.kind == model::LawKind::damper || term.kind == model::LawKind::friction) report.dissipated_power -= power;
        const bool stores = term.kind == model::LawKind::spring || term.kind == model::LawKind::stop;
        if (stores) report.spring_energy += law.value / step.problem.weight;
    }
}

}  // namespace

const CouplingTerm measure_terms{"springs, dampers, stops and forces along measures", measures_value, add_measures_derivatives,
                                 add_measures_report};

}  // namespace fettle::core::energy
