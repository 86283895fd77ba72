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

void add(ModelGradient& sum, const ModelGradient& part) {
    for (std::size_t i = 0; i < sum.bodies.size(); ++i) {
        BodyGradient& to = sum.bodies[i];
        const BodyGradient& from = part.bodies[i];
        if (from.vertices_bar.cols() > 0) to.vertices_bar += from.vertices_bar;
        to.pose_start_bar += from.pose_start_bar;
        to.velocity_start_bar += from.velocity_start_bar;
        to.density_bar += from.density_bar;
        to.force_bar += from.force_bar;
        for (std::size_t t = 0; t < to.increment_bar.size() && t < from.increment_bar.size(); ++t)
            to.increment_bar[t] += from.increment_bar[t];
    }
    sum.gravity_bar += part.gravity_bar;
}

Seeds zero_seeds(const core::model::Model& model, int steps) {
    return {zero_trajectory_gradient(steps, static_cast<int>(model.bodies.size())), zero_model_gradient(model, steps)};
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
