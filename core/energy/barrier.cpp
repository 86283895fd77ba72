// SPDX-License-Identifier: MIT
#include "fettle/core/energy/barrier.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::energy {
namespace {

double barrier_value(const ValueAt& at) { return contact::barrier_potential(at.contacts, at.problem.barrier); }

void add_barrier_derivatives(const DerivativesAt& at, CouplingDerivatives& d) {
    contact::add_barrier_derivatives(at.contacts, at.poses, at.problem.barrier, at.kind, d.gradient, d.hessian);
}

// Adds one pair of primitives. @param begin, end  its vertices on body f.a.
void add_pair(const StepProblem& problem, const contact::ContactPair& pair, int begin, int end, ContactForce& f) {
    const auto gradient = pair_forces(pair, problem.barrier);
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    for (int i = begin; i < end; ++i) {
        force -= gradient[i] / problem.weight;
        torque -= pair.x[i].cross(gradient[i]) / problem.weight;
    }
    f.force += force;
    f.torque += torque;
    f.normal += normal_force(pair, problem.barrier) / problem.weight;
    const double distance = std::sqrt(pair.closest.distance_squared);
    f.distance = f.contacts == 0 ? distance : std::min(f.distance, distance);
    ++f.contacts;
}

void add_barrier_report(const SolvedStep& step, TermReport& report) {
    const StepProblem& problem = step.problem;
    for (const contact::BodyPairContacts& list : step.contacts.pairs) {
        ContactForce& f = force_between(report, list.first, list.second);
        for (const contact::ContactPair& pair : list.contacts) {
            report.contact_energy += pair_potential(pair, problem.barrier) / problem.weight;
            // On body a: the vertices of the first primitive, or those of the second if the pair is listed the other way round.
            const int n = first_count(pair.type);
            const bool first = list.first == f.a;
            add_pair(problem, pair, first ? 0 : n, first ? n : 4, f);
        }
    }
}

}  // namespace

const CouplingTerm barrier_term{"barrier", barrier_value, add_barrier_derivatives, add_barrier_report};

}  // namespace fettle::core::energy
