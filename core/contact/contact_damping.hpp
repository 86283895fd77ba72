// SPDX-License-Identifier: MIT
/// Damping of contacts along their gaps: what a pair loses by being pressed together or let go. docs/method/contact.md#damping-in-contact.
/// A pair's closeness is its barrier potential without stiffness and area, a number: 0 from the activation distance on, unbounded at dmin,
///   phi = m b(g) / g_hat^2,   g = d^2 - dmin^2,   C2 at the activation distance (barrier.hpp), so that damping sets in gently.
/// The pair's barrier potential is kappa w g_hat^2 / (4 activation^2) phi [J]; T times that, the damping time T [s], makes the coefficient
/// c [J s] of the damping: with the rate dphi/dt the vertices are pushed by -c dphi/dt grad phi, at the power -c (dphi/dt)^2 <= 0. A gap
/// that stays is not damped. As a term of the step's potential, times its weight:
///   factor w / 2 (phi^2 - 2 phi phi_t0),   factor = weight T/h kappa g_hat^2 / (4 activation^2)   [kg m^2],   phi_t0 = phi(P0).
/// That is factor w / 2 (phi - phi_t0)^2 less a constant, so that pairs which have parted have the value 0. The rate is (phi - phi_t0)/h
/// with every integrator, of first order also where the rest of the step is of second: the force then never acts with the change of phi,
/// however stiff the contact.
///
/// How strong, for dmin = 0 and a mass m against n contacts, ' = d/dd: stiffness k = kappa n dhat^2/4 phi'', damping
/// T kappa n dhat^2/4 phi'^2 = c,
///   c/k = T phi'^2/phi'' = 2 T deep inside, 1.24 T at d = dhat/2, and -> 0 at dhat;   k = 3.78 n kappa, c = 4.69 T n kappa at d = dhat/2,
/// so that oscillations about that distance are critically damped at T = 0.83 sqrt(m/(n kappa)).
///
/// What slides on a mesh is braked a little where it leaves one triangle for the next: the old triangle's pair loses its closeness within
/// about dhat of the edge, and that is damped as any rate is.
#pragma once

#include <vector>

#include "core/contact/contact_set.hpp"

namespace fettle::core::contact {

/// Constants of a step.
struct ContactDamping {
    double factor = 0;            ///< above [kg m^2]; 0: no damping
    BarrierParameters closeness;  ///< whose potential is phi (factor 1/g_hat^2)
    std::vector<Matrix34> start;  ///< P0, per body
};

/// @param damping_share  T/h.
/// @param barrier        of the step: its factor carries kappa and the weight.
void set_contact_damping(double damping_share, const BarrierParameters& barrier, ContactDamping& damping);

/// One contact as damping sees it.
struct DampedPair {
    ContactPair end, start;   ///< at the poses of the contact set, and at P0; without area weight
    double stiffness = 0;     ///< factor w
    double closeness = 0;     ///< phi at the end
    double closeness_t0 = 0;  ///< phi_t0
    double slope() const { return stiffness * (closeness - closeness_t0); }  ///< d(value)/d phi
};
DampedPair damped_pair(const model::Model& model, const ContactDamping& damping, const BodyPairContacts& list, const ContactPair& pair);

/// What is damped, and how; `contacts` are those at the end poses.
struct DampedContacts {
    const model::Model& model;
    const ContactSet& contacts;
    const ContactDamping& damping;
};

/// Sum over the contacts; infinity where one is at or below dmin, or its distance is not finite.
double contact_damping_potential(const DampedContacts& damped);

/// Adds first and second derivatives (Gauss-Newton part of the Hessian), as add_barrier_derivatives does.
/// @param kind  projected: positive semi-definite pair by pair. For a pair that closes, by its parts, that of phi as the barrier's; for one
///              that opens phi's part is negative, and the eigenvalues of the whole are cut off at 0.
void add_contact_damping_derivatives(const DampedContacts& damped, const std::vector<kinematics::Pose>& poses, HessianKind kind,
                                     std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian);

}  // namespace fettle::core::contact
