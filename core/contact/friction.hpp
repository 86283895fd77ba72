// SPDX-License-Identifier: MIT
/// Smoothed Coulomb friction with lagged normal forces and tangents. docs/method/contact.md#friction.
///   D = sum over contacts of load * f0(|u|),   u = T^T (x_a - x_b - (slip reference of the same material points)),   load = weight mu
///   lambda f0(y) = y for y >= e,  -y^3/(3 e^2) + y^2/e + e/3 below;   e = eps_v * slip_time
/// u / slip_time is the contact's sliding velocity of the integrator in use (energy/time_integration.hpp), so that the force is mu lambda
/// against it, and less below eps_v. Within one solve lambda, T and the two material points (the closest points when they were taken) are
/// constants: D is a function of the poses, with an exact gradient and a Hessian whose Gauss-Newton part is positive semi-definite, since
/// f0 is convex. Source: Li et al. 2020, section 5.
#pragma once

#include <vector>

#include "core/contact/contact_set.hpp"

namespace fettle::core::contact {

/// f0, f0' / y and f0'' of the sliding distance y >= 0; e > 0.
struct FrictionMollifier {
    double value = 0;       ///< f0 [m]
    double first_by_y = 0;  ///< f0'(y) / y [1/m], finite at 0
    double second = 0;      ///< f0'' [1/m], >= 0
};
inline FrictionMollifier friction_mollifier(double y, double e) {
    if (y >= e) return {y, 1 / y, 0};
    return {y * y * (1 - y / (3 * e)) / e + e / 3, (2 - y / e) / e, 2 * (1 - y / e) / e};
}

/// One contact's constants during a solve.
struct FrictionContact {
    Vector3 point_first, point_second;  ///< material points, in the bodies' frames [m]
    Vector3 separation_reference;       ///< x_a - x_b of the slip reference, world [m]
    Vector3 tangent_1, tangent_2;       ///< orthonormal, world
    double load = 0;                    ///< weight mu lambda
};

struct BodyPairFriction {
    int first = 0, second = 0;
    double mu = 0;
    std::vector<FrictionContact> contacts;
};

struct FrictionSet {
    double slip_bound = 1;  ///< e = eps_v * slip_time [m]
    std::vector<BodyPairFriction> pairs;
};

/// Normal forces and tangents of `contacts` at `poses`. Pairs of bodies without friction are left out.
/// @param parameters      of the barrier whose forces are the normal forces; its factor carries the weight.
/// @param slip_reference  per body, 3 x 4: where its points would be without sliding.
FrictionSet lag_friction(const model::Model& model, const ContactSet& contacts, const std::vector<kinematics::Pose>& poses,
                         const BarrierParameters& parameters, const std::vector<Matrix34>& slip_reference, double slip_time);

/// Share of the contacts' load that is borne where one has slid farther than the slip bound; 0 without contacts.
double sliding_share(const FrictionSet& set, const std::vector<kinematics::Pose>& poses);

/// Sum of D.
double friction_potential(const FrictionSet& set, const std::vector<kinematics::Pose>& poses);

/// Adds D's first derivatives, and the Gauss-Newton part of its second ones.
/// @param kind  projected: load f0'/|u| along the slide too, in place of f0''. The quadratic with that curvature majorises f0 (which is
///              concave in |u|^2), so that a Newton step cannot leap over the narrow valley where a contact sticks.
void add_friction_derivatives(const FrictionSet& set, const std::vector<kinematics::Pose>& poses, HessianKind kind,
                              std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian);

/// Friction's force on the first body at its material point, times the weight (world).
Vector3 friction_force(const FrictionSet& set, const BodyPairFriction& pair, const FrictionContact& contact,
                       const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::contact
