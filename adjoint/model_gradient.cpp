// SPDX-License-Identifier: MIT
#include "fettle/adjoint/model_gradient.hpp"

namespace fettle::adjoint {

TrajectoryGradient zero_trajectory_gradient(int steps, int bodies) {
    TrajectoryGradient g;
    g.pose_bar.assign(static_cast<std::size_t>(steps) + 1, std::vector<Matrix34>(static_cast<std::size_t>(bodies), Matrix34::Zero()));
    return g;
}

ModelGradient zero_model_gradient(const core::model::Model& model, int steps) {
    ModelGradient g;
    g.bodies.resize(model.bodies.size());
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        g.bodies[i].vertices_bar = Matrix3X::Zero(3, model.bodies[i].mesh.vertices.cols());
        g.bodies[i].increment_bar.assign(static_cast<std::size_t>(steps), Vector6::Zero());
    }
    return g;
}

ModelTangent zero_model_tangent(const core::model::Model& model, int steps) {
    ModelTangent d;
    d.bodies.resize(model.bodies.size());
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        d.bodies[i].vertices_dot = Matrix3X::Zero(3, model.bodies[i].mesh.vertices.cols());
        d.bodies[i].increment_dot.assign(static_cast<std::size_t>(steps), Vector6::Zero());
    }
    return d;
}

}  // namespace fettle::adjoint
