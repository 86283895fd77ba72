// SPDX-License-Identifier: MIT
#include "adjoint/energy/incremental_potential_adjoint.hpp"

#include <array>

#include "adjoint/energy/body_terms_adjoint.hpp"
#include "adjoint/energy/contact_terms_adjoint.hpp"
#include "adjoint/energy/measure_terms_adjoint.hpp"

namespace fettle::adjoint::energy {

std::span<const TermAdjoint* const> term_adjoints() {
    static const std::array list{&inertia_term_adjoint,         &loads_term_adjoint,    &damping_term_adjoint, &barrier_term_adjoint,
                                 &contact_damping_term_adjoint, &friction_term_adjoint, &measure_terms_adjoint};
    return list;
}

Errors check_terms(const core::model::Model& model) {
    Errors errors;
    for (const TermAdjoint* term : term_adjoints())
        for (const core::base::Error& error : term->check(model)) errors.push_back(error);
    return errors;
}

void subtract_terms_reverse(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                            std::vector<ModelGradient>& model_bar) {
    for (const TermAdjoint* term : term_adjoints()) term->subtract_reverse(at, motion, step_bar, model_bar);
}

contact::PoseGradientTangent terms_tangent(const StepEnd& at, const StepTangent& step, const ModelTangent& direction) {
    const std::size_t n = at.poses.size();
    contact::PoseGradientTangent out{std::vector<Matrix34>(n, Matrix34::Zero()), std::vector<Matrix34>(n, Matrix34::Zero())};
    for (const TermAdjoint* term : term_adjoints()) term->add_tangent(at, step, direction, out);
    return out;
}

}  // namespace fettle::adjoint::energy
