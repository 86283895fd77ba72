// SPDX-License-Identifier: MIT
#include "fettle/core/solver/failure.hpp"

#include <cmath>
#include <sstream>

namespace fettle::core::solver {
namespace {

struct Closest {
    const contact::BodyPairContacts* pair = nullptr;
    double distance_squared = 0;
};

Closest closest_of(const contact::ContactSet& contacts) {
    Closest closest;
    for (const contact::BodyPairContacts& pair : contacts.pairs)
        for (const contact::ContactPair& c : pair.contacts)
            if (!closest.pair || c.closest.distance_squared < closest.distance_squared) closest = {&pair, c.closest.distance_squared};
    return closest;
}

// The kappa with which the force of the closest pair, kappa b'(d) d, would be reached at half the activation distance; 0: the present one.
double sufficient_kappa(const FailedStep& step) {
    const model::Model& model = *step.problem.model;
    const double d = step.contacts.minimum_distance, half = model.dmin + 0.5 * model.dhat;
    if (!(d > model.dmin) || d >= half) return 0;
    const auto slope = [&](double at) {
        return at * contact::barrier(at * at - model.dmin * model.dmin, step.problem.barrier.gap_hat).first;
    };
    return step.problem.kappa * slope(d) / slope(half);
}

// The joint or motor that is farthest from where it should be, and what it pushes with.
void describe_unmet_row(const FailedStep& step, std::ostringstream& out) {
    const model::Mechanism& mechanism = step.problem.model->mechanism;
    const VectorX& unmet = step.rows->unmet();
    Eigen::Index worst = -1;
    double most = 0;
    for (Eigen::Index i = 0; i < unmet.size(); ++i) {
        const double gap = std::abs(unmet[i]) * mechanism.rows[static_cast<std::size_t>(i)].length;
        if (gap <= most) continue;
        most = gap;
        worst = i;
    }
    if (worst < 0) return;
    const model::Joint& joint = mechanism.joints[static_cast<std::size_t>(mechanism.rows[static_cast<std::size_t>(worst)].owner)];
    if (!joint.is_motor) {
        out << "joint '" << joint.name << "' is not met (" << most << " m short): ";
        return;
    }
    const bool turns = mechanism.set.measures[static_cast<std::size_t>(joint.coordinate)].kind == measure::MeasureKind::angle;
    out << "motor '" << joint.name << "' cannot follow its curve (" << std::abs(unmet[worst]) << (turns ? " rad" : " m") << " short, with ";
    out << std::abs(step.rows->multipliers()[worst]) / step.problem.weight << (turns ? " N m): " : " N): ");
}

}  // namespace

std::string describe_failure(const FailedStep& step) {
    const std::vector<model::Body>& bodies = step.problem.model->bodies;
    std::ostringstream out;
    int held = -1;
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Vector6& r = step.remaining[i];
        const double left = r.head<3>().norm() + r.tail<3>().norm() * bodies[i].radius;
        if (left <= most) continue;
        most = left;
        held = static_cast<int>(i);
    }
    if (held >= 0) out << "body '" << bodies[held].name << "' cannot follow its script (" << most << " m short): ";
    if (held < 0 && step.rows) describe_unmet_row(step, out);
    out << step.cause;
    if (step.limiting.limiting_a >= 0)
        out << "; '" << bodies[step.limiting.limiting_a].name << "' against '" << bodies[step.limiting.limiting_b].name << "'";
    if (const Closest closest = closest_of(step.contacts); closest.pair)
        out << "; closest pair '" << bodies[closest.pair->first].name << "' and '" << bodies[closest.pair->second].name << "' at "
            << std::sqrt(closest.distance_squared) << " m";
    const char* unit = step.problem.model->area_weighted ? " N/m^3" : " N/m";
    out << "; residual " << step.residual;
    if (step.shift > 0) out << ", Hessian shifted by " << step.shift << " times the inertia";
    out << ", kappa " << step.problem.kappa << unit;
    const double wanted = sufficient_kappa(step);
    if (wanted > step.problem.kappa) out << " (with kappa " << wanted << unit << " the same forces would leave half of dhat)";
    return out.str();
}

}  // namespace fettle::core::solver
