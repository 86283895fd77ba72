// SPDX-License-Identifier: MIT
#include "core/solver/failure.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/model/limits.hpp"

namespace fettle::core::solver {
namespace {

struct Closest {
    const contact::BodyPairContacts* pair = nullptr;
    double distance = 0;
};

Closest closest_of(const contact::ContactSet& contacts) {
    Closest closest;
    for (const contact::BodyPairContacts& pair : contacts.pairs)
        for (const contact::ContactPair& c : pair.contacts)
            if (const double gap = gap_of(c); !closest.pair || gap < closest.distance) closest = {&pair, gap};
    return closest;
}

// The kappa with which the force of the closest pair, kappa b'(d) d, would be reached at half the activation distance, but no more than is
// advised; 0: the present one.
double sufficient_kappa(const FailedStep& step) {
    const model::Model& model = *step.problem.model;
    const double d = step.contacts.minimum_distance, half = model.dmin + 0.5 * model.dhat;
    if (!(d > model.dmin) || d >= half) return 0;
    const auto slope = [&](double at) {
        return at * contact::barrier(at * at - model.dmin * model.dmin, step.problem.barrier.gap_hat).first;
    };
    return step.problem.kappa * std::min(slope(d) / slope(half), model::largest_kappa_rise);
}

// What the rows would carry here if nothing were driven any further: C^T m = -dE as well as it can be met, by mass.
VectorX holding_multipliers(const FailedStep& step) {
    const model::Model& model = *step.problem.model;
    const energy::ChartDerivatives d =
        energy::chart_derivatives(step.problem, *step.points, *step.poses, step.contacts, contact::HessianKind::projected);
    constraint::RowJacobian rows = row_jacobian(model.mechanism.set, model.mechanism.rows, placed(model.mechanism.set.frames, *step.poses));
    std::vector<Matrix3> left_jacobians;
    kinematics::BlockHessian masses;
    for (std::size_t i = 0; i < step.points->size(); ++i) {
        left_jacobians.push_back(kinematics::left_jacobian((*step.points)[i].rotation_vector));
        Matrix6 to_tangent = Matrix6::Identity();
        to_tangent.bottomRightCorner<3, 3>() = left_jacobians.back();
        masses.diagonal.push_back(to_tangent.transpose() * kinematics::mass_matrix((*step.poses)[i].rotation, model.bodies[i].moments) *
                                  to_tangent);
    }
    constraint::to_chart(left_jacobians, rows);
    linear::LinearSystem system(free_dofs(model));
    system.factorise(masses, rows);
    if (!system.is_usable()) return step.rows->multipliers();
    return system.solve_refined(masses, rows, -gather(system.dofs(), d.gradient), VectorX::Zero(rows.count())).multipliers;
}

// The stop that is pressed most.
void describe_stop(const FailedStep& step, std::ostringstream& out) {
    if (!step.rows) return;
    const model::Mechanism& mechanism = step.problem.model->mechanism;
    const std::vector<measure::PlacedFrame> frames = placed(mechanism.set.frames, *step.poses);
    const model::MeasureTerm* nearest = nullptr;
    double least = step.problem.model->dhat;
    for (const model::MeasureTerm& term : mechanism.terms) {
        if (term.kind != model::LawKind::stop) continue;
        const double m = constraint::value_at(mechanism.set, term.measure, frames, step.problem.mechanism.angles);
        const double gap = term.sign * term.length * (m - term.reference);
        if (!(gap < least)) continue;
        least = gap;
        nearest = &term;
    }
    if (!nearest) return;
    const char* which = model::is_swing(mechanism, *nearest) ? "the end of its swing"
                        : nearest->sign > 0                  ? "its lower limit"
                                                             : "its upper limit";
    out << "; '" << nearest->name << "' is at " << which;
}

// The joint or motor that is farthest from where it should be, and what it pushes with.
void describe_unmet_row(const FailedStep& step, std::ostringstream& out) {
    const double unit = step.problem.model->length_unit;
    const model::Mechanism& mechanism = step.problem.model->mechanism;
    const VectorX& unmet = step.rows->unmet();
    Eigen::Index worst = -1;
    double most = 0;
    for (Eigen::Index i = 0; i < unmet.size(); ++i) {
        const double gap = std::abs(unmet[i]) * mechanism.rows[i].length;
        if (gap <= most) continue;
        most = gap;
        worst = i;
    }
    if (worst < 0) return;
    const model::Joint& joint = mechanism.joints[mechanism.rows[worst].owner];
    if (!joint.is_motor) {
        out << "joint '" << joint.name << "' is not met (" << base::length_text(most, unit) << " short): ";
        return;
    }
    const bool turns = mechanism.set.measures[joint.coordinate].kind == measure::MeasureKind::angle;
    const double short_by = std::abs(unmet[worst]);
    out << "motor '" << joint.name << "' cannot follow its curve ("
        << (turns ? base::format_quantity(short_by, "deg", 3) : base::length_text(short_by, unit)) << " short, with ";
    out << std::abs(holding_multipliers(step)[worst]) / step.problem.weight << (turns ? " N m): " : " N): ");
}

// What would keep the closest pair farther apart, if it is nearer than half the contact distance.
void describe_stiffness(const FailedStep& step, std::ostringstream& out) {
    const double wanted = sufficient_kappa(step);
    if (!(wanted > step.problem.kappa)) return;
    const char* unit = step.problem.model->area_weighted ? " N/m^3" : " N/m";
    const bool is_enough = wanted < model::largest_kappa_rise * step.problem.kappa;
    out << "; contact is soft for these forces: " << (is_enough ? "with" : "if the way is free, try") << " `contact.kappa` at " << wanted
        << unit << " in place of " << step.problem.kappa << unit << (is_enough ? " they would leave half of the contact distance" : "");
}

}  // namespace

std::string describe_failure(const FailedStep& step) {
    const std::vector<model::Body>& bodies = step.problem.model->bodies;
    const double unit = step.problem.model->length_unit;
    std::ostringstream out;
    out.precision(4);
    int held = -1;
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Vector6& r = step.remaining[i];
        const double left = r.head<3>().norm() + r.tail<3>().norm() * bodies[i].radius;
        if (left <= most) continue;
        most = left;
        held = static_cast<int>(i);
    }
    if (held >= 0) out << "body '" << bodies[held].name << "' cannot follow its script (" << base::length_text(most, unit) << " short): ";
    if (held < 0 && step.rows) describe_unmet_row(step, out);
    out << step.cause;
    if (step.limiting.limiting_a >= 0)
        out << "; '" << bodies[step.limiting.limiting_a].name << "' against '" << bodies[step.limiting.limiting_b].name << "'";
    describe_stop(step, out);
    if (const Closest closest = closest_of(step.contacts); closest.pair)
        out << "; closest pair '" << bodies[closest.pair->first].name << "' and '" << bodies[closest.pair->second].name << "' at "
            << base::length_text(closest.distance, unit)
            << (closest.distance <= step.problem.model->dmin  // only round surfaces can be: meshes are kept apart
                    ? " between their round surfaces, which contain the facets: leave more gap, take finer facets, or set `contact.round` "
                      "to false"
                    : "");
    out << "; out of balance by " << 100 * step.residual << "% of the forces that act";
    describe_stiffness(step, out);
    return out.str();
}

}  // namespace fettle::core::solver
