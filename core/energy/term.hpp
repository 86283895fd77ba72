// SPDX-License-Identifier: MIT
/// One term of the incremental potential (incremental_potential.hpp): a value, its derivatives, and what it reports once a step is solved.
/// Each term is one file here, an entry in the list of incremental_potential.cpp, and one file in adjoint/energy. A term sees all bodies at
/// once, so that its inner loops stay its own and the calls are as few as the terms.
///
/// Terms of one body (inertia, loads) and terms that couple bodies (barrier, friction) go into sums of their own: what a body has by itself
/// is added up body by body, what couples bodies term by term, always in the list's order, so that no sum depends on anything else.
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

/// Potentials times the problem's weight [kg m^2].
struct TermValues {
    std::vector<double> bodies;     ///< [body]: what the terms of one body add up to
    std::vector<double> couplings;  ///< one for each term that couples bodies; infinity where it is not defined
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
struct TermDerivatives {
    std::vector<kinematics::PoseGradient> own, coupling;  ///< [body]
    std::vector<Matrix6> own_hessian;                     ///< [body]
    kinematics::BlockHessian coupling_hessian;            ///< off-diagonal blocks are inserted as needed and stay sorted
    std::vector<Vector3> chart_gradient;                  ///< [body]: of what is linear in theta itself
    std::vector<double> own_magnitude;                    ///< [body]: of the forces' parts in `own`, in gradient units per metre
};

/// A step that is solved.
struct SolvedStep {
    const StepProblem& problem;                  ///< with the friction that it was solved with
    const std::vector<kinematics::Pose>& poses;  ///< where the solver ended
    const contact::ContactSet& contacts;         ///< there
    const History& end;                          ///< what the next step starts from
};

struct Term {
    const char* name;
    void (*add_value)(const ValueAt& at, TermValues& values);
    void (*add_derivatives)(const DerivativesAt& at, TermDerivatives& derivatives);
    void (*add_report)(const SolvedStep& step, TermReport& report);
};

}  // namespace fettle::core::energy
