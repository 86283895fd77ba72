// SPDX-License-Identifier: MIT
/// One term of the incremental potential (incremental_potential.hpp): a value, its derivatives, and what it reports once a step is solved:
/// energies, momenta, forces between bodies. Each is an entry in a list of incremental_potential.cpp, and has its adjoint in
/// adjoint/energy.
///
/// Terms of one body (inertia, loads, damping) are added up body by body, in one loop for all of them. A term that couples bodies (barrier,
/// friction) sees all bodies at once, so that its inner loops stay its own. The order is always the lists', so that no sum depends on
/// anything else.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/contact/contact_set.hpp"
#include "core/energy/step_problem.hpp"
#include "core/kinematics/tangent_system.hpp"

namespace fettle::core::energy {

/// Between two bodies, at the end of a step.
struct ContactForce {
    int a = 0, b = 0;                    ///< a < b
    Vector3 force = Vector3::Zero();     ///< on a, friction included, world [N]
    Vector3 torque = Vector3::Zero();    ///< on a, about the world's origin [N m]
    double normal = 0;                   ///< sum of the contacts' normal forces [N]
    Vector3 friction = Vector3::Zero();  ///< on a [N]
    double distance = 0;                 ///< least of the contacts' [m]
    int contacts = 0;
};

struct TermReport {
    double kinetic_energy = 0;                   ///< of the bodies with mass [J]
    double potential_energy = 0;                 ///< of gravity and constant forces, zero at the world's origin [J]
    double contact_energy = 0;                   ///< of the barrier [J]
    Vector3 linear_momentum = Vector3::Zero();   ///< [kg m/s]
    Vector3 angular_momentum = Vector3::Zero();  ///< about the world's origin [kg m^2/s]
    std::vector<ContactForce> contacts;          ///< by (a, b)
    double spring_energy = 0;                    ///< of springs and stops [J]
    double supplied_power = 0;             ///< by what is no potential: motors, prescribed coordinates, forces along measures, torques [W]
    double dissipated_power = 0;           ///< by friction of contacts and joints, dampers, damping of bodies and contacts [W]
    std::vector<double> measure_forces{};  ///< per term of the mechanism: force or torque along its measure [N], [N m]
};

/// The entry of these two bodies, in either order; made where there is none. Valid until the next one is made.
ContactForce& force_between(TermReport& report, int first, int second);

/// Where a value is wanted. `poses` are those of `points`.
struct ValueAt {
    const StepProblem& problem;
    const std::vector<kinematics::ChartPoint>& points;
    const std::vector<kinematics::Pose>& poses;
    const contact::ContactSet& contacts;  ///< at `poses`
};

/// Where derivatives are wanted.
struct DerivativesAt {
    const StepProblem& problem;
    const std::vector<kinematics::Pose>& poses;
    const contact::ContactSet& contacts;  ///< at `poses`
    contact::HessianKind kind;            ///< of the terms that couple bodies
};

/// Sums over the terms, in the potential's units. The curvature of the rotations follows from the gradients (kinematics/tangent_system.hpp)
/// and is no term's business; the Hessians are in tangent coordinates (q, phi).
struct BodyDerivatives {
    kinematics::PoseGradient gradient;
    Matrix6 hessian = Matrix6::Zero();         ///< of no use where the kind is `none`
    Vector3 chart_gradient = Vector3::Zero();  ///< of what is linear in theta itself
    double magnitude = 0;                      ///< of the forces' parts, in gradient units per metre
};
struct CouplingDerivatives {
    CouplingDerivatives() = default;
    explicit CouplingDerivatives(std::size_t bodies) : gradient(bodies), magnitude(bodies, 0.0) {
        hessian.diagonal.assign(bodies, Matrix6::Zero());
    }
    std::vector<kinematics::PoseGradient> gradient;  ///< [body]
    kinematics::BlockHessian hessian;                ///< off-diagonal blocks are inserted as needed and stay sorted
    std::vector<double> magnitude;  ///< [body] of the contacts' sum and of each term of a measure, as BodyDerivatives has it
};

/// A step that is solved.
struct SolvedStep {
    const StepProblem& problem;                  ///< with the friction that it was solved with
    const std::vector<kinematics::Pose>& poses;  ///< where the solver ended
    const contact::ContactSet& contacts;         ///< there
    const History& end;                          ///< what the next step starts from
};

/// Potentials are times the problem's weight [kg m^2].
struct BodyTerm {
    const char* name;
    void (*add_value)(const ValueAt& at, std::size_t body, double& value);
    void (*add_derivatives)(const DerivativesAt& at, std::size_t body, BodyDerivatives& derivatives);
    void (*add_report)(const SolvedStep& step, TermReport& report);
};

struct CouplingTerm {
    const char* name;
    double (*value)(const ValueAt& at);  ///< infinity where it is not defined
    void (*add_derivatives)(const DerivativesAt& at, CouplingDerivatives& derivatives);
    void (*add_report)(const SolvedStep& step, TermReport& report);
};

}  // namespace fettle::core::energy
