// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/loads_adjoint.hpp"

namespace fettle::adjoint::energy {
namespace {

Errors check_loads(const core::model::Model& model) {
    Errors errors;
    for (const core::model::Body& body : model.bodies)
        if (core::energy::has_free_dof(body) && body.torque != Vector3::Zero())
            errors.push_back(refusal(body.name, "the torque on '" + body.name + "'"));
    return errors;
}

void subtract_reverse_of_loads(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient&,
                               std::vector<ModelGradient>& model_bar) {
    for (std::size_t s = 0; s < motion.size(); ++s)
        for (std::size_t i = 0; i < at.poses.size(); ++i) model_bar[s].bodies[i].force_bar += at.problem.weight * motion[s][i].head<3>();
}

void add_tangent_of_loads(const StepEnd& at, const StepTangent&, const ModelTangent& direction, contact::PoseGradientTangent& out) {
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        out.value[i].col(3) -= at.problem.weight * at.problem.model->bodies[i].force;
        out.dot[i].col(3) -= at.problem.weight * direction.bodies[i].force_dot;
    }
}

}  // namespace

const TermAdjoint loads_term_adjoint{"loads", check_loads, subtract_reverse_of_loads, add_tangent_of_loads};

}  // namespace fettle::adjoint::energy
