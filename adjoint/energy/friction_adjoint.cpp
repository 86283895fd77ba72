// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/friction_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

// One pair says enough.
Errors check_friction(const core::model::Model& model) {
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b) {
            if (!may_collide(model, a, b) || friction_coefficient(model, a, b) == 0) continue;
            Errors errors{refusal("friction", "friction between '" + model.bodies[a].name + "' and '" + model.bodies[b].name + "'")};
            errors.back().message += " yet; a gradient needs coefficients of 0";
            return errors;
        }
    return {};
}

void subtract_nothing(const StepEnd&, const std::vector<std::vector<Vector6>>&, StepGradient&, std::vector<ModelGradient>&) {}

void add_nothing(const StepEnd&, const StepTangent&, const ModelTangent&, contact::PoseGradientTangent&) {}

}  // namespace

const TermAdjoint friction_term_adjoint{"friction", check_friction, subtract_nothing, add_nothing};

}  // namespace fettle::adjoint::energy
