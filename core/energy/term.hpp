// SPDX-License-Identifier: MIT
/// One term of the incremental potential (incremental_potential.hpp): a value, its derivatives, and what it reports once a step is solved.
/// Each term is one file here, an entry in a list of incremental_potential.cpp, and one file in adjoint/energy.
///
/// Terms of one body (inertia, loads, damping) are added up body by body, in one loop for all of them. A term that couples bodies (barrier,
/// friction) sees all bodies at once, so that its inner loops stay its own. The order is always the lists', so that no sum depends on
/// anything else.
#pragma once

#include <vector>

#include "fettle/core/contact/contact_set.hpp"
#include "fettle/core/energy/step_problem.hpp"
#include "fettle/core/energy/term_report.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"

namespace fettle::core::energy {

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
    std::vector<kinematics::PoseGradient> gradient;  ///< [body]
    kinematics::BlockHessian hessian;                ///< off-diagonal blocks are inserted as needed and stay sorted
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
