// SPDX-License-Identifier: MIT
#include "design/quantities/contact_force.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adjoint/clearance/contact_gap_adjoint.hpp"
#include "adjoint/stepper/contact_forces.hpp"
#include "design/description/constraint.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

namespace {

adjoint::stepper::ContactForceOf asked_of(const Simulated& s, const ContactForce::Of& of) {
    adjoint::stepper::ContactForceOf out{of.body, of.other};
    if (of.about) out.about = of.about->value(s) - s.model.bodies[of.body].reference_point;
    return out;
}

}  // namespace

std::vector<Vector3> ContactForce::vectors(const Simulated& s) const {
    return adjoint::stepper::contact_forces(s.model, s.trajectory, asked_of(s, of_));
}

void ContactForce::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    adjoint::stepper::add_contact_force_seeds(s.model, s.trajectory, asked_of(s, of_), weights, seeds);
    if (!of_.about || !of_.about->follows()) return;
    // The torque changes with the point X by - R dX x F.
    const std::vector<Vector3> forces = adjoint::stepper::contact_forces(s.model, s.trajectory, {of_.body, of_.other});
    Vector3 of_point = Vector3::Zero();
    for (std::size_t t = 0; t < weights.size(); ++t)
        of_point += s.trajectory.poses[t + 1][of_.body].rotation.transpose() * weights[t].cross(forces[t]);
    of_.about->add_seed(s, of_point, seeds);
}

std::vector<std::string> ContactForce::parameters() const {
    std::vector<std::string> names;
    if (of_.about) of_.about->add_parameters(names);
    return names;
}

namespace {

using core::clearance::ContactGap;

// How a step's number goes on: none where it does not.
using Gaps = std::vector<std::optional<ContactGap>>;

// 1 of a lower bound, -1 of an upper one; 0: no least force is asked for.
int pressing_side(const description::Bounds& bounds) { return bounds.lower > 0 ? 1 : bounds.upper < 0 ? -1 : 0; }

// The steps whose numbers the reduction may come to, of those reductions that are continued.
std::vector<std::size_t> steps_taken(const Reduction& reduction, int side, const std::vector<double>& y, const Instants& instants) {
    std::vector<std::size_t> out;
    if (reduction.derivative != 0) return out;
    if (reduction.at || reduction.over == Over::end) {
        const std::vector<double> weights = weights_of(reduction, y, instants);
        for (std::size_t t = 0; t < weights.size(); ++t)
            if (weights[t] != 0) out.push_back(t);
    } else if (reduction.over == (side > 0 ? Over::least : Over::largest)) {
        const auto [first, last] = window_of(reduction, instants, count_of(y));
        for (int t = first; t < last; ++t) out.push_back(static_cast<std::size_t>(t));
    }
    return out;
}

double activation(const core::model::Model& model) { return model.dmin + model.dhat; }

// The parts at the step that counts most.
std::string apart_text(const core::model::Model& model, const Gaps& gaps, const std::vector<double>& weights) {
    const ContactGap* most = nullptr;
    double largest = 0;
    for (std::size_t t = 0; t < gaps.size(); ++t) {
        if (!gaps[t] || !(std::abs(weights[t]) > largest)) continue;
        largest = std::abs(weights[t]);
        most = &*gaps[t];
    }
    if (most == nullptr) return {};
    return "`" + model.bodies[std::min(most->first, most->second)].name + "` and `" +
           model.bodies[std::max(most->first, most->second)].name + "` are " + description::amount_text(most->gap, 1e-3, "mm", 3) +
           " apart";
}

void add_gap_seeds(const Simulated& s, const Gaps& gaps, const std::vector<double>& scales, Seeds& seeds) {
    for (std::size_t t = 0; t < gaps.size(); ++t) {
        if (!gaps[t] || scales[t] == 0) continue;
        adjoint::clearance::contact_gap_adjoint(s.model, s.trajectory.poses[t + 1], *gaps[t], scales[t],
                                                seeds.trajectory_bar.pose_bar[t + 1], seeds.model_bar);
        seeds.model_bar.dmin_bar -= scales[t];
    }
}

}  // namespace

std::optional<description::Continuation> ContactForce::continuation(const Simulated& s, const description::Measurement& measured,
                                                                    const description::Bounds& bounds) const {
    constexpr double dhats = 10;
    const int side = pressing_side(bounds);
    if (side == 0 || description::violation(bounds, measured) <= 0) return std::nullopt;
    std::vector<double> z = numbers(s);
    const Instants steps = instants(s.trajectory.timestep);
    const std::vector<Vector3> forces = vectors(s);
    const double stiffness = side * (side > 0 ? bounds.lower : -bounds.upper) / (dhats * s.model.dhat);
    Gaps gaps(z.size());
    bool is_continued = false;
    for (const std::size_t t : steps_taken(reduction(), side, z, steps)) {
        if (!forces[t].isZero(0)) continue;
        gaps[t] = core::clearance::nearest_contact_gap(s.model, s.trajectory.poses[t + 1], of_.body, of_.other);
        if (gaps[t] && !(gaps[t]->gap > activation(s.model))) gaps[t].reset();
        if (!gaps[t]) continue;
        is_continued = true;
        z[t] = -stiffness * (gaps[t]->gap - activation(s.model));
    }
    if (!is_continued) return std::nullopt;
    const std::vector<double> weights = weights_of(reduction(), z, steps);
    description::Continuation out;
    out.value = number_of(reduction(), z, steps);
    out.reason = apart_text(s.model, gaps, weights);
    out.add_seeds = [this, &s, stiffness, weights, gaps = std::move(gaps)](double scale, Seeds& seeds) {
        std::vector<double> of_forces(weights.size(), 0.0), of_gaps(weights.size(), 0.0);
        for (std::size_t t = 0; t < weights.size(); ++t)
            (gaps[t] ? of_gaps : of_forces)[t] = scale * weights[t] * (gaps[t] ? -stiffness : 1);
        add_number_seeds(s, of_forces, seeds);
        add_gap_seeds(s, gaps, of_gaps, seeds);
    };
    return out;
}

Errors ContactForce::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const int body : {of_.body, of_.other.value_or(of_.body)})
        for (const core::base::Error& error : description::check_body(model, body)) errors.push_back(error);
    if (!errors.empty()) return errors;
    bool touches = false;
    for (int other = 0; other < count_of(model.bodies); ++other)
        touches = touches || ((!of_.other || other == *of_.other) && may_collide(model, of_.body, other));
    if (!touches)
        errors.push_back(
            {ErrorCode::inconsistent, "",
             "\"" + model.bodies[of_.body].name +
                 (of_.other ? "\" and \"" + model.bodies[*of_.other].name + "\" never collide" : std::string("\" collides with nothing"))});
    return errors;
}

}  // namespace fettle::design::quantities
